#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/read_solid.hpp"
#include "post/figure.hpp"
#include "post/table.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace {

/// Stretch or shear over time: what the point is driven along.
class MaterialPointJob final : public Job {
 public:
  explicit MaterialPointJob(CaseFile& file) : solid_(read_solid(file.root().table("material"))) {
    Table root = file.root();
    Table path = root.table("path");
    what_ = path.choice({"kind", "strain path"}, {"uniaxial", "shear", "relaxation", "hysteresis"});
    if (what_ == "uniaxial") {
      low_ = path.number({"stretch_from", "first stretch"}, {0.05, 1}, 0.5);
      high_ = path.number({"stretch_to", "last stretch"}, {1, 10}, 2.0);
    } else {
      high_ = path.number({"shear", "amount of shear"}, {-5, 5});
    }
    // Uniaxial and shear run over this time at constant rate; relaxation holds the step for it;
    // hysteresis is a half sine of it.
    duration_ = path.quantity({"duration", "of the path"}, "ms", Range::positive());
    steps_ = path.integer({"steps", "of the path"}, 2, 1000000, 200);
  }

  void run(Output& out) override {
    post::Panel panel;
    panel.title = what_;
    post::Series curve;
    post::Table table;
    if (what_ == "uniaxial")
      table.in_files(
          {"time_s", "stretch", "lateral_stretch", "nominal_stress_Pa", "cauchy_stress_Pa", "dissipated_J_per_m3"},
          "{:.9g}");
    else table.in_files({"time_s", "shear", "shear_stress_Pa", "work_J_per_m3", "dissipated_J_per_m3"}, "{:.9g}");
    std::vector<double> history(static_cast<std::size_t>(solid_.history_size()));
    solid_.start(history);
    double work = 0, dissipated = 0, stress0 = 0, strain0 = 0, last = 0;
    const double dt = duration_ / double(steps_);
    fem::PointResponse r;
    const auto record = [&](double t, double x, const Mat3& F, double lateral, double step) {
      fem::evaluate(solid_, F, Mat3::Identity(), step, history, false, r);
      dissipated += fem::update_internal_variables(solid_, F, step, history);
      if (what_ == "uniaxial") {
        last = r.stress(0, 0);
        table.add(t, x, lateral, last, last / (lateral * lateral), dissipated);
        curve.add(x, last / 1e6);
      } else {
        last = r.stress(0, 1);
        work += 0.5 * (last + stress0) * (x - strain0);
        stress0 = last;
        strain0 = x;
        table.add(t, x, last, work, dissipated);
        curve.add(what_ == "relaxation" ? t * 1e3 : x, last / 1e6);
      }
    };
    if (what_ == "uniaxial") {
      // Compression from 1 down, then tension from 1 up, each over the whole duration.
      for (const double end : {low_, high_}) {
        solid_.start(history);
        dissipated = 0;
        double lateral = 1;
        for (long i = 0; i <= steps_; ++i) {
          const double x = 1 + (end - 1) * double(i) / double(steps_), step = i == 0 ? 0 : dt;
          lateral = free_lateral(x, lateral, step, history);
          record(double(i) * dt, x, Vec3(x, lateral, lateral).asDiagonal(), lateral, step);
        }
        panel.series.push_back({end < 1 ? "compression" : "tension", curve.x, curve.y});
        curve = {};
      }
      panel.x_label = "stretch";
      panel.y_label = "nominal stress [MPa]";
    } else {
      for (long i = 0; i <= steps_; ++i) {
        const double f = double(i) / double(steps_);
        const double x = what_ == "shear" ? high_ * f : what_ == "relaxation" ? high_ : high_ * std::sin(kPi * f);
        Mat3 F = Mat3::Identity();
        F(0, 1) = x;
        record(f * duration_, x, F, 1, i == 0 ? 0 : dt);
      }
      panel.series.push_back({"", curve.x, curve.y});
      panel.x_label = what_ == "relaxation" ? "time [ms]" : "shear";
      panel.y_label = "shear stress [MPa]";
    }
    out.write("history.csv", table.csv());
    post::Figure figure;
    figure.panels.push_back(panel);
    out.draw(figure, "curve");
    nlohmann::json summary{{"path", what_}, {"final_stress_Pa", last}, {"dissipated_J_per_m3", dissipated}};
    if (what_ != "uniaxial") summary["work_J_per_m3"] = work;
    out.page().answer("stress at the end", fmt::format("{:.4g} MPa", 1e-6 * last),
                      what_ == "uniaxial" ? "nominal, in tension" : "of shear");
    out.page().answer("turned into heat", fmt::format("{:.4g} kJ/m³", 1e-3 * dissipated), "per volume");
    out.say(fmt::format("{}: final stress {:.6g} Pa, dissipated {:.6g} J/m^3", what_, last, dissipated));
    out.write_summary(summary);
  }

 private:
  /// Lateral stretch that leaves the sides free of stress.
  double free_lateral(double stretch, double start, double dt, const std::vector<double>& history) const {
    fem::PointResponse r;
    double lateral = start;
    for (int i = 0; i < 50; ++i) {
      fem::evaluate(solid_, Vec3(stretch, lateral, lateral).asDiagonal(), Mat3::Identity(), dt, history, true, r);
      const double step = r.stress(1, 1) / (r.tangent(4, 4) + r.tangent(4, 8));
      lateral -= step;
      if (!(lateral > 0)) break;
      if (std::abs(step) < 1e-14) return lateral;
    }
    throw solvers::NonConvergence(
        fmt::format("no lateral stretch leaves the sides free at a stretch of {}: the material collapses", stretch));
  }

  fem::Solid solid_;
  std::string what_;
  double low_ = 1, high_ = 1, duration_ = 0;
  long steps_ = 0;
};

}  // namespace

std::unique_ptr<Job> read_material_point(CaseFile& file) { return std::make_unique<MaterialPointJob>(file); }

}  // namespace hosel::app
