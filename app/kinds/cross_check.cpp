#include "app/kinds/cross_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/check_memory.hpp"
#include "app/library.hpp"
#include "app/read_blow.hpp"
#include "app/read_flight.hpp"
#include "app/read_options.hpp"
#include "app/read_parameter.hpp"
#include "golf/first_contact.hpp"
#include "golf/parallel.hpp"
#include "models/checked_launch.hpp"
#include "models/registry.hpp"
#include "post/csv.hpp"
#include "post/figure.hpp"
#include "post/labels.hpp"
#include "post/launch_table.hpp"

namespace hosel::app {
namespace {

constexpr std::array kChannels = {"ball_speed", "launch_angle", "azimuth",     "backspin",     "sidespin",
                                  "carry",      "side",         "flight_time", "landing_angle"};  // where they fly

/// What a blow consists of, beside the launch: the quantities that can explain a difference.
struct ComparedQuantity {
  const char* name;
  const char* unit;
  double si;
};
constexpr std::array kComparedQuantities = {
    ComparedQuantity{"contact time", "ms", 1e-3}, ComparedQuantity{"peak force", "kN", 1e3},
    ComparedQuantity{"normal impulse", "N s", 1}, ComparedQuantity{"tangential impulse", "N s", 1},
    ComparedQuantity{"head rotation", "rad/s", 1}};

struct CrossPrediction {
  bool good = false;
  std::string why;
  Launch launch;
  std::array<double, kComparedQuantities.size()> quantity{};  // NaN where the model has none
};

CrossPrediction answer(const models::ImpactModel& model, const Blow& blow) {
  CrossPrediction a;
  try {
    a.launch = models::checked_launch(model, blow);
    const Vec3 n = first_contact(blow).normal, J = blow.ball.mass * a.launch.velocity;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    a.quantity = {a.launch.contact_time.value_or(nan), a.launch.peak_force.value_or(nan), J.dot(n),
                  (J - J.dot(n) * n).norm(), (a.launch.head_spin - blow.delivery.head_angular_velocity).norm()};
    a.good = true;
  } catch (const std::exception& e) { a.why = e.what(); }
  return a;
}

class CrossCheckJob final : public Job {
 public:
  explicit CrossCheckJob(CaseFile& file) {
    const BlowsBeside beside;
    Table root = file.root();
    title_ = root.text({"title", "of tables, pages and figures"}, "");
    models_ = read_models(root);
    if (models_.size() < 2) root.fail("models", "name at least two models");
    const std::string reference =
        root.choice({"reference", "the model that the others are compared with"}, models_, models_.front());
    reference_ = static_cast<std::size_t>(std::ranges::find(models_, reference) - models_.begin());
    blow_ = read_blow(root, models_);
    options_ = read_options(root, models_);
    const std::optional<FlightSetup> flight = read_optional_flight(root);
    for (const char* name : kChannels)
      if (auto c = find_shot_channel(name, flight, blow_.ball)) channels_.push_back(std::move(*c));
    for (const Table& t : root.tables("grid")) axes_.push_back(read_axis(t));
    if (axes_.empty()) root.fail("grid", "name at least one [[grid]] axis");
    check_use(root, use_of_axes(options_, blow_, axes_), models_);
    points_ = 1;
    constexpr std::size_t most = 1'000'000;
    for (const Axis& a : axes_) {
      if (points_ > most / a.values.size()) root.fail("grid", fmt::format("has more than {} points", most));
      points_ *= a.values.size();
    }
  }

  void run(Output& out) override {
    std::vector<std::vector<CrossPrediction>> answers(models_.size(), std::vector<CrossPrediction>(points_));
    {
      Progress progress = out.progress("cross-check");
      std::atomic<std::size_t> done = 0;
      for_all(std::size_t{0}, points_, [&](std::size_t k) {
        models::Options options = options_;
        Blow blow = blow_;
        set(k, options, blow);
        for (std::size_t m = 0; m < models_.size(); ++m)
          answers[m][k] = answer(*models::find(models_[m])->make(options), blow);
        progress.update(static_cast<double>(++done) / static_cast<double>(points_));
      });
      progress.finish();
    }
    write_points(out, answers);

    nlohmann::json summary;
    summary["reference"] = models_[reference_];
    summary["points"] = points_;
    std::string page = fmt::format("# {}\n\nReference: `{}`. {} blows: ", title_.empty() ? "Cross-check" : title_,
                                   models_[reference_], points_);
    for (std::size_t a = 0; a < axes_.size(); ++a)
      page += fmt::format("{}{} from {:g} to {:g} ({} values)", a ? ", " : "", axes_[a].label,
                          axes_[a].values.front() / axes_[a].si, axes_[a].values.back() / axes_[a].si,
                          axes_[a].values.size());
    page +=
        ".\n\nDifference = model minus reference. The last column names the physical quantity that differs most, "
        "relative to the\n"
        "reference, where the channel's difference is largest.\n";
    std::string csv = "model,channel,unit,mean,rms,largest";
    for (const Axis& a : axes_) csv += "," + column(*a.parameter);
    for (const ComparedQuantity& q : kComparedQuantities)
      csv += "," + post::csv_cell(fmt::format("{} [{}] difference there [%]", q.name, q.unit));
    csv += '\n';

    for (std::size_t m = 0; m < models_.size(); ++m) {
      std::size_t failed = 0;
      std::string first;
      for (const CrossPrediction& a : answers[m])
        if (!a.good && failed++ == 0) first = a.why;
      if (failed) {
        const std::string text =
            fmt::format("{}: no answer at {} of {} blows ({})", models_[m], failed, points_, first);
        out.say(text);
        page += "\n" + text + "\n";
        summary["failed"][models_[m]] = failed;
      }
      if (m == reference_) continue;
      post::TextTable table{.rows = {{"channel", "mean", "rms", "largest", "where", "differs most"}}};
      page += fmt::format(
          "\n## {}\n\n| channel | mean | rms | largest | where | reference there | differs most "
          "|\n|---|---|---|---|---|---|---|\n",
          models_[m]);
      for (const ShotChannel& c : channels_) {
        double mean = 0, square = 0, largest = 0;
        std::size_t where = points_, count = 0;
        for (std::size_t k = 0; k < points_; ++k) {
          const double d = difference(answers, m, k, c);
          if (!std::isfinite(d)) continue;
          ++count;
          mean += d;
          square += d * d;
          if (where == points_ || std::abs(d) > std::abs(largest)) largest = d, where = k;
        }
        if (count == 0) continue;
        mean /= static_cast<double>(count);
        square = std::sqrt(square / static_cast<double>(count));
        std::string place, cause = "-";
        double most = 0;
        csv += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g}", models_[m], c.name, c.unit, mean, square, largest);
        const std::vector<std::size_t> at = index(where);
        for (std::size_t a = 0; a < axes_.size(); ++a) {
          place += (a ? ", " : "") + axes_[a].said(at[a]);
          csv += fmt::format(",{:.8g}", axes_[a].values[at[a]] / axes_[a].si);
        }
        nlohmann::json quantities;
        for (std::size_t q = 0; q < kComparedQuantities.size(); ++q) {
          const double mine = answers[m][where].quantity[q], theirs = answers[reference_][where].quantity[q];
          const double share = 100 * (mine - theirs) / theirs;
          csv += std::isfinite(share) ? fmt::format(",{:.4g}", share) : std::string(",");
          if (std::isfinite(share)) quantities[kComparedQuantities[q].name] = share;
          if (std::isfinite(share) && std::abs(share) > std::abs(most) && std::abs(largest) > 1e-9) {
            most = share;
            cause = fmt::format("{} {:+.1f} % ({:.3g} against {:.3g} {})", kComparedQuantities[q].name, share,
                                mine / kComparedQuantities[q].si, theirs / kComparedQuantities[q].si,
                                kComparedQuantities[q].unit);
          }
        }
        csv += '\n';
        page += fmt::format("| {} [{}] | {:+.4g} | {:.4g} | {:+.4g} | {} | {:.5g} | {} |\n", c.name, c.unit, mean,
                            square, largest, place, c.value(answers[reference_][where].launch) / c.si, cause);
        table.rows.push_back({fmt::format("{} [{}]", post::spoken(c.name), post::symbol(c.unit)),
                              fmt::format("{:+.4g}", mean), fmt::format("{:.4g}", square),
                              fmt::format("{:+.4g}", largest), place, cause});
        if (c.name == "ball_speed" || c.name == "spin_rate" || c.name == "backspin")
          out.page().answer(
              fmt::format("{}, {}", post::spoken(c.name), models_[m]),
              fmt::format("{:.4g} {}", square, post::symbol(c.unit)),
              fmt::format("rms off {}; at most {:+.4g} {}", models_[reference_], largest, post::symbol(c.unit)));
        out.say(fmt::format("{:<16} {:<13} largest {:+10.4g} {:<4} at {:<60} {}", models_[m], c.name, largest, c.unit,
                            place, cause));
        summary["differences"].push_back({{"model", models_[m]},
                                          {"channel", c.name},
                                          {"unit", c.unit},
                                          {"mean", mean},
                                          {"rms", square},
                                          {"largest", largest},
                                          {"where", place},
                                          {"differs_most", cause},
                                          {"quantities_pct", quantities}});
      }
      const std::string stem = "map-" + models_[m];
      out.page().section(fmt::format("{} minus {}", models_[m], models_[reference_]), table.html());
      out.draw(figure(answers, m), stem);
      page += fmt::format("\n![{} minus {}]({}.png)\n", models_[m], models_[reference_], stem);
    }
    out.write("differences.csv", csv);
    out.write("index.md", page);
    out.tell("wrote index.md, differences.csv, points.csv and the maps");
    out.write_summary(summary);
  }

 private:
  std::vector<std::size_t> index(std::size_t k) const {  // first axis fastest
    std::vector<std::size_t> at;
    for (const Axis& a : axes_) {
      at.push_back(k % a.values.size());
      k /= a.values.size();
    }
    return at;
  }
  void set(std::size_t k, models::Options& options, Blow& blow) const {
    const std::vector<std::size_t> at = index(k);
    for (std::size_t a = 0; a < axes_.size(); ++a) axes_[a].parameter->set(options, blow, axes_[a].values[at[a]]);
  }
  double difference(const std::vector<std::vector<CrossPrediction>>& answers, std::size_t m, std::size_t k,
                    const ShotChannel& c) const {
    const CrossPrediction &mine = answers[m][k], &theirs = answers[reference_][k];
    if (!mine.good || !theirs.good) return std::numeric_limits<double>::quiet_NaN();
    return (c.value(mine.launch) - c.value(theirs.launch)) / c.si;
  }

  void write_points(Output& out, const std::vector<std::vector<CrossPrediction>>& answers) const {
    std::string csv = "model";
    for (const Axis& a : axes_) csv += "," + column(*a.parameter);
    for (const ShotChannel& c : channels_) csv += fmt::format(",{}_{}", c.name, c.unit);
    csv += ",contact_time_ms,peak_force_kN,normal_impulse_N_s,tangential_impulse_N_s,head_rotation_rad_per_s\n";
    for (std::size_t m = 0; m < models_.size(); ++m)
      for (std::size_t k = 0; k < points_; ++k) {
        const CrossPrediction& a = answers[m][k];
        if (!a.good) continue;
        csv += models_[m];
        const std::vector<std::size_t> at = index(k);
        for (std::size_t i = 0; i < axes_.size(); ++i)
          csv += fmt::format(",{:.8g}", axes_[i].values[at[i]] / axes_[i].si);
        for (const ShotChannel& c : channels_) csv += fmt::format(",{:.8g}", c.value(a.launch) / c.si);
        for (std::size_t q = 0; q < kComparedQuantities.size(); ++q)
          csv += std::isfinite(a.quantity[q]) ? fmt::format(",{:.8g}", a.quantity[q] / kComparedQuantities[q].si)
                                              : std::string(",");
        csv += '\n';
      }
    out.write("points.csv", csv);
  }

  /// Over the first two axes (or the first), the others at their middle value.
  post::Figure figure(const std::vector<std::vector<CrossPrediction>>& answers, std::size_t m) const {
    std::size_t base = 0, stride = 1;
    std::string rest;
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      if (a >= 2) {
        base += stride * (axes_[a].values.size() / 2);
        rest += ", " + axes_[a].said(axes_[a].values.size() / 2);
      }
      stride *= axes_[a].values.size();
    }
    post::Figure f{.title = fmt::format("{} minus {}{}", models_[m], models_[reference_], rest),
                   .columns = 3,
                   .panel_width = 520,
                   .panel_height = 400};
    const Axis& x = axes_[0];
    for (const ShotChannel& c : channels_) {
      std::string plain(c.name);
      std::ranges::replace(plain, '_', ' ');
      post::Panel p{.title = plain, .x_label = x.label};
      const std::string with_unit = fmt::format("difference [{}]", post::symbol(c.unit));
      if (axes_.size() == 1) {
        p.y_label = with_unit;
        post::Series s{.style = "linespoints"};
        for (std::size_t i = 0; i < x.values.size(); ++i) {
          s.x.push_back(x.values[i] / x.si);
          s.y.push_back(difference(answers, m, i, c));
        }
        p.series = {s};
      } else {
        const Axis& y = axes_[1];
        p.y_label = y.label;
        p.map_label = with_unit;
        p.map_symmetric = true;
        for (const double v : x.values) p.map_x.push_back(v / x.si);
        for (const double v : y.values) p.map_y.push_back(v / y.si);
        for (std::size_t j = 0; j < y.values.size(); ++j)
          for (std::size_t i = 0; i < x.values.size(); ++i)
            p.map.push_back(difference(answers, m, base + j * x.values.size() + i, c));
      }
      // Where both say the same everywhere there is nothing to see: the table says so.
      const auto nothing = [](double d) { return !(std::abs(d) > 1e-9); };
      if (std::ranges::all_of(p.map.empty() ? p.series.front().y : p.map, nothing)) continue;
      f.panels.push_back(p);
    }
    return f;
  }

  std::string title_;
  std::vector<std::string> models_;
  std::size_t reference_ = 0, points_ = 0;
  Blow blow_;
  models::Options options_;
  std::vector<Axis> axes_;
  std::vector<ShotChannel> channels_;
};

}  // namespace

std::unique_ptr<Job> read_cross_check(CaseFile& file) { return std::make_unique<CrossCheckJob>(file); }

}  // namespace hosel::app
