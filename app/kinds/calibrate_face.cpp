#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/offer.hpp"
#include "app/read_blow.hpp"
#include "models/calibration/face_calibration.hpp"
#include "post/digits.hpp"
#include "post/figure.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace {

class CalibrateFaceJob final : public Job {
 public:
  explicit CalibrateFaceJob(CaseFile& file) {
    Table root = file.root();
    ball_ = read_ball(root.table("ball"));
    head_ = read_head(root.table("head"));
    radius_ = root.table("sphere").quantity({"radius", "of the pendulum's sphere"}, "mm", {1e-3, 0.1}, 0.011);
    for (Table tap : root.tables("tap"))
      target_.taps.push_back(
          {.toe = tap.quantity({"toe", "of the tap, from the face's centre towards the toe"}, "mm", {-0.1, 0.1}, 0.0),
           .high = tap.quantity({"high", "of the tap, from the face's centre up"}, "mm", {-0.1, 0.1}, 0.0),
           .time = tap.quantity({"time", "measured characteristic time there"}, "us", {1e-5, 1e-3})});
    using Tap = models::FaceTarget::Tap;
    const auto any = [&](double Tap::*off) {
      return std::ranges::any_of(target_.taps, [&](const Tap& tap) { return tap.*off != 0; });
    };
    if (target_.taps.size() < 3 || !any(&Tap::toe) || !any(&Tap::high))
      root.fail(
          "tap",
          "at least three [[tap]], one of them off the centre towards toe or heel, one up or down: with restitution "
          "and mass they tell five parameters");
    Table target = root.table("target");
    target_.tap_sigma = target.quantity({"tap_sigma", "standard error of the characteristic times"}, "us",
                                        Range::positive(), target_.tap_sigma);
    target_.restitution = target.number({"restitution", "measured restitution of the ball at speed"}, {0.1, 1});
    target_.restitution_sigma =
        target.number({"restitution_sigma", "standard error of the restitution"}, {1e-5, 1}, target_.restitution_sigma);
    target_.speed = target.quantity({"speed", "at which the restitution was measured"}, "mps", {1, 100}, target_.speed);
    target_.mass = target.quantity({"effective_mass", "of the face, as estimated"}, "g", {1e-3, 0.04});
    target_.mass_sigma =
        target.quantity({"effective_mass_sigma", "standard error of the effective mass"}, "g", Range::positive());
  }

  void run(Output& out) override {
    const models::FaceCalibration fit =
        models::calibrate_face(head_, models::steel_sphere(radius_), models::golf_ball(ball_), target_);
    const FaceCompliance& f = fit.face;
    struct Row {
      const char* name;
      double value, unit;
    };
    const std::array<Row, 5> rows = {{{"effective_mass_g", f.mass, 1e3},
                                      {"stiffness_N_per_m", f.stiffness, 1},
                                      {"damping_N_s_per_m", f.damping, 1},
                                      {"half_width_mm", f.half_width, 1e3},
                                      {"half_height_mm", f.half_height, 1e3}}};
    nlohmann::json summary{{"cost", fit.cost}};
    std::string toml = "[face]\n";
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto& [name, value, unit] = rows[i];
      const SplitName split = split_unit(name);
      const std::string symbol = post::symbol(split.unit->suffix);
      const post::Digits digits = post::digits(unit * value, fit.at_bound[i] ? 0 : unit * fit.sd[i]);
      out.page().answer(post::spoken(split.stem), fmt::format("{} {}", digits.value, symbol),
                        fit.at_bound[i] ? "at its bound" : "± " + digits.deviation);
      out.say(fmt::format("{:<20} {:12.5g} +- {:.2g}{}", name, unit * value, unit * fit.sd[i],
                          fit.at_bound[i] ? "  at its bound" : ""));
      toml += fmt::format("{} = {:.5g}\n", name, unit * value);
      summary["parameters"].push_back(
          {{"name", name}, {"value", unit * value}, {"sd", unit * fit.sd[i]}, {"at_bound", bool(fit.at_bound[i])}});
    }
    const std::size_t data = target_.taps.size() + 2;
    constexpr double rounding = 1e-9;  // of a miss, in standard deviations
    const double missed = std::sqrt(2 * fit.cost / double(data));
    out.say(missed < rounding ? fmt::format("the face meets all {} data", data)
                              : fmt::format("the face misses the {} data by {:.3g} of their standard deviations, root "
                                            "mean square",
                                            data, missed));
    constexpr double far = 2;  // beyond it the face has not the form of the fit, or an error is stated too small
    if (missed > far)
      out.warn(
          fmt::format("the face misses the data by {:.1f} of their standard deviations (root mean square): "
                      "the deviations of its parameters say nothing of that",
                      missed));
    out.show(taps(f), "Characteristic times");
    out.draw(figure(f), "times");
    out.write("face.toml", toml);
    withdraw_offers(out);
    offer(out, Shelf::faces, offered(fit), face_tables(fit.face));
    out.write_summary(summary);
  }

 private:
  Offer offered(const models::FaceCalibration& fit) const {
    const FaceCompliance& f = fit.face;
    Offer o{.what = fmt::format("a face by characteristic time, restitution {:g} at {:g} m/s and the plate's mass",
                                target_.restitution, target_.speed),
            .source = fmt::format("{} characteristic times, one restitution, an estimated mass", target_.taps.size()),
            .parameters = {"effective mass [g]", "stiffness [N/m]", "damping [N s/m]", "half width [mm]",
                           "half height [mm]"},
            .values = {1e3 * f.mass, f.stiffness, f.damping, 1e3 * f.half_width, 1e3 * f.half_height},
            .of = std::vector<std::string>(5, "value")};
    const Eigen::Vector<double, 5> unit(1e3, 1, 1, 1e3, 1e3), sd = Eigen::Map<const Eigen::VectorXd>(fit.sd.data(), 5);
    o.covariance = (sd.cwiseProduct(unit)).asDiagonal() * fit.correlation * (sd.cwiseProduct(unit)).asDiagonal();
    for (std::size_t k = 0; k < 5; ++k)
      if (!std::isfinite(fit.sd[k])) o.unidentified.push_back(o.parameters[k]);
    o.seen.impact_speed = Interval{0, target_.speed};
    o.seen.not_for = {"another face than that of the taps", "points of the face far from the taps"};
    return o;
  }

  double time_of(const FaceCompliance& face, double toe, double high) const {
    return models::characteristic_time(models::steel_sphere(radius_), models::mass_at(head_, -toe, high), face,
                                       face.shape(-toe, high).value, models::pendulum_speeds())
        .time;
  }

  post::TextTable taps(const FaceCompliance& face) const {
    post::TextTable t{.rows = {{"tap, toe and up [mm]", "measured [µs]", "fitted [µs]", "off by [sd]"}}};
    for (const models::FaceTarget::Tap& tap : target_.taps) {
      const double fitted = time_of(face, tap.toe, tap.high);
      t.rows.push_back({fmt::format("{:g}, {:g}", 1e3 * tap.toe, 1e3 * tap.high), fmt::format("{:.1f}", 1e6 * tap.time),
                        fmt::format("{:.1f}", 1e6 * fitted),
                        post::beside(std::round(10 * (fitted - tap.time) / target_.tap_sigma) / 10, 0)});
    }
    return t;
  }

  /// Characteristic times along the face's two middle lines beside the taps on them.
  post::Figure figure(const FaceCompliance& face) const {
    post::Figure out{.columns = 2};
    for (const bool toe : {true, false}) {
      using Tap = models::FaceTarget::Tap;
      double Tap::*along = toe ? &Tap::toe : &Tap::high, Tap::*across = toe ? &Tap::high : &Tap::toe;
      post::Series taps{.label = "the taps of the case, one standard error"}, line{.label = "the fitted face"};
      double reach = 0;
      for (const Tap& tap : target_.taps) {
        if (tap.*across != 0) continue;
        reach = std::max(reach, std::abs(tap.*along));
        taps.add(1e3 * tap.*along, 1e6 * tap.time);
        taps.error.push_back(1e6 * target_.tap_sigma);
      }
      if (reach == 0) continue;
      for (int i = -12; i <= 12; ++i) {
        Tap at;
        at.*along = 1.2 * reach * i / 12;
        line.add(1e3 * at.*along, 1e6 * time_of(face, at.toe, at.high));
      }
      out.panels.push_back({.x_label = toe ? "towards the toe [mm]" : "up the face [mm]",
                            .y_label = "characteristic time [µs]",
                            .series = {taps, line}});
    }
    return out;
  }

  Ball ball_;
  Head head_;
  double radius_ = 0;
  models::FaceTarget target_;
};

}  // namespace

std::unique_ptr<Job> read_calibrate_face(CaseFile& file) { return std::make_unique<CalibrateFaceJob>(file); }

}  // namespace hosel::app
