#include "app/import/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/import/carry_ratio.hpp"
#include "app/import/column_units.hpp"
#include "app/reader.hpp"
#include "loop/deviation.hpp"
#include "models/rigid/rigid_planar.hpp"

namespace hosel::app {
namespace {

/// Mishits and wedges change ball over club speed by less than this, km/h under mph by 1.61.
constexpr double kNoSmash = 1.35;

/// Ball over club speed that a rigid head makes with the loft at impact, in the median of the shots whose loft is
/// recorded or the club's nominal one; 0 where there is none.
double expected_smash(Reading& r) {
  const Understood *loft = r.session.find("dynamic_loft"), *clubs = r.session.find("club");
  std::vector<double> ratios;
  for (std::size_t i = 0; i < r.session.shots; ++i) {
    const NominalClub* club = r.dictionary.club(clubs ? clubs->cells[i] : r.club);
    const auto recorded = loft ? plain_number(loft->cells[i]) : std::nullopt;
    if (!recorded && !club) continue;
    const double angle = recorded ? *recorded * split_unit(loft->name).unit->si : club->loft * si_of("deg");
    if (!(std::abs(angle) < radians(80))) continue;  // told elsewhere
    Blow blow;
    blow.delivery = {.club_speed = 40, .dynamic_loft = angle};
    blow.club.head.mass = club ? club->head_mass : 0.25;
    ratios.push_back(models::RigidPlanar().launch(blow).ball_speed() / blow.delivery.club_speed);
  }
  return ratios.empty() ? 0 : loop::median(ratios);
}

}  // namespace

void check_range(const Reading& r, const MonitorQuantity& q, std::size_t column, const Understood& u,
                 const std::string& given) {
  const auto fail = [&](const std::string& why) {
    return InputError(fmt::format("{}: column '{}'{}", r.session.file.string(), u.header, why));
  };
  if (given == "mm" && !r.by_hand.of(u.header, r.session.sheet.names) && u.filled > 2 && in_metres(r, column))
    throw fail(
        fmt::format(": no shot is 0.05 mm from the centre of the face: it reads like m; say --column "
                    "'{}={}_m'",
                    u.header, q.name));
  if (u.filled > 0 && !(u.median >= q.low && u.median <= q.high)) {
    std::string reads;
    for (const Unit& other : all_units())
      if (other.dimension == split_unit(u.name).unit->dimension && other.suffix != given) {
        const double median = u.median / si_of(given) * other.si;
        if (median >= q.low && median <= q.high) reads += (reads.empty() ? "" : " or ") + std::string(other.suffix);
      }
    throw fail(fmt::format(": the median {:.4g} {} is no {} (allowed: {}){}; say --column '{}={}_UNIT'",
                           u.median / si_of(given), given, q.name,
                           Range{q.low, q.high}.allowed(Unit{given, *dimension_of(given), si_of(given)}),
                           reads.empty() ? "" : ": it reads like " + reads, u.header, q.name));
  }
}

void compare_with_landing(Reading& r) {
  Understood* spin = r.session.find("spin_axis") ? r.session.find("spin_axis") : r.session.find("sidespin");
  const Understood* azimuth = r.session.find("azimuth");
  if (!spin || !azimuth || r.session.carry.cells.empty()) return;
  const Sheet& sheet = r.session.sheet;
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    if (!r.dictionary.says("carry_side", sheet.names[c]) || !r.roles[c].empty() || r.is_empty(c)) continue;
    const Row said = r.cells(c);
    const bool comma = r.has_decimal_comma(c);
    const std::string unit = r.stated_length(c).empty() ? r.session.carry.name : r.stated_length(c);
    const double turn = sign_in(sheet.names[c], Sides::across).sign < 0 ? -1 : 1;
    std::vector<std::pair<double, double>> both;  // spin, and by how much the side exceeds that of a straight flight
    for (std::size_t i = 0; i < r.session.shots; ++i) {
      const auto side = number(said[i], comma, Sides::across);
      const auto x = plain_number(spin->cells[i]), a = plain_number(azimuth->cells[i]),
                 carry = plain_number(r.session.carry.cells[i]);
      if (!side || !x || !a || !carry || *carry <= 0) continue;
      const double across = (side->sided ? 1 : turn) * side->value * si_of(unit) /
                            (*carry * si_of(r.session.carry.name));
      both.emplace_back(*x, across - std::sin(*a * split_unit(azimuth->name).unit->si));
    }
    double n = double(both.size()), sx = 0, sy = 0, xx = 0, yy = 0, xy = 0;
    for (const auto& [x, y] : both) sx += x / n, sy += y / n;
    for (const auto& [x, y] : both) xx += (x - sx) * (x - sx), yy += (y - sy) * (y - sy), xy += (x - sx) * (y - sy);
    if (n >= 8 && xy < -0.6 * std::sqrt(xx * yy))
      spin->remark(fmt::format("shots curve to the other side by '{}': --column '{}=-{}' turns it", sheet.names[c],
                               spin->header, spin->name));
    return;
  }
}

void check_speeds(Reading& r) {
  Understood *club = r.session.find("club_speed"), *ball = r.session.find("ball_speed");
  for (const auto& [u, what] : {std::pair{ball, "ball"}, {club, "club"}}) {
    if (u) continue;
    std::string empty;                                // the file has such a column, and nothing in it
    for (std::size_t c = 0; c < r.roles.size(); ++c)  // `Club` may hold names
      if (const MonitorQuantity* q = r.dictionary.quantity_of(r.session.sheet.names[c]);
          q && q->name == std::string(what) + "_speed" && r.roles[c].empty())
        empty = r.session.sheet.names[c];
    if (!empty.empty())
      throw InputError(fmt::format("{}: column '{}' is empty: without the speed of the {} there is no blow to compute",
                                   r.session.file.string(), empty, what));
    list_columns(r.session.sheet.names, r.session.sheet.rows.front(), r.dictionary);
    throw InputError(
        fmt::format("{}: no column of {} speed; --column 'header={}_speed_mph' names one: the loop "
                    "computes the blow, which takes the speeds of club and ball",
                    r.session.file.string(), what, what));
  }
  const auto said = [](const Understood& u) {
    const auto unit = split_unit(u.name).unit;
    return fmt::format("{:.4g} {}", u.median / unit->si, unit->suffix);
  };
  const auto numbers = [&](const Understood* u, double si) {
    Numbers out{std::vector<double>(r.session.shots, NAN), si};
    for (std::size_t i = 0; u && i < r.session.shots; ++i) out.value[i] = plain_number(u->cells[i]).value_or(NAN);
    return out;
  };
  const auto quantity = [&](std::string_view stem) {
    const Understood* u = r.session.find(stem);
    return numbers(u, u ? split_unit(u->name).unit->si : 1);
  };
  // Recorded over computed carry, with the ball's speed and the carry in these units.
  const auto carried = [&](double of_speed, double of_carry) -> std::optional<double> {
    if (r.session.carry.cells.empty()) return {};
    Numbers speed = quantity("ball_speed");
    speed.si = of_speed;
    return carry_ratio(speed, quantity("launch_angle"), quantity("spin_rate"), numbers(&r.session.carry, of_carry));
  };
  const double of_ball = split_unit(ball->name).unit->si, of_club = split_unit(club->name).unit->si;
  const double smash = ball->median / club->median, expected = expected_smash(r);
  const auto carry = carried(of_ball, si_of(r.session.carry.name));
  // The unit of a speed in which `off`, a ratio that should be 1, is much nearer to it than `now`; empty: none is.
  const auto better = [](double now, double si, const auto& off) {
    std::string best;
    double least = std::min(std::log(kUnitFits), std::abs(std::log(now)) / 2);
    for (const char* unit : {"mph", "kmh", "mps"}) {
      constexpr double none = std::numeric_limits<double>::infinity();
      const double ratio = si_of(unit) == si ? none : off(si_of(unit)).value_or(none);
      if (ratio > 0 && std::abs(std::log(ratio)) < least) least = std::abs(std::log(ratio)), best = unit;
    }
    return best;
  };
  const auto option = [](const Understood& u, const char* stem, const std::string& unit) {
    return fmt::format("--column '{}={}_{}'", u.header, stem, unit);
  };
  const bool carry_fits = carry && std::abs(std::log(*carry)) < std::log(kCarryDoubtful);
  const bool no_blow = !(smash > 0.8 && smash < 1.62);
  if (no_blow || (expected > 0 && std::abs(std::log(smash / expected)) > std::log(kNoSmash))) {
    std::string reads;
    if (expected > 0) {
      const double now = smash / expected;
      const std::string other_club = better(now, of_club, [&](double si) { return std::optional(now * of_club / si); });
      const std::string other_ball = better(now, of_ball, [&](double si) { return std::optional(now * si / of_ball); });
      if (!other_club.empty() && (carry_fits || !carry || other_ball.empty()))
        reads =
            fmt::format("'{}' reads like {} ({})", club->header, other_club, option(*club, "club_speed", other_club));
      if (!other_ball.empty() && !carry_fits)
        reads += fmt::format("{}'{}' reads like {} ({})", reads.empty() ? "" : ", or ", ball->header, other_ball,
                             option(*ball, "ball_speed", other_ball));
    }
    if (no_blow || !reads.empty())
      throw InputError(fmt::format(
          "{}: ball over club speed is {:.2f} in the median, no blow's ({} over {}): one of the two units is wrong; "
          "{}",
          r.session.file.string(), smash, said(*ball), said(*club),
          !reads.empty() ? reads
                         : fmt::format("--column '{}=ball_speed_UNIT' or '{}=club_speed_UNIT' corrects it",
                                       ball->header, club->header)));
  }
  if (!carry || carry_fits) return;
  const std::string other =
      better(*carry, of_ball, [&](double si) { return carried(si, si_of(r.session.carry.name)); });
  std::string length;
  for (const char* unit : {"yd", "m", "ft"})
    if (const double ratio = *carry * si_of(unit) / si_of(r.session.carry.name);
        unit != r.session.carry.name && std::abs(std::log(ratio)) < std::log(kUnitFits))
      length = unit;
  if (other.empty() && *carry > 1 / kCarryFits && *carry < kCarryFits) return;
  std::string reads;
  if (!other.empty()) {
    reads = fmt::format("; the ball's speed reads like {}, and {} says so", other, option(*ball, "ball_speed", other));
    if (of_ball == of_club) reads += fmt::format(" ({} for the club's)", option(*club, "club_speed", other));
  }
  if (!length.empty()) reads += fmt::format("; the carry reads like {}", length);
  throw InputError(
      fmt::format("{}: '{}' is {:.2f} of what the ball's speed ({}), launch angle and spin make in the median: a "
                  "unit is wrong{}; "
                  "{}--column '{}=' leaves the carry out",
                  r.session.file.string(), r.session.carry.header, *carry, said(*ball), reads,
                  other.empty() ? fmt::format("{} corrects the speed's, ", option(*ball, "ball_speed", "UNIT")) : "",
                  r.session.carry.header));
}

}  // namespace hosel::app
