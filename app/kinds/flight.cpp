#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "app/read_flight.hpp"
#include "post/csv.hpp"
#include "post/launch_table.hpp"

namespace hosel::app {
namespace {

class FlightJob final : public Job {
 public:
  explicit FlightJob(CaseFile& file) {
    Table root = file.root();
    setup_ = root.has("flight") ? read_flight(root.table("flight")) : FlightSetup{};
    if (auto ball = root.optional_table("ball")) ball_ = read_ball(*ball);
    std::vector<std::string> taken;
    for (Table t : root.tables("launch")) {
      Shot s{t.name({"name", "of the shot"}, taken), read_launch(t, true).in_place_of({}), {}};
      if (auto measured = t.optional_table("measured"))
        for (const post::FlightChannel& c : post::flight_channels(setup_.unit))
          if (measured->has_quantity(c.name))
            s.measured.emplace_back(&c,
                                    measured->quantity({c.name, "what was measured of this shot", "<flight quantity>"},
                                                       std::string(c.unit)));
      shots_.push_back(std::move(s));
    }
    if (shots_.empty()) root.fail("launch", "name at least one [[launch]]");
  }

  void run(Output& out) override {
    setup_.show_in(out);
    const models::FlightLaw& used = setup_.conditions.law;
    nlohmann::json summary = {{"law", {{"name", used.name}, {"source", used.source}}}};
    std::string csv = "launch,law";
    const auto channels = post::flight_channels(setup_.unit);
    for (const post::FlightChannel& c : channels) csv += fmt::format(",{}_{}", c.name, c.unit);
    csv += ",outside_law_range\n";
    std::vector<post::LaunchColumn> columns;
    std::vector<post::NamedFlight> flights;
    for (const Shot& s : shots_) {
      const post::ShotFlight shot = setup_.follow(s.launch, ball_, 0.05);
      columns.push_back({.title = s.name, .launch = s.launch, .flight = shot});
      flights.push_back({s.name, shot});
      nlohmann::json& j = summary["launches"][s.name];
      j = post::to_json(shot);
      j["budget"] = report_flight(out, setup_, s.name, s.launch, ball_);
      compare(out, s, shot, j);
      const auto row = [&](const std::string& law, const post::ShotFlight& f) {
        csv += post::csv_cell(s.name) + "," + post::csv_cell(law);
        for (const post::FlightChannel& c : channels) {
          const auto x = c.value(f);
          csv += x ? fmt::format(",{:.8g}", *x / c.si) : std::string(",");
        }
        csv += fmt::format(",{:.4g}\n", f.flight.outside);
      };
      row(setup_.conditions.law.name, shot);
      for (const models::FlightLaw& law : setup_.others) {
        FlightSetup other = setup_;
        other.conditions.law = law;
        row(law.name, other.follow(s.launch, ball_));
      }
    }
    out.tell("");
    out.show(post::launch_table(columns, {}, {}, out.units()));
    out.write("flights.csv", csv);
    if (shots_.size() > 1) out.draw(post::trajectory_figure(setup_.conditions.law.name, flights), "figures/flights");
    out.write_summary(summary);
  }

 private:
  struct Shot {
    std::string name;
    Launch launch;
    std::vector<std::pair<const post::FlightChannel*, double>> measured;  ///< SI
  };

  static void compare(Output& out, const Shot& s, const post::ShotFlight& shot, nlohmann::json& j) {
    std::string text;
    for (const auto& [c, value] : s.measured) {
      const auto x = c->value(shot);
      if (!x) continue;
      j["measured"][fmt::format("{}_{}", c->name, c->unit)] = value / c->si;
      text += fmt::format("{}{} {:+.{}f} {}", text.empty() ? "" : ", ", c->name, (*x - value) / c->si, c->decimals,
                          c->unit);
    }
    if (!text.empty()) out.say(fmt::format("{}, minus measured: {}", s.name, text));
  }

  FlightSetup setup_;
  Ball ball_;
  std::vector<Shot> shots_;
};

}  // namespace

std::unique_ptr<Job> read_flights(CaseFile& file) { return std::make_unique<FlightJob>(file); }

}  // namespace hosel::app
