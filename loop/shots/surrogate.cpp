#include "loop/shots/surrogate.hpp"

#include <algorithm>
#include <atomic>
#include <optional>
#include <stdexcept>
#include <utility>

#include "golf/parallel.hpp"
#include "loop/shots/features.hpp"
#include "solvers/errors.hpp"

namespace hosel::loop {
namespace {

Vec6 in_face(const Launch& l, const Shot& s) {
  const Mat3 R = s.blow.delivery.face_to_global().transpose();
  Vec6 out;
  out << R * l.velocity, R * l.spin;
  return out / s.blow.delivery.club_speed;
}

}  // namespace

Surrogate::Surrogate(Answer slow, Answer quick) : slow_(std::move(slow)), quick_(std::move(quick)) {}

void Surrogate::learn(const std::vector<Shot>& shots, const std::function<void(int)>& told) {
  std::vector<std::optional<Vec6>> found(shots.size());
  std::atomic<int> done = 0;
  for_all(std::size_t(0), shots.size(), [&](std::size_t i) {
    try {
      const Vec6 beyond = in_face(slow_(shots[i]), shots[i]) - in_face(quick_(shots[i]), shots[i]);
      if (beyond.allFinite()) found[i] = beyond;
    } catch (const std::invalid_argument&) {
    } catch (const solvers::NonConvergence&) {}
    if (told) told(++done);
  });
  surprise_ = surprise(shots, found);
  for (std::size_t i = 0; i < shots.size(); ++i) {
    if (!found[i]) {
      ++failed_;
      continue;
    }
    shots_.push_back(shots[i]);
    beyond_.push_back(*found[i]);
  }
  fit();
}

double Surrogate::surprise(const std::vector<Shot>& shots, const std::vector<std::optional<Vec6>>& found) const {
  if (shots_.empty()) return kNaN;
  double sum = 0;
  int readings = 0;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    if (!found[i]) continue;
    const Eigen::VectorXd x = coordinates(shots[i]);
    const Vec6 miss = *found[i] - process_(x), told = process_.error(x).diagonal();
    for (Eigen::Index k = 0; k < told.size(); ++k)
      if (told[k] > 0) {
        sum += miss[k] * miss[k] / told[k];
        ++readings;
      }
  }
  return readings ? sum / readings : kNaN;
}

void Surrogate::fit() {
  const auto n = Eigen::Index(shots_.size());
  if (n < 8) throw std::invalid_argument("fewer than eight blows have an answer");
  const auto all = features();
  Eigen::MatrixXd value(n, Eigen::Index(all.size()));
  for (Eigen::Index i = 0; i < n; ++i)
    for (std::size_t k = 0; k < all.size(); ++k) value(i, Eigen::Index(k)) = all[k].get(shots_[i]);
  const std::vector<std::size_t> before = std::exchange(features_, {});
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto column = value.col(Eigen::Index(k));
    const double low = column.minCoeff(), high = column.maxCoeff();
    if (varies(high - low, low)) features_.push_back(k);
  }
  const auto d = Eigen::Index(features_.size());
  middle_.resize(d);
  half_.resize(d);
  Eigen::MatrixXd x(n, d), y(n, 6);
  for (Eigen::Index k = 0; k < d; ++k) {
    const auto column = value.col(Eigen::Index(features_[k]));
    middle_[k] = 0.5 * (column.minCoeff() + column.maxCoeff());
    half_[k] = 0.5 * (column.maxCoeff() - column.minCoeff());
    x.col(k) = (column.array() - middle_[k]) / half_[k];
  }
  for (Eigen::Index i = 0; i < n; ++i) y.row(i) = beyond_[i].transpose();
  solvers::Kriging::Correlation from;
  if (features_ == before) from = process_.correlation();
  process_ = {x, y, std::move(from)};
}

Eigen::VectorXd Surrogate::coordinates(const Shot& shot) const {
  Eigen::VectorXd x(Eigen::Index(features_.size()));
  for (Eigen::Index k = 0; k < x.size(); ++k)
    x[k] = std::clamp((features()[features_[k]].get(shot) - middle_[k]) / half_[k], -1.0, 1.0);
  return x;
}

Launch Surrogate::launch(const Shot& shot) const {
  Launch quick = quick_(shot);
  if (shots_.empty()) return quick;
  const Eigen::VectorXd x = coordinates(shot);
  return shifted(quick, shot, process_(x));
}

Mat6 Surrogate::error(const Shot& shot) const {
  if (shots_.empty()) return Mat6::Zero();
  return process_.error(coordinates(shot));
}

Eigen::MatrixXd Surrogate::errors_together(const std::vector<Shot>& shots) const {
  Eigen::MatrixXd x(Eigen::Index(shots.size()), Eigen::Index(features_.size()));
  for (std::size_t i = 0; i < shots.size(); ++i) x.row(Eigen::Index(i)) = coordinates(shots[i]).transpose();
  return process_.errors_together(x);
}

Launch Surrogate::shifted(Launch l, const Shot& s, const Vec6& error) {
  const Mat3 R = s.blow.delivery.face_to_global();
  l.velocity += s.blow.delivery.club_speed * (R * error.head<3>());
  l.spin += s.blow.delivery.club_speed * (R * error.tail<3>());
  return l;
}

}  // namespace hosel::loop
