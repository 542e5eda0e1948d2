#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "app/read_flight.hpp"
#include "app/read_sheet.hpp"
#include "golf/parallel.hpp"
#include "loop/deviation.hpp"

namespace hosel::app {
namespace {

struct Launched {
  Launch launch;
  double time;       ///< measured [s]
  double own, same;  ///< by the law, in the site's own air and in that of the first site [s]
};

struct Site {
  std::string event, name;
  models::Air air;
  std::vector<Launched> shots;
};

struct RobustMean {
  double value = 0, error = 0;
  std::vector<double> weight = {};  ///< of each
};

/// Huber's mean and its standard error, the scale by the median deviation.
RobustMean robust_mean(const std::vector<double>& x) {
  RobustMean m{.value = loop::median(x), .weight = std::vector<double>(x.size(), 1.0)};
  std::vector<double> size;
  for (const double v : x) size.push_back(std::abs(v - m.value));
  const double knee = 1.5 * 1.4826 * loop::median(size);
  double square = 0, inside = 0;
  for (int pass = 0; pass < 30; ++pass) {
    double sum = 0, weights = 0;
    square = inside = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double off = std::abs(x[i] - m.value), w = m.weight[i] = off > knee ? knee / off : 1;
      sum += w * x[i];
      square += std::pow(w * off, 2);
      weights += w;
      inside += w == 1;
    }
    m.value = sum / weights;
  }
  m.error = std::sqrt(square) / inside;  // the slope of Huber's psi is 1 inside the knee, 0 beyond it
  return m;
}

class LandingTimesJob final : public Job {
 public:
  explicit LandingTimesJob(CaseFile& file) {
    Table root = file.root();
    ball_ = read_optional_ball(root);
    conditions_ = read_conditions(root.table("flight"));
    Table t = root.table("times");
    const auto path = t.data_file({"file",
                                   "CSV with event, speed_mps, launch_deg, azimuth_deg, landing_time_s, "
                                   "measured_time_s (how long each was followed)"});
    spin_ = t.quantity({"spin_rate", "of every shot: it is not recorded"}, "rpm", Range::positive());
    const std::vector<double> speed = t.quantities({"ball_speed", "least and most"}, "mps", 2, {0, 120}),
                              angle = t.quantities({"launch_angle", "least and most"}, "deg", 2, {-kPi / 2, kPi / 2}),
                              time = t.quantities({"time", "in the air, least and most"}, "s", 2, {0, 60});
    const double followed = t.number({"followed", "least share of its time that a shot was followed"}, {0, 2}, 0.8);
    std::vector<std::string> taken;
    for (Table s : t.tables("site")) {
      Site site{.event = s.text({"event", "value of the column `event`"}),
                .name = s.name({"name", "of the site"}, taken),
                .air = {},
                .shots = {}};
      site.air = read_air(s);
      sites_.push_back(std::move(site));
    }
    if (sites_.size() < 2) t.fail("site", "name at least two [[times.site]]");
    if (!std::filesystem::exists(path)) {
      missing_ = path;
      return;
    }
    const post::Sheet sheet = read_sheet(path);
    const auto& events = cells_of(sheet, "event");
    const auto v = column_with_gaps(sheet, "speed_mps"), up = column_with_gaps(sheet, "launch_deg"),
               right = column_with_gaps(sheet, "azimuth_deg"), landed = column_with_gaps(sheet, "landing_time_s"),
               seen = column_with_gaps(sheet, "measured_time_s");
    for (std::size_t i = 0; i < sheet.rows(); ++i) {
      const auto site = std::ranges::find(sites_, events[i], &Site::event);
      const double a = radians(up[i]), b = radians(right[i]);
      if (site == sites_.end() ||
          !(v[i] >= speed[0] && v[i] <= speed[1] && a >= angle[0] && a <= angle[1] && landed[i] >= time[0] &&
            landed[i] <= time[1] && seen[i] >= followed * landed[i]) ||
          !std::isfinite(b))
        continue;
      Launched l{.launch = {}, .time = landed[i], .own = 0, .same = 0};
      l.launch.velocity = v[i] * Vec3(std::cos(a) * std::cos(b), -std::cos(a) * std::sin(b), std::sin(a));
      l.launch.spin = Vec3(0, -spin_, 0);
      site->shots.push_back(l);
    }
    for (const Site& s : sites_)
      if (s.shots.size() < 30) t.fail("site", fmt::format("{}: {} shots are too few", s.name, s.shots.size()));
  }

  void run(Output& out) override {
    if (!missing_.empty()) return out.skip(missing_);
    for (Site& s : sites_)
      for_all(std::size_t(0), s.shots.size(), [&](std::size_t i) {
        models::FlightConditions c = conditions_;
        c.air = s.air;
        s.shots[i].own = models::fly(s.shots[i].launch, ball_, c).time;
        c.air = sites_.front().air;
        s.shots[i].same = models::fly(s.shots[i].launch, ball_, c).time;
      });
    post::TextTable table{.rows = {{"site", "shots", "air [kg/m^3]", "measured less law in one air [s]",
                                    "law: own air less that one [s]", "measured less law in own air [s]"}},
                          .first_width = 14};
    nlohmann::json summary;
    struct Means {
      double measured, carried;  // at equal launch, and what the site's air makes of it [s]
      RobustMean left;
    };
    std::vector<Means> means;
    for (const Site& s : sites_) {
      std::vector<double> in_own;
      for (const Launched& l : s.shots) in_own.push_back(l.time - l.own);
      Means& m = means.emplace_back(Means{0, 0, robust_mean(in_own)});
      // By the same weights, so that the parts add up.
      double weights = 0;
      for (std::size_t i = 0; i < s.shots.size(); ++i) {
        m.carried += m.left.weight[i] * (s.shots[i].own - s.shots[i].same);
        weights += m.left.weight[i];
      }
      m.carried /= weights;
      m.measured = m.left.value + m.carried;
      table.rows.push_back({s.name, fmt::format("{}", s.shots.size()), fmt::format("{:.3f}", s.air.density),
                            fmt::format("{:+.3f} +- {:.3f}", m.measured, m.left.error),
                            fmt::format("{:+.3f}", m.carried),
                            fmt::format("{:+.3f} +- {:.3f}", m.left.value, m.left.error)});
      summary["sites"][s.name] = {
          {"shots", s.shots.size()}, {"measured_less_law_s", m.left.value}, {"error_s", m.left.error}};
    }
    for (std::size_t k = 1; k < sites_.size(); ++k) {
      const double difference = means[k].measured - means[0].measured, density = means[k].carried - means[0].carried,
                   remains = means[k].left.value - means[0].left.value,
                   error = std::hypot(means[k].left.error, means[0].left.error);
      const std::string said = fmt::format(
          "At equal launch the balls at {} land {:.3f} s {} than at {}. By the law {} the density of the air makes "
          "{:+.3f} s of it; {:+.3f} s are left, with a standard error of {:.3f} s: {} than chance makes of it (95 %).",
          sites_[k].name, std::abs(difference), difference < 0 ? "earlier" : "later", sites_[0].name,
          conditions_.law.name, density, remains, error, std::abs(remains) < 1.96 * error ? "no more" : "more");
      out.say(said);
      out.page().sentence(said);
      summary["differences"][sites_[k].name] = {
          {"measured_s", difference}, {"density_s", density}, {"left_s", remains}, {"error_s", error}};
    }
    out.show(table);
    out.write_summary(summary);
  }

 private:
  Ball ball_;
  models::FlightConditions conditions_;
  double spin_ = 0;
  std::vector<Site> sites_;
  std::filesystem::path missing_;
};

}  // namespace

std::unique_ptr<Job> read_landing_times(CaseFile& file) { return std::make_unique<LandingTimesJob>(file); }

}  // namespace hosel::app
