#include "app/kinds/slopes.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/library.hpp"
#include "app/read_blow.hpp"
#include "app/read_options.hpp"
#include "app/read_shaft.hpp"
#include "golf/parallel.hpp"
#include "loop/shots/shots.hpp"
#include "models/checked_launch.hpp"
#include "models/registry.hpp"
#include "post/figure.hpp"
#include "post/labels.hpp"
#include "post/launch_table.hpp"
#include "solvers/robust_regression.hpp"

namespace hosel::app {
namespace {

namespace fs = std::filesystem;

/// An input of the blow that the regression holds.
struct Held {
  const char* name;
  double Delivery::*value;
};
constexpr std::array kHeldInputs = {
    Held{"impact_toe", &Delivery::impact_toe}, Held{"impact_high", &Delivery::impact_high},
    Held{"club_speed", &Delivery::club_speed}, Held{"attack_angle", &Delivery::attack_angle},
    Held{"club_path", &Delivery::club_path},   Held{"dynamic_loft", &Delivery::dynamic_loft},
    Held{"face_angle", &Delivery::face_angle}};
/// The first two are the axes along which slopes are wanted.
constexpr std::size_t kSlopeAxes = 2;
constexpr std::array<const char*, kSlopeAxes> kAxisNames = {"towards the toe", "up the face"};
constexpr std::array<const char*, 5> kSlopeQuantities = {"sidespin", "azimuth", "backspin", "launch_angle",
                                                         "ball_speed"};

/// A slope in SI per metre with its standard error.
struct Slope {
  double value = 0, error = 0;
};
using Slopes = std::array<std::array<Slope, kSlopeAxes>, kSlopeQuantities.size()>;

/// One way to ask: a model, a ball, a head.
struct Asked {
  std::string label;
  std::string model;
  models::Options options;
  Blow blow;
};

class SlopesJob final : public Job {
 public:
  explicit SlopesJob(CaseFile& file) {
    Table root = file.root();
    title_ = root.text({"title", "of tables, pages and figures"}, "");
    names_ = read_models(root);
    const std::string head_name = root.table("head").has("name") ? *named_entry_of(root, "head", "name", Shelf::heads)
                                                                 : std::string();
    blow_.ball = root.has("ball") ? read_ball(root.table("ball")) : Ball{};
    blow_.club.head = read_head(root.table("head"));
    if (auto shaft = root.optional_table("shaft")) blow_.club.shaft = read_shaft(*shaft);
    blow_.club.geometry = read_club_geometry(root, blow_.club.shaft.has_value());
    blow_.contact = read_contact(root);
    options_ = read_options(root, names_, blow_);
    if (!head_name.empty()) spread_ = library_head(head_name).spread;
    for (const std::string& ball :
         root.texts({"balls", "further balls of the library, which every finite-element model is asked with"},
                    std::vector<std::string>{})) {
      try {
        balls_.emplace_back(ball, library_ball(ball));
      } catch (const InputError& error) { root.fail("balls", error.what()); }
    }
    Table step = root.default_table("step");
    step_[0] = step.quantity({"toe", "from the middle, either way, for the models' slopes"}, "mm", {1e-4, 0.04}, 0.010);
    step_[1] = step.quantity({"high", "likewise up the face"}, "mm", {1e-4, 0.04}, 0.008);
    Table data = root.table("data");
    file_ = data.data_file({"shots", "CSV of the measured shots"});
    first_ = data.integer({"first_shot", "number of the first shot that is used"}, 0, 1L << 53, 0L);
    last_ = data.integer({"last_shot", "number of the last"}, first_, 1L << 53, 1L << 53);
    if (fs::exists(file_)) read_shots_file(data);
    if (!delivered_.empty()) check_use(root, use_of(middle()), names_);
  }

  void run(Output& out) override {
    if (!fs::exists(file_)) return out.skip(file_);
    const Slopes measured = regress(out);
    const std::vector<Asked> asked = questions();
    std::vector<Slopes> found(asked.size());
    Progress progress = out.progress("slopes");
    std::atomic<std::size_t> done = 0;
    for_all(std::size_t{0}, asked.size(), [&](std::size_t k) {
      found[k] = slopes_of(asked[k]);
      progress.update(double(++done) / double(asked.size()));
    });
    progress.finish();
    report(out, measured, asked, found);
  }

 private:
  static std::optional<std::string> named_entry_of(Table& root, std::string_view table, std::string_view key,
                                                   Shelf shelf) {
    Table t = root.table(table);
    return named_entry(t, key, shelf);
  }

  void read_shots_file(Table& data) {
    loop::Shots shots;
    try {
      shots = loop::read_shots(post::read_csv(file_));
    } catch (const DataError& e) { throw InputError(e.what()); }
    std::array<const loop::Column*, kHeldInputs.size()> columns{};
    for (std::size_t k = 0; k < kHeldInputs.size(); ++k)
      if (!(columns[k] = shots.find_stem(kHeldInputs[k].name)) || !columns[k]->numeric)
        data.fail("shots", fmt::format("no column {} with numbers", kHeldInputs[k].name));
    const loop::Column* azimuth = shots.find_stem("azimuth");
    if (!azimuth) data.fail("shots", "no column azimuth");
    for (std::size_t row = 0; row < shots.rows(); ++row) {
      const long number = std::strtol(shots.id[row].c_str(), nullptr, 10);
      if (number < first_ || number > last_) continue;
      ++rows_;
      Delivery d;
      bool whole = std::isfinite(azimuth->value[row]);
      for (std::size_t k = 0; k < kHeldInputs.size(); ++k) {
        d.*kHeldInputs[k].value = columns[k]->value[row];
        whole = whole && std::isfinite(columns[k]->value[row]);
      }
      const std::optional<Launch> launch = loop::seen_launch(shots, row);
      if (!whole || !launch) continue;
      delivered_.push_back(d);
      launched_.push_back(*launch);
    }
    if (delivered_.size() < 3 * kHeldInputs.size())
      data.fail("shots", fmt::format("{} whole rows; a regression on {} inputs needs {}", delivered_.size(),
                                     kHeldInputs.size(), 3 * kHeldInputs.size()));
  }

  /// The median blow, struck in the middle.
  Blow middle() const {
    Blow blow = blow_;
    for (std::size_t k = kSlopeAxes; k < kHeldInputs.size(); ++k) {
      std::vector<double> x;
      for (const Delivery& d : delivered_) x.push_back(d.*kHeldInputs[k].value);
      std::ranges::nth_element(x, x.begin() + std::ptrdiff_t(x.size() / 2));
      blow.delivery.*kHeldInputs[k].value = x[x.size() / 2];
    }
    return blow;
  }

  static double value(const Launch& launch, std::size_t quantity) {
    return (launch.*post::find_channel(kSlopeQuantities[quantity])->value)();
  }

  /// Every quantity over all inputs at once, each input from its median: the slope over the place at equal delivery.
  Slopes regress(Output& out) const {
    const Blow centre = middle();
    const auto n = Eigen::Index(delivered_.size());
    Eigen::MatrixXd X(n, 1 + Eigen::Index(kHeldInputs.size()));
    for (Eigen::Index i = 0; i < n; ++i) {
      X(i, 0) = 1;
      for (std::size_t k = 0; k < kHeldInputs.size(); ++k)
        X(i, Eigen::Index(k) + 1) = delivered_[std::size_t(i)].*kHeldInputs[k].value -
                                    (k < kSlopeAxes ? 0 : centre.delivery.*kHeldInputs[k].value);
    }
    Slopes out_slopes;
    std::string weights;
    for (std::size_t q = 0; q < kSlopeQuantities.size(); ++q) {
      Eigen::VectorXd y(n);
      for (Eigen::Index i = 0; i < n; ++i) y[i] = value(launched_[std::size_t(i)], q);
      const solvers::RobustRegression fit = solvers::robust_regression(X, y);
      for (std::size_t a = 0; a < kSlopeAxes; ++a)
        out_slopes[q][a] = {fit.coefficients[Eigen::Index(a) + 1],
                            std::sqrt(fit.covariance(Eigen::Index(a) + 1, Eigen::Index(a) + 1))};
      const post::Channel& c = *post::find_channel(kSlopeQuantities[q]);
      weights += fmt::format("{}{} {} ({:.3g} {})", q ? ", " : "", (fit.weights.array() < 0.5).count(),
                             post::spoken(c.name), fit.scale / c.si, post::symbol(c.unit));
    }
    const Delivery& d = centre.delivery;
    out.tell(
        fmt::format("{} of {} rows are whole; at {:.1f} m/s, attack {:+.1f} deg, path {:+.1f} deg, dynamic loft "
                    "{:.1f} deg, face {:+.1f} deg",
                    n, rows_, d.club_speed, degrees(d.attack_angle), degrees(d.club_path), degrees(d.dynamic_loft),
                    degrees(d.face_angle)));
    out.tell("rows that count less than half, and the scatter of the others: " + weights);
    return out_slopes;
  }

  /// The models as the case has them first; then each with another ball; then with a head of one standard deviation.
  std::vector<Asked> questions() const {
    std::vector<Asked> all;
    for (const std::string& m : names_) all.push_back({"", m, options_, middle()});
    const std::size_t plain = all.size();
    for (std::size_t k = 0; k < plain; ++k) {
      if (!all[k].model.starts_with("fe-")) continue;
      for (const auto& [name, ball] : balls_) {
        Asked a = all[k];
        a.label = "ball " + name;
        a.options.fe.ball = ball.layers;
        a.blow.ball = ball.body;
        all.push_back(std::move(a));
      }
    }
    if (!spread_) return all;
    for (std::size_t k = 0; k < plain; ++k) {
      const auto head = [&](const std::string& what, auto change) {
        Asked a = all[k];
        a.label = "head " + what;
        change(a.blow.club.head);
        all.push_back(std::move(a));
      };
      if (spread_->mass) head("mass", [&](Head& h) { h.mass += *spread_->mass; });
      if (spread_->inertia) head("inertia", [&](Head& h) { h.inertia *= 1 + *spread_->inertia; });
      if (spread_->cg)
        for (int i = 0; i < 3; ++i)
          head(std::array{"cg depth", "cg heel", "cg height"}[std::size_t(i)],
               [&](Head& h) { h.cg[i] -= (*spread_->cg)[i]; });
    }
    return all;
  }

  Slopes slopes_of(const Asked& a) const {
    const auto model = models::find(a.model)->make(a.options);
    Slopes s;
    for (std::size_t axis = 0; axis < kSlopeAxes; ++axis) {
      std::array<Launch, 2> ends;
      for (const int side : {-1, 1}) {
        Blow blow = a.blow;
        blow.delivery.*kHeldInputs[axis].value = side * step_[axis];
        ends[side > 0] = models::checked_launch(*model, blow);
      }
      for (std::size_t q = 0; q < kSlopeQuantities.size(); ++q)
        s[q][axis].value = (value(ends[1], q) - value(ends[0], q)) / (2 * step_[axis]);
    }
    return s;
  }

  void report(Output& out, const Slopes& measured, const std::vector<Asked>& asked,
              const std::vector<Slopes>& found) const {
    nlohmann::json summary;
    std::string csv = "quantity,unit,axis,source,slope_per_mm,half_width_per_mm,balls_low_per_mm,balls_high_per_mm\n";
    post::Figure figure{.title = title_, .columns = 2};
    for (std::size_t axis = 0; axis < kSlopeAxes; ++axis) {
      post::TextTable table{.rows = {{fmt::format("{}, per mm", kAxisNames[axis]), "measured"}}};
      for (const std::string& m : names_) table.rows[0].push_back(m);
      for (std::size_t q = 0; q < kSlopeQuantities.size(); ++q) {
        const post::Channel& c = *post::find_channel(kSlopeQuantities[q]);
        const double unit = c.si * 1e3;  // per mm
        const Slope& seen = measured[q][axis];
        auto& row = table.rows.emplace_back();
        row = {fmt::format("{} [{}]", post::spoken(c.name), post::symbol(c.unit)),
               fmt::format("{:.3g} ± {:.2g}", seen.value / unit, kInterval * seen.error / unit)};
        csv += fmt::format("{},{},{},measured,{:.6g},{:.4g},,\n", c.name, c.unit, kHeldInputs[axis].name,
                           seen.value / unit, kInterval * seen.error / unit);
        nlohmann::json& j =
            summary[kHeldInputs[axis].name][std::string(c.name) + "_" + std::string(c.unit) + "_per_mm"];
        j["measured"] = {{"slope", seen.value / unit}, {"half_width_95", kInterval * seen.error / unit}};
        post::Panel panel{.title = fmt::format("{}, {}", post::spoken(c.name), kAxisNames[axis]),
                          .x_label = fmt::format("{} per mm", post::symbol(c.unit)),
                          .y_label = "",
                          .y_names = {"measured"}};
        const auto bar = [&](double low, double middle, double high, double y) {
          panel.series.push_back({.x = {low / unit, high / unit}, .y = {y, y}});
          panel.series.push_back({.x = {middle / unit}, .y = {y}, .style = "points"});
        };
        bar(seen.value - kInterval * seen.error, seen.value, seen.value + kInterval * seen.error, 0);
        for (std::size_t m = 0; m < names_.size(); ++m) {
          const double value = found[m][q][axis].value;
          double head = 0, low = value, high = value;
          for (std::size_t k = names_.size(); k < asked.size(); ++k) {
            if (asked[k].model != names_[m]) continue;
            const double other = found[k][q][axis].value;
            if (asked[k].label.starts_with("head ")) head += (other - value) * (other - value);
            else low = std::min(low, other), high = std::max(high, other);
          }
          head = kInterval * std::sqrt(head);
          const bool balls = high > low;
          row.push_back(fmt::format("{:.3g} ± {:.2g}{}", value / unit, head / unit,
                                    balls ? fmt::format(" ({:.3g} to {:.3g})", low / unit, high / unit) : ""));
          csv += fmt::format("{},{},{},{},{:.6g},{:.4g},{},{}\n", c.name, c.unit, kHeldInputs[axis].name, names_[m],
                             value / unit, head / unit, balls ? fmt::format("{:.6g}", low / unit) : "",
                             balls ? fmt::format("{:.6g}", high / unit) : "");
          j[names_[m]] = {
              {"slope", value / unit}, {"half_width_head_95", head / unit}, {"balls", {low / unit, high / unit}}};
          panel.y_names.push_back(names_[m]);
          bar(std::min(low, value - head), value, std::max(high, value + head), -double(m + 1));
        }
        figure.panels.push_back(std::move(panel));
      }
      out.show(table);
      out.tell("");
    }
    out.tell(fmt::format(
        "measured: 95 % interval of the regression; models: {}{}",
        spread_ ? "95 % by the spread of such heads (" + spread_->source + ")" : "no spread of the head is known",
        balls_.empty() ? "" : "; in brackets: over the balls"));
    std::string each = "model,varied,quantity,axis,slope_per_mm\n";
    for (std::size_t k = 0; k < asked.size(); ++k)
      for (std::size_t q = 0; q < kSlopeQuantities.size(); ++q)
        for (std::size_t axis = 0; axis < kSlopeAxes; ++axis)
          each += fmt::format("{},{},{},{},{:.6g}\n", asked[k].model, asked[k].label, kSlopeQuantities[q],
                              kHeldInputs[axis].name,
                              found[k][q][axis].value / (1e3 * post::find_channel(kSlopeQuantities[q])->si));
    out.write("slopes.csv", csv);
    out.write("varied.csv", each);
    out.draw(figure, "slopes");
    summary["rows"] = delivered_.size();
    out.write_summary(summary);
  }

  static constexpr double kInterval = 1.96;  ///< half of a 95 % interval over its standard error

  std::string title_;
  std::vector<std::string> names_;
  Blow blow_;
  models::Options options_;
  std::optional<HeadSpread> spread_;
  std::vector<std::pair<std::string, BallEntry>> balls_;
  std::array<double, kSlopeAxes> step_{};
  fs::path file_;
  long first_ = 0, last_ = 0;
  std::size_t rows_ = 0;  ///< in the range of numbers
  std::vector<Delivery> delivered_;
  std::vector<Launch> launched_;
};

}  // namespace

std::unique_ptr<Job> read_slopes(CaseFile& file) { return std::make_unique<SlopesJob>(file); }

}  // namespace hosel::app
