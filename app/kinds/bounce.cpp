#include "app/kinds/bounce.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/check_memory.hpp"
#include "app/library.hpp"
#include "app/read_blow.hpp"
#include "app/read_options.hpp"
#include "golf/parallel.hpp"
#include "models/fe/elastic_plate.hpp"
#include "models/oblique.hpp"
#include "models/registry.hpp"
#include "post/csv.hpp"
#include "post/figure.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace {

struct BounceQuantity {
  const char* name;
  const char* unit;  ///< suffix; empty for a pure number
  double si;
  double models::Bounce::*value;
  const char* label;
};
constexpr std::array kBounceQuantities = {
    BounceQuantity{"tangential_ratio", "", 1, &models::Bounce::tangential_ratio,
                   "tangential velocity, after over before"},
    BounceQuantity{"tangential_restitution", "", 1, &models::Bounce::tangential_restitution, "tangential restitution"},
    BounceQuantity{"spin", "rad_per_s", 1, &models::Bounce::spin, "spin [rad/s]"},
    BounceQuantity{"rebound_angle", "deg", kRadPerDeg, &models::Bounce::rebound_angle, "rebound angle [deg]"},
    BounceQuantity{"normal_restitution", "", 1, &models::Bounce::normal_restitution, "normal restitution"},
};

std::string with_unit(const BounceQuantity& q) { return *q.unit ? fmt::format("{}_{}", q.name, q.unit) : q.name; }

/// One set of measured points of one quantity.
struct Measured {
  const BounceQuantity* quantity;
  std::string label;
  std::vector<double> angles, values, half_ranges;  ///< SI; half_ranges empty where not stated
};

/// Who bounces: a model, with a ball of the library where it is a finite-element model and several are asked for.
struct Thrown {
  std::string name;
  std::unique_ptr<models::ImpactModel> model;
};

class BounceJob final : public Job {
 public:
  explicit BounceJob(CaseFile& file) {
    const BlowsBeside beside;
    Table root = file.root();
    title_ = root.text({"title", "of tables, pages and figures"}, "");
    const std::vector<std::string> names = read_models(root);
    ball_ = root.has("ball") ? read_ball(root.table("ball")) : Ball{};
    const models::Options options = read_options(root, names);
    std::optional<models::ElasticSolid> plate;
    if (auto t = root.optional_table("plate"))
      plate = {
          t->quantity({"young", "Young's modulus of a thick elastic plate; absent: rigid"}, "GPa", Range::positive()),
          t->number({"poisson", "Poisson's ratio of the plate"}, {0, 0.49})};
    const std::vector<std::string> balls = root.texts(
        {"balls", "balls of the library, each thrown by every finite-element model"}, std::vector<std::string>{});
    for (const std::string& name : names) {
      const models::ModelEntry& entry = *models::find(name);
      const bool deformable = name.starts_with("fe-");
      if (balls.empty() || !deformable) {
        thrown_.push_back({name, plate && deformable ? on_plate(root, options.fe, *plate) : entry.make(options)});
        continue;
      }
      for (const std::string& ball : balls) {
        models::Options own = options;
        try {
          own.fe.ball = library_ball(ball).layers;
        } catch (const InputError& error) { root.fail("balls", error.what()); }
        thrown_.push_back({ball, entry.make(own)});
      }
    }
    Table throws = root.table("throws");
    speeds_ = throws.quantities({"speeds", "of the throws"}, "mps", 0, {0, 200, true});
    angles_ = throws.quantities({"angles", "between path and the plate's normal"}, "deg", 0, {1e-3, 1.5},
                                std::vector<double>{});
    for (Table t : root.tables("measured")) {
      std::vector<std::string> known;
      for (const BounceQuantity& q : kBounceQuantities) known.emplace_back(q.name);
      const std::string wanted = t.choice({"quantity", "what was measured"}, known);
      Measured m{.quantity = &*std::ranges::find(kBounceQuantities, wanted, &BounceQuantity::name)};
      m.label = t.text({"label", "who measured"});
      m.angles = t.quantities({"angles", "at which it was measured"}, "deg", 0, {1e-3, 1.5});
      const auto numbers = [&](Key key, const std::optional<std::vector<double>>& standard) {
        return *m.quantity->unit ? t.quantities(key, m.quantity->unit, 0, Range::finite(), standard)
                                 : t.numbers(key, 0, Range::finite(), standard);
      };
      m.values = numbers({"values", "measured values, one for each angle"}, {});
      m.half_ranges = numbers({"half_ranges", "of the measured values, one for each angle"}, std::vector<double>{});
      if (m.values.size() != m.angles.size()) t.fail("values", "one value for each angle");
      if (!m.half_ranges.empty() && m.half_ranges.size() != m.angles.size())
        t.fail("half_ranges", "one half range for each angle, or none");
      measured_.push_back(std::move(m));
    }
    // Compared where it was measured, not between.
    for (const Measured& m : measured_) angles_.insert(angles_.end(), m.angles.begin(), m.angles.end());
    std::ranges::sort(angles_);
    angles_.erase(std::ranges::unique(angles_).begin(), angles_.end());
    if (angles_.empty()) root.fail("throws", "name at least one angle");
  }

  void run(Output& out) override {
    const std::size_t grid = speeds_.size() * angles_.size(), count = thrown_.size() * grid;
    std::vector<models::Bounce> bounces(count);
    {
      Progress progress = out.progress("bounces");
      std::atomic<std::size_t> done = 0;
      for_all(std::size_t{0}, count, [&](std::size_t k) {
        const std::size_t at = k % grid;
        bounces[k] =
            models::bounce(*thrown_[k / grid].model, ball_, speeds_[at / angles_.size()], angles_[at % angles_.size()]);
        progress.update(double(++done) / double(count));
      });
      progress.finish();
    }
    std::string csv = "ball,speed_mps,angle_deg";
    for (const BounceQuantity& q : kBounceQuantities) csv += "," + post::csv_cell(with_unit(q));
    csv += '\n';
    for (std::size_t k = 0; k < count; ++k) {
      csv += fmt::format("{},{:.6g},{:.6g}", post::csv_cell(thrown_[k / grid].name), bounces[k].speed,
                         degrees(bounces[k].angle));
      for (const BounceQuantity& q : kBounceQuantities) csv += fmt::format(",{:.6g}", bounces[k].*q.value / q.si);
      csv += '\n';
    }
    out.write("bounces.csv", csv);
    nlohmann::json summary{{"bounces", count}};
    if (measured_.empty()) table(out, bounces);
    else compare(out, bounces, summary);
    out.draw(figure(bounces), "bounces");
    out.write_summary(summary);
  }

 private:
  std::unique_ptr<models::ImpactModel> on_plate(Table& root, const models::FeImpactOptions& sphere,
                                                const models::ElasticSolid& plate) const {
    try {
      return std::make_unique<models::ElasticPlate>(sphere, plate, ball_);
    } catch (const std::invalid_argument& e) { root.fail("plate", e.what()); }
  }
  const models::Bounce& at(const std::vector<models::Bounce>& all, std::size_t thrown, std::size_t speed,
                           double angle) const {
    const std::size_t a = std::size_t(std::ranges::find(angles_, angle) - angles_.begin());
    return all[(thrown * speeds_.size() + speed) * angles_.size() + a];
  }
  std::string title(std::size_t thrown, std::size_t speed) const {
    return speeds_.size() == 1 ? thrown_[thrown].name
                               : fmt::format("{}, {:g} m/s", thrown_[thrown].name, speeds_[speed]);
  }

  void table(Output& out, const std::vector<models::Bounce>& all) const {
    for (std::size_t t = 0; t < thrown_.size(); ++t)
      for (std::size_t s = 0; s < speeds_.size(); ++s) {
        post::TextTable rows{.rows = {{"angle", "e_t", "ratio", "spin [rad/s]", "rebound [deg]", "e"}},
                             .first_width = 10,
                             .least_width = 10};
        double least = INFINITY, most = -INFINITY;
        for (const double angle : angles_) {
          const models::Bounce& b = at(all, t, s, angle);
          rows.rows.push_back({fmt::format("{:.2f}", degrees(angle)), fmt::format("{:.3f}", b.tangential_restitution),
                               fmt::format("{:.3f}", b.tangential_ratio), fmt::format("{:.1f}", b.spin),
                               fmt::format("{:.2f}", degrees(b.rebound_angle)),
                               fmt::format("{:.4f}", b.normal_restitution)});
          least = std::min(least, b.tangential_restitution);
          most = std::max(most, b.tangential_restitution);
        }
        out.tell("\n" + title(t, s));
        out.show(rows, title(t, s));
        out.page().answer(title(t, s),
                          least < most ? fmt::format("{:.3f} to {:.3f}", least, most) : fmt::format("{:.3f}", most),
                          "tangential restitution");
      }
  }

  /// Every measured point beside every model; root mean squares of the error, and of it over the measured value.
  void compare(Output& out, const std::vector<models::Bounce>& all, nlohmann::json& summary) const {
    for (const Measured& m : measured_) {
      const BounceQuantity& q = *m.quantity;
      post::TextTable rows{.rows = {{"angle", "measured"}}, .first_width = 10, .least_width = 11, .even = false};
      for (std::size_t t = 0; t < thrown_.size(); ++t)
        for (std::size_t s = 0; s < speeds_.size(); ++s) rows.rows[0].push_back(title(t, s));
      std::vector<double> square(thrown_.size() * speeds_.size()), relative = square;
      for (std::size_t i = 0; i < m.angles.size(); ++i) {
        auto& line = rows.rows.emplace_back();
        line = {fmt::format("{:.2f}", degrees(m.angles[i])), fmt::format("{:.4g}", m.values[i] / q.si)};
        for (std::size_t k = 0; k < square.size(); ++k) {
          const double value = at(all, k / speeds_.size(), k % speeds_.size(), m.angles[i]).*q.value;
          const double off = value - m.values[i];
          square[k] += off * off / double(m.angles.size());
          relative[k] += std::pow(off / m.values[i], 2) / double(m.angles.size());
          line.push_back(fmt::format("{:.4g} ({:+.3g})", value / q.si, off / q.si));
        }
      }
      auto& line = rows.rows.emplace_back();
      line = {"rms", ""};
      for (std::size_t k = 0; k < square.size(); ++k) {
        line.push_back(fmt::format("{:.3g} {:.1f} %", std::sqrt(square[k]) / q.si, 100 * std::sqrt(relative[k])));
        out.page().answer(
            fmt::format("{}, {}", post::spoken(q.name), title(k / speeds_.size(), k % speeds_.size())),
            fmt::format("{:.3g}{}{}", std::sqrt(square[k]) / q.si, *q.unit ? " " : "", post::symbol(q.unit)),
            fmt::format("rms off {}, {:.1f} %", m.label, 100 * std::sqrt(relative[k])));
        summary["measured"].push_back({{"quantity", with_unit(q)},
                                       {"label", m.label},
                                       {"ball", title(k / speeds_.size(), k % speeds_.size())},
                                       {"rms", std::sqrt(square[k]) / q.si},
                                       {"rms_relative", std::sqrt(relative[k])}});
      }
      out.tell(fmt::format("\n{}: {}", with_unit(q), m.label));
      out.show(rows, fmt::format("{}: {}", q.label, m.label));
    }
  }

  post::Figure figure(const std::vector<models::Bounce>& all) const {
    post::Figure f{.title = title_, .columns = 2};
    for (const BounceQuantity& q : kBounceQuantities) {
      post::Panel p{.x_label = "angle of incidence from the normal [deg]", .y_label = q.label};
      for (std::size_t t = 0; t < thrown_.size(); ++t)
        for (std::size_t s = 0; s < speeds_.size(); ++s) {
          post::Series line{.label = title(t, s)};
          for (const double angle : angles_) {
            line.x.push_back(degrees(angle));
            line.y.push_back(at(all, t, s, angle).*q.value / q.si);
          }
          p.series.push_back(line);
        }
      for (const Measured& m : measured_) {
        if (m.quantity != &q) continue;
        post::Series points{.label = m.label, .style = "points"};
        for (std::size_t i = 0; i < m.angles.size(); ++i) {
          points.x.push_back(degrees(m.angles[i]));
          points.y.push_back(m.values[i] / q.si);
          if (!m.half_ranges.empty()) points.error.push_back(m.half_ranges[i] / q.si);
        }
        p.series.push_back(points);
      }
      if (&q != &kBounceQuantities.back() ||
          std::ranges::any_of(measured_, [&](const Measured& m) { return m.quantity == &q; }))
        f.panels.push_back(p);
    }
    return f;
  }

  std::string title_;
  Ball ball_;
  std::vector<Thrown> thrown_;
  std::vector<double> speeds_, angles_;
  std::vector<Measured> measured_;
};

}  // namespace

std::unique_ptr<Job> read_bounce(CaseFile& file) { return std::make_unique<BounceJob>(file); }

}  // namespace hosel::app
