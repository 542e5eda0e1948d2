#include "app/kinds/characteristic_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "app/read_face.hpp"
#include "golf/face_library.hpp"
#include "golf/units.hpp"
#include "models/reduced/face_strike.hpp"
#include "post/figure.hpp"

namespace hosel::app {
namespace {

/// The rules' line between characteristic time [us] and restitution.
double rules_line(double time_us) { return 0.718 + 0.000436 * time_us; }
/// How near a lumped face is asked to come to it.
constexpr double kClose = 0.008;
/// What the rules allow, and their tolerance [us]. Their instrument reads whole microseconds.
constexpr double kLargest = 239, kTolerance = 18;

class CharacteristicTimeJob final : public Job {
 public:
  explicit CharacteristicTimeJob(CaseFile& file) {
    Table root = file.root();
    head_ = read_head(root.table("head"));
    face_ = read_yielding_face(root);
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
    RunPage& page = out.page();
    const bool conforms = std::round(1e6 * ct.time) <= kLargest + kTolerance;
    const std::string verdict = fmt::format("{} the rules' test: at most {} µs and a tolerance of {} µs",
                                            conforms ? "passes" : "fails", kLargest, kTolerance);
    out.say("this face " + verdict);
    page.answer("characteristic time", fmt::format("{:.1f} µs", 1e6 * ct.time),
                fmt::format("{}; slope {:.1f} µs (m/s)^0.329", verdict, 1e6 * ct.slope));
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
    tap.series = {points, line};
    out.write("taps.csv", csv);

    nlohmann::json summary{{"characteristic_time_us", 1e6 * ct.time},
                           {"conforms", conforms},
                           {"slope_us", 1e6 * ct.slope},
                           {"largest_departure_us", 1e6 * ct.departure}};
    const models::Striker ball = models::golf_ball({});
    summary["restitution"] = models::strike(ball, mass, face_, shape, restitution_speed_).restitution;
    page.answer("restitution", fmt::format("{:.4f}", summary["restitution"].get<double>()),
                fmt::format("the rules' line says {:.4f}", rules_line(1e6 * ct.time)));
    summary["restitution_rigid"] = models::strike(ball, mass, {}, 0, restitution_speed_).restitution;
    post::Panel rules{
        .title = "faces from stiff to soft", .x_label = "characteristic time [us]", .y_label = "restitution"};
    post::Series wanted{.label = "0.718 + 0.000436 CT / us"};
    csv =
        "effective_mass_g,stiffness_N_per_m,characteristic_time_us,restitution,rules_line,contact_in_face_periods,"
        "face_energy_J\n";
    const auto stiffness = [&](int i) { return softest_ * std::pow(stiffest_ / softest_, i / double(faces_ - 1)); };
    for (const double face_mass : masses_) {
      post::Series series{.label = fmt::format("face of {:g} g", 1e3 * face_mass), .style = "linespoints"};
      double worst = 0;
      for (int i = 0; i < faces_; ++i) {
        const Compared face = compare(mass, shape, face_mass, stiffness(i));
        const double k = face.face.stiffness, periods = face.drive.contact_time * std::sqrt(k / face_mass) / (2 * kPi);
        worst = std::max(worst, std::abs(face.departure()));
        series.x.push_back(face.time_us);
        series.y.push_back(face.drive.restitution);
        csv += fmt::format("{},{:.5g},{:.3f},{:.5f},{:.5f},{:.3f},{:.3f}\n", 1e3 * face_mass, k, face.time_us,
                           face.drive.restitution, rules_line(face.time_us), periods, face.drive.energy);
      }
      out.say(fmt::format("faces of {:4.1f} g, {:.0f} to {:.0f} us: within {:.4f} of the rules' line", 1e3 * face_mass,
                          series.x.back(), series.x.front(), worst));
      page.answer(fmt::format("faces of {:g} g", 1e3 * face_mass), fmt::format("within {:.4f}", worst),
                  fmt::format("of the rules' line, {:.0f} to {:.0f} µs", series.x.back(), series.x.front()));
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
    post::Panel plane{.title = "restitution less the rules' line, thousandths",
                      .x_label = "effective mass of the face [g]",
                      .y_label = "its stiffness [MN/m]"};
    plane.map_label = "[0.001]";
    plane.map_symmetric = true;
    const auto [lightest, heaviest] = std::ranges::minmax(masses_);
    constexpr int kColumns = 31;
    int inside = 0;
    double always = 0;  // heaviest mass at which every stiffness lies inside
    std::vector<bool> whole(kColumns, true);
    for (int i = 0; i < kColumns; ++i)
      plane.map_x.push_back(1e3 * (lightest + (heaviest - lightest) * i / (kColumns - 1)));
    for (int j = 0; j < faces_; ++j) {
      plane.map_y.push_back(1e-6 * stiffness(j));
      for (int i = 0; i < kColumns; ++i) {
        const double off = compare(mass, shape, 1e-3 * plane.map_x[i], stiffness(j)).departure();
        plane.map.push_back(1e3 * off);
        const bool in = std::abs(off) <= kClose;
        inside += in;
        whole[i] = whole[i] && in;
      }
    }
    for (int i = 0; i < kColumns && whole[i]; ++i) always = plane.map_x[i];
    const double share = 100.0 * inside / double(plane.map.size());
    out.say(
        fmt::format("between {:g} and {:g} g: {:.0f} % of the faces within {} of the line, all of them up to {:.1f} g",
                    1e3 * lightest, 1e3 * heaviest, share, kClose, always));
    summary["inside_percent"] = share;
    summary["all_inside_up_to_g"] = always;
    post::Figure figure{.panels = {tap, rules, plane}, .columns = 3};
    out.draw(figure, "characteristic-time");
    out.write_summary(summary);
  }

 private:
  /// A face of the same shape and damping in the same head, beside the rules' line.
  struct Compared {
    FaceCompliance face;
    double time_us = 0;
    models::FaceStrike drive;
    double departure() const { return drive.restitution - rules_line(time_us); }
  };
  Compared compare(double head_mass, double shape, double face_mass, double stiffness) const {
    Compared out{.face = face_};
    out.face.mass = face_mass;
    out.face.stiffness = stiffness;
    out.time_us = 1e6 * models::characteristic_time(sphere_, head_mass, out.face, shape, speeds_).time;
    out.drive = models::strike(models::golf_ball({}), head_mass, out.face, shape, restitution_speed_);
    return out;
  }

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
