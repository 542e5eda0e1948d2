#include "hosel/app/kinds/characteristic_time.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "hosel/app/read_blow.hpp"
#include "hosel/app/read_face.hpp"
#include "hosel/golf/face_library.hpp"
#include "hosel/golf/units.hpp"
#include "hosel/models/face_strike.hpp"
#include "hosel/post/figure.hpp"

namespace hosel::app {
namespace {

/// The rules' line between characteristic time [us] and restitution.
double rules_line(double time_us) { return 0.718 + 0.000436 * time_us; }

class CharacteristicTimeJob final : public Job {
 public:
  explicit CharacteristicTimeJob(CaseFile& file) {
    Table root = file.root();
    head_ = read_head(root.table("head"));
    face_ = read_face(root.table("face"));
    if (face_.mass >= head_.mass) root.fail("face", "the face's effective mass is part of the head's");
    Table sphere = root.table("sphere");
    sphere_ = models::steel_sphere(sphere.quantity({"radius", "of the pendulum's sphere"}, "mm", {1e-3, 0.1}, 0.011));
    speeds_ = sphere.quantities({"speeds", "of the sphere"}, "mps", 0, {0.01, 20}, models::pendulum_speeds());
    if (speeds_.size() < 2) sphere.fail("speeds", "a line needs two speeds");
    Table place = root.table("impact");
    toe_ = place.quantity({"toe", "of the tap, from the face's centre towards the toe"}, "mm", {-0.1, 0.1}, 0.0);
    high_ = place.quantity({"high", "of the tap, from the face's centre up"}, "mm", {-0.1, 0.1}, 0.0);
    restitution_speed_ =
        place.quantity({"restitution_speed", "at which the ball's restitution is computed"}, "mps", {1, 100}, 48.77);
    Table line = root.table("line");
    faces_ = int(
        line.integer({"faces", "how many faces of rising stiffness are compared with the rules' line"}, 2, 200, 20));
    softest_ = line.quantity({"softest", "stiffness of the first of these faces"}, "N_per_m", Range::positive(), 4.6e6);
    stiffest_ =
        line.quantity({"stiffest", "stiffness of the last of these faces"}, "N_per_m", Range::positive(), 8.8e6);
    masses_ = line.quantities({"effective_masses", "of these faces"}, "g", 0, {1e-4, 0.1},
                              std::vector{0.005, 0.010, 0.015, 0.020});
  }

  void run(Output& out) override {
    const double mass = models::mass_at(head_, -toe_, high_), shape = face_.shape(-toe_, high_).value;
    const models::CharacteristicTime ct = models::characteristic_time(sphere_, mass, face_, shape, speeds_);
    out.say(
        fmt::format("characteristic time {:.1f} us, slope {:.1f} us (m/s)^0.329, largest departure from the line "
                    "{:.3f} us",
                    1e6 * ct.time, 1e6 * ct.slope, 1e6 * ct.departure));
    post::Panel tap{
        .title = "the pendulum test", .x_label = "(speed in m/s) to the power -0.329", .y_label = "contact time [us]"};
    post::Series points{.label = "taps", .style = "points"}, line{.label = "straight line"};
    std::string csv = "speed_mps,contact_time_us\n";
    for (std::size_t i = 0; i < speeds_.size(); ++i) {
      points.x.push_back(std::pow(speeds_[i], -0.329));
      points.y.push_back(1e6 * ct.times[i]);
      csv += fmt::format("{},{:.4f}\n", speeds_[i], 1e6 * ct.times[i]);
    }
    for (const double x : {0.0, points.x.front()}) {
      line.x.push_back(x);
      line.y.push_back(1e6 * (ct.time + ct.slope * x));
    }
    tap.key = "bottom right";
    tap.series = {points, line};
    out.write("taps.csv", csv);

    nlohmann::json summary{{"characteristic_time_us", 1e6 * ct.time},
                           {"slope_us", 1e6 * ct.slope},
                           {"largest_departure_us", 1e6 * ct.departure}};
    const models::Striker ball = models::golf_ball({});
    summary["restitution"] = models::strike(ball, mass, face_, shape, restitution_speed_).restitution;
    summary["restitution_rigid"] = models::strike(ball, mass, {}, 0, restitution_speed_).restitution;
    post::Panel rules{
        .title = "faces from stiff to soft", .x_label = "characteristic time [us]", .y_label = "restitution"};
    rules.key = "bottom right";
    post::Series wanted{.label = "0.718 + 0.000436 CT / us"};
    csv =
        "effective_mass_g,stiffness_N_per_m,characteristic_time_us,restitution,rules_line,contact_in_face_periods,"
        "face_energy_J\n";
    for (const double face_mass : masses_) {
      post::Series series{.label = fmt::format("face of {:g} g", 1e3 * face_mass), .style = "linespoints"};
      double worst = 0;
      for (int i = 0; i < faces_; ++i) {
        FaceCompliance f = face_;
        f.mass = face_mass;
        f.stiffness = softest_ * std::pow(stiffest_ / softest_, i / double(faces_ - 1));
        const double time = 1e6 * models::characteristic_time(sphere_, mass, f, shape, speeds_).time;
        const models::FaceStrike drive = models::strike(ball, mass, f, shape, restitution_speed_);
        const double e = drive.restitution, periods = drive.contact_time * std::sqrt(f.stiffness / f.mass) / (2 * kPi);
        worst = std::max(worst, std::abs(e - rules_line(time)));
        series.x.push_back(time);
        series.y.push_back(e);
        csv += fmt::format("{},{:.5g},{:.3f},{:.5f},{:.5f},{:.3f},{:.3f}\n", 1e3 * face_mass, f.stiffness, time, e,
                           rules_line(time), periods, drive.energy);
      }
      out.say(fmt::format("faces of {:4.1f} g, {:.0f} to {:.0f} us: within {:.4f} of the rules' line", 1e3 * face_mass,
                          series.x.back(), series.x.front(), worst));
      summary["line"].push_back({{"effective_mass_g", 1e3 * face_mass}, {"largest_departure", worst}});
      if (wanted.x.empty())
        for (const double time : {series.x.back(), series.x.front()}) {
          wanted.x.push_back(time);
          wanted.y.push_back(rules_line(time));
        }
      rules.series.push_back(series);
    }
    rules.series.push_back(wanted);
    out.write("line.csv", csv);
    post::Figure figure{.panels = {tap, rules}, .columns = 2};
    if (const std::string why = post::draw(figure, out.path("characteristic-time")); !why.empty()) out.say(why);
    out.write_summary(summary);
  }

 private:
  Head head_;
  FaceCompliance face_;
  models::Striker sphere_;
  std::vector<double> speeds_, masses_;
  double toe_ = 0, high_ = 0, restitution_speed_ = 0, softest_ = 0, stiffest_ = 0;
  int faces_ = 0;
};

}  // namespace

std::unique_ptr<Job> read_characteristic_time(CaseFile& file) { return std::make_unique<CharacteristicTimeJob>(file); }

}  // namespace hosel::app
