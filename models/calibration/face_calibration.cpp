#include "models/calibration/face_calibration.hpp"

namespace hosel::models {
namespace {

FaceCompliance face_of(const Eigen::VectorXd& p) {
  return {.mass = p[0], .stiffness = p[1], .damping = p[2], .half_width = p[3], .half_height = p[4]};
}

}  // namespace

FaceCalibration calibrate_face(const Head& head, const Striker& sphere, const Striker& ball, const FaceTarget& target) {
  const std::vector<double> speeds = pendulum_speeds();
  const solvers::Residuals residuals = [&](const Eigen::VectorXd& p, Eigen::VectorXd& r) {
    const FaceCompliance face = face_of(p);
    Eigen::Index i = 0;
    for (const FaceTarget::Tap& tap : target.taps) {
      const double shape = face.shape(-tap.toe, tap.high).value;
      const double time = characteristic_time(sphere, mass_at(head, -tap.toe, tap.high), face, shape, speeds).time;
      r[i++] = (time - tap.time) / target.tap_sigma;
    }
    r[i++] = (strike(ball, mass_at(head, 0, 0), face, 1, target.speed).restitution - target.restitution) /
             target.restitution_sigma;
    r[i] = (face.mass - target.mass) / target.mass_sigma;
    return true;
  };
  Eigen::VectorXd start(5);
  start << target.mass, 6e6, 15, 0.045, 0.028;
  const std::vector<solvers::Bounds> bounds = {{1e-3, 0.04}, {1e6, 4e7}, {0, 100}, {0.02, 0.09}, {0.015, 0.06}};
  const solvers::LeastSquaresFit fit =
      solvers::least_squares(residuals, static_cast<int>(target.taps.size()) + 2, start, bounds);
  const solvers::Identifiability seen = solvers::identifiability(fit.jacobian, bounds);
  return {face_of(fit.parameters),
          {seen.sd.begin(), seen.sd.end()},
          solvers::at_bounds(fit.parameters, bounds),
          seen.correlation,
          fit.cost};
}

}  // namespace hosel::models
