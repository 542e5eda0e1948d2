#include "mesh/line.hpp"

#include <cmath>
#include <stdexcept>

namespace hosel::mesh {
namespace {

template <class At>
std::vector<LineNode> nodes(const std::vector<double>& ends, At at) {
  if (ends.size() < 2) throw std::invalid_argument("a line needs at least one element");
  std::vector<LineNode> out;
  for (std::size_t e = 0; e + 1 < ends.size(); ++e) {
    if (!(ends[e + 1] > ends[e])) throw std::invalid_argument("the ends of elements must increase");
    out.push_back(at(ends[e]));
    out.push_back(at(0.5 * (ends[e] + ends[e + 1])));
  }
  out.push_back(at(ends.back()));
  return out;
}

}  // namespace

std::vector<double> graded(double length, int elements, double growth) {
  if (!(length > 0) || elements < 1 || !(growth > 0))
    throw std::invalid_argument("a graded line needs a length, elements and a growth above zero");
  std::vector<double> ends{0};
  double h = 1;
  for (int i = 0; i < elements; ++i, h *= growth) ends.push_back(ends.back() + h);
  const double scale = length / ends.back();
  for (double& s : ends) s *= scale;
  ends.back() = length;
  return ends;
}

std::vector<LineNode> straight(const std::vector<double>& ends, const Vec3& start, const Mat3& frame) {
  return nodes(ends, [&](double s) { return LineNode{s, start + s * frame.col(0), frame}; });
}

std::vector<LineNode> arc(const std::vector<double>& ends, double radius, const Vec3& start, const Mat3& frame) {
  return nodes(ends, [&](double s) {
    const double a = s / radius;
    const Mat3 turned = frame * Eigen::AngleAxisd(a, Vec3::UnitZ()).toRotationMatrix();
    return LineNode{s, start + radius * (std::sin(a) * frame.col(0) + (1 - std::cos(a)) * frame.col(1)), turned};
  });
}

Mat3 frame_along(const Vec3& along, const Vec3& towards) {
  Mat3 f;
  f.col(0) = along.normalized();
  f.col(2) = f.col(0).cross(towards).normalized();
  f.col(1) = f.col(2).cross(f.col(0));
  return f;
}

}  // namespace hosel::mesh
