#include "loop/shots/averages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "loop/deviation.hpp"

namespace hosel::loop {
namespace {

/// Place of a column in `Averages::scatter`; -1: none.
int place(const Column& c) {
  if (c.role == Role::input) return int(*input_of(c.stem));
  return c.role == Role::output ? kInputs + int(*output_of(c.stem)) : -1;
}

/// Takes out what lies far beyond the others of its cluster, in deviations that all clusters share. Those are told by
/// the differences of two rows: of few rows the distances to their median are too small.
void leave_out(Column& c, const std::vector<std::vector<int>>& rows_of, const Shots& single, Averages& out) {
  std::vector<double> off(c.value.size(), 0.0), differences;
  for (const std::vector<int>& rows : rows_of) {
    std::vector<double> x;
    for (const int i : rows)
      if (const double v = c.value[i]; std::isfinite(v)) {
        for (const double other : x) differences.push_back(std::abs(v - other));
        x.push_back(v);
      }
    if (x.size() < 3) continue;  // of two, which?
    const double middle = median(x);
    for (const int i : rows)
      if (const double v = c.value[i]; std::isfinite(v)) off[i] = v - middle;
  }
  const double deviation = std::max(robust_deviation(differences) / std::sqrt(2.0), c.resolution);
  for (std::size_t i = 0; i < off.size() && deviation > 0; ++i)
    if (std::abs(off[i]) > kFar * deviation) {
      out.notes.push_back(
          fmt::format("{}: {:g} of row {} lies {:.0f} deviations from the others of its {}: left out of the mean",
                      c.name, c.native(i), single.id[i], std::abs(off[i]) / deviation, out.by));
      c.value[i] = kNaN;
    }
}

}  // namespace

std::pair<Shots, Averages> average(Shots shots, const std::string& by) {
  const Column* key = shots.find(by);
  if (!key) throw DataError(fmt::format("{}:1: no column '{}' to average by", shots.file, by));
  const Groups g = groups(*key);
  std::vector<std::vector<int>> rows_of(g.name.size());
  for (std::size_t i = 0; i < g.of_row.size(); ++i)
    if (g.of_row[i] >= 0) rows_of[g.of_row[i]].push_back(int(i));

  Averages out;
  out.by = by;
  out.single = std::move(shots);
  Shots means;
  const Shots& single = out.single;
  if (const auto lost = std::ranges::count(g.of_row, -1))
    out.notes.push_back(fmt::format("{} rows without a {}: part of no mean", lost, by));
  means.file = single.file;
  means.id = g.name;
  for (const std::vector<int>& rows : rows_of) means.line.push_back(single.line[rows.front()]);

  const auto n = Eigen::Index(single.rows());
  Eigen::MatrixXd deviation = Eigen::MatrixXd::Zero(n, kInputs + kOutputs);
  std::vector<char> whole(single.rows(), 1);
  out.count.assign(rows_of.size(), int(n));
  for (const Column& read : single.columns) {
    if (read.name == "shot") continue;
    Column mean = read;
    mean.broken.clear();
    if (!read.numeric) {
      mean.text.clear();
      for (const std::vector<int>& rows : rows_of) {
        const std::string& first = read.text[rows.front()];
        const bool one = std::ranges::all_of(rows, [&](int i) { return read.text[i] == first; });
        mean.text.push_back(one ? first : "");
      }
      means.columns.push_back(std::move(mean));
      continue;
    }
    Column clean = read;
    const int at = place(read);
    if (at >= 0) leave_out(clean, rows_of, single, out);
    mean.value.clear();
    for (std::size_t k = 0; k < rows_of.size(); ++k) {
      double sum = 0;
      int count = 0;
      for (const int i : rows_of[k])
        if (const double x = clean.value[i]; std::isfinite(x)) sum += x, ++count;
      mean.value.push_back(count ? sum / count : kNaN);
      if (read.role == Role::output) out.count[k] = std::min(out.count[k], count);
      for (const int i : rows_of[k]) {
        if (at < 0) continue;
        deviation(i, at) = clean.value[i] - mean.value.back();
        if (std::isnan(deviation(i, at))) whole[i] = 0;
      }
    }
    means.columns.push_back(std::move(mean));
  }
  for (std::size_t k = 0; k < rows_of.size(); ++k)
    if (out.count[k] == 0)
      throw DataError(fmt::format("{}: {} '{}' has no reading of some output: no mean", single.file, by, g.name[k]));

  out.scatter = Eigen::MatrixXd::Zero(kInputs + kOutputs, kInputs + kOutputs);
  for (const std::vector<int>& rows : rows_of) {
    int here = 0;
    Eigen::VectorXd middle = Eigen::VectorXd::Zero(deviation.cols());
    for (const int i : rows)
      if (whole[i]) middle += deviation.row(i).transpose(), ++here;
    if (here < 2) continue;
    middle /= here;
    for (const int i : rows) {
      if (!whole[i]) continue;
      const Eigen::VectorXd d = deviation.row(i).transpose() - middle;
      out.scatter += d * d.transpose();
    }
    out.degrees += here - 1;
  }
  if (out.degrees < kFewestDegrees)
    throw DataError(fmt::format(
        "{}: {} rows more than values of {}: too few to tell how rows scatter about their mean ({} are needed)",
        single.file, out.degrees, by, kFewestDegrees));
  out.scatter /= out.degrees;
  out.notes.push_back(fmt::format(
      "{} rows stand as {} means by {}; the noise of a mean is the rows' own scatter about it, {} degrees of freedom",
      n, rows_of.size(), by, out.degrees));
  return {std::move(means), std::move(out)};
}

}  // namespace hosel::loop
