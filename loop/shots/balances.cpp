#include "loop/shots/balances.hpp"

#include <algorithm>

#include "golf/dense.hpp"
#include "golf/first_contact.hpp"

namespace hosel::loop {

double Balance::inertia_share() const {
  const double c = std::max(0.0, contact - contact_freedom), i = std::max(0.0, inertia - inertia_freedom);
  return c + i > 0 ? i / (c + i) : 0;
}

Balance balance(const ShotModel& shots, const std::vector<int>& rows, const Model& model, const double* parameters) {
  Balance out;
  const int m = shots.width();
  const Eigen::MatrixXd residuals = shots.residuals(model, parameters);
  for (const int row : rows) {
    const Shot& trial = shots.trial(row);
    const Ball& ball = trial.blow.ball;
    Launch l;
    if (!shots.launch(trial, model, parameters, l)) continue;
    const Vec3 n = first_contact(trial.blow).normal;
    // Channels by the three components of the impulse, a thousandth of the ball's momentum each way.
    Eigen::MatrixXd B = Eigen::MatrixXd::Zero(m, 3);
    Eigen::VectorXd z = Eigen::VectorXd::Zero(m);
    int observed = 0;
    const double step = 1e-3 * ball.mass * l.velocity.norm();
    for (int c = 0; c < m; ++c) {
      const ShotChannel& channel = shots.channel(c);
      if (!shots.observed(row, c) || of_flight(channel.output)) continue;
      ++observed;
      z[c] = residuals(row, c);
      for (int k = 0; k < 3; ++k) {
        const auto moved = [&](double sign) {
          Launch x = l;
          const Vec3 J = sign * step * Vec3::Unit(k);
          x.velocity += J / ball.mass;
          x.spin -= ball.radius / ball.inertia() * n.cross(J);
          return get(x, channel.output) / channel.si;
        };
        B(c, k) = 0.5 * (moved(1) - moved(-1));
      }
    }
    const auto W = shots.whitening(row);
    Eigen::VectorXd e = W * z;
    Eigen::MatrixXd WB = W * B;
    // No impulse mends a flight, which starts from the launch that was seen; those channels stand last.
    for (int c = 0; c < m; ++c)
      if (of_flight(shots.channel(c).output)) {
        e[c] = 0;
        WB.row(c).setZero();
      }
    const dense::PivotedQr qr(WB);
    const Eigen::VectorXd u = qr.solve(e);
    const double left = (e - WB * u).squaredNorm();
    const int mended = int(std::min<std::ptrdiff_t>(qr.rank(), observed));
    out.inertia += left;
    out.contact += e.squaredNorm() - left;
    out.inertia_freedom += observed - mended;
    out.contact_freedom += mended;
  }
  return out;
}

}  // namespace hosel::loop
