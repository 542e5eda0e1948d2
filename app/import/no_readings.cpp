#include "app/import/no_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/import/cells.hpp"

namespace hosel::app {
namespace {

/// Nines alone, or the last number that a computer's integer holds: they stand for nothing where no reading can be so.
bool fills_a_field(double value) {
  const double a = std::abs(value);
  for (const double nines : {99.0, 999.0, 9999.0, 99.9, 999.9, 9999.9, 99.99, 999.99})
    if (a == nines) return true;
  for (const int bits : {15, 16, 24, 31, 32})
    if (a == std::ldexp(1.0, bits) - 1 || a == std::ldexp(1.0, bits)) return true;
  return false;
}

}  // namespace

bool no_reading(double value) {
  const double a = std::abs(value);
  return a == 99999 || a == 999999 || a == 99999.9 || value == -9999 || value == -999;
}

std::vector<bool> find_placeholders(const MonitorQuantity& q, const Row& raw, const std::string& unit, bool comma) {
  std::vector<bool> out(raw.size()), far(raw.size());
  std::map<double, std::size_t> times;
  std::vector<double> value(raw.size(), NAN);
  std::size_t inside = 0, filled = 0;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const auto cell = number(raw[i], comma, q.sides);
    if (!cell) continue;
    const double si = si_of(cell->unit.empty() ? unit : cell->unit) * cell->value;
    value[i] = cell->value;
    ++filled;
    if (si >= q.low && si <= q.high) {
      ++inside;
      continue;
    }
    ++times[cell->value];
    out[i] = fills_a_field(cell->value);
    far[i] = std::abs(si) > 2 * std::max(std::abs(q.low), std::abs(q.high));
  }
  for (std::size_t i = 0; i < raw.size(); ++i)
    if (far[i] && 2 * inside >= filled && times[value[i]] > 1) out[i] = true;
  return out;
}

std::vector<bool> find_impossible(const MonitorQuantity& q, const Row& raw, const std::string& unit, bool comma) {
  std::vector<bool> out(raw.size());
  std::size_t inside = 0, filled = 0;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const auto cell = number(raw[i], comma, q.sides);
    if (!cell) continue;
    const double si = si_of(cell->unit.empty() ? unit : cell->unit) * cell->value;
    ++filled;
    inside += si >= q.low && si <= q.high;
    out[i] = si < q.least || si > q.greatest;
  }
  if (2 * inside < filled) out.assign(raw.size(), false);  // the unit is wrong, or the column
  return out;
}

void leave_out_placeholders(Reading& r) {
  for (const auto& [row, value] : r.placeholders)
    for (Understood& u : r.session.columns)
      if (!u.name.empty() && split_unit(u.name).unit && plain_number(u.cells[row]) == value) {
        u.cells[row].clear();
        u.remark(fmt::format("{:g} in shot {} is no reading, as beside it", value, row + 1));
        count_again(u);
      }
}

void leave_out_zeros(Reading& r) {
  const auto silent = [&](const char* of, std::initializer_list<const char*> others) {
    const Understood* measured = r.session.find(of);
    for (const char* other : others) {
      Understood* u = r.session.find(other);
      if (!u || !u->filled) continue;
      std::vector<bool> zero, silent_zero;
      for (std::size_t i = 0; i < r.session.shots; ++i) {
        zero.push_back(plain_number(u->cells[i]) == 0);
        silent_zero.push_back(zero.back() && measured && measured->cells[i].empty());
      }
      const bool all = std::size_t(std::ranges::count(zero, true)) == u->filled && r.session.shots > 1;
      if (const std::size_t n = blank(*u, all ? zero : silent_zero); n > 0)
        u->remark(fmt::format("0 taken as not measured: {}", n));
    }
  };
  silent("club_speed", {"attack_angle", "club_path", "face_angle", "face_to_path", "impact_toe", "impact_high"});
  silent("spin_rate", {"spin_axis", "sidespin"});
  silent("ball_speed", {"azimuth"});
}

}  // namespace hosel::app
