#include "models/flight/flight_laws.hpp"

#include <algorithm>

namespace hosel::models {
namespace {

/// [@ferguson-2022]. The moment's reference length is taken as the diameter: in standard air its spin then dies out as
/// in
/// [@smits-smith-1994], within 2 %.
FlightLaw ferguson_2022() {
  return {.name = "ferguson-2022",
          .source =
              "Ferguson, McNally and McPhee (2022), fitted to tracked shots of all clubs; its range in Re is not "
              "known to us, and beyond S = 0.52 its lift falls",
          .reynolds = {4e4, 2.5e5},
          .spin = {0, 0.52},
          .form = PolynomialLaw{.drag = {0.1304, 0.9287, -0.8259}, .lift = {0.0504, 1.2031, -1.1490}},
          .decay = {.moment = 0.01}};
}

/// [@smits-smith-1994]
FlightLaw smits_smith_1994() {
  return {
      .name = "smits-smith-1994",
      .source =
          "Smits and Smith (1994), Science and Golf II, as quoted in US patent 11230375; wind tunnel, "
          "for driver shots",
      .reynolds = {7e4, 2.1e5},
      .spin = {0.08, 0.2},
      .form =
          SineLaw{.drag = 0.24, .drag_spin = 0.18, .drag_wave = 0.06, .start = 9e4, .span = 2e5, .lift = {0.54, 0.4}},
      .decay = {.travel = 2e-5}};
}

/// [@lyu-2018]
FlightLaw lyu_2018() {
  return {
      .name = "lyu-2018",
      .source = "Lyu, Kensrud, Smith and Tosaya (2018), Proceedings 2:238, figures 3b and 4b: one ball in still air",
      .reynolds = {7.5e4, 2e5},
      .spin = {0.04, 0.32},
      .form = PolynomialLaw{.drag = {0.56}, .lift = {0, 1.99, -3.25}, .drag_reynolds = {-5.40e-6, 1.91e-11}},
      .decay = {.rate = 0.04}};  // what its trajectories take, from a radar maker's newsletter
}

/// [@bearman-harvey-1976]
FlightLaw bearman_harvey_1976() {
  return {.name = "bearman-harvey-1976",
          .source =
              "Bearman and Harvey (1976), Aeronaut. Q. 27:112, figures 7 and 8: hexagonal dimples, 2000 to 6000 "
              "rpm, as read off for NTNU's course TKT4140; 41.1 mm, 1.5e-5 m^2/s",
          .reynolds = {3.75e4, 2.414e5},
          .spin = {0.0489, 0.9425},
          .form = TableLaw{{
              {3.750e4,
               {0.3142, 0.4712, 0.6283, 0.7854, 0.9425},
               {0.3624, 0.4203, 0.4288, 0.4848, 0.5180},
               {0.1040, 0.3624, 0.4005, 0.4130, 0.4644}},
              {5.920e4,
               {0.1993, 0.2989, 0.3985, 0.4981, 0.5978},
               {0.2885, 0.3658, 0.4003, 0.4314, 0.4406},
               {0.1846, 0.3362, 0.3640, 0.3894, 0.4227}},
              {8.190e4,
               {0.1439, 0.2159, 0.2879, 0.3599, 0.4318},
               {0.2765, 0.3169, 0.3490, 0.3728, 0.3882},
               {0.2460, 0.3049, 0.3347, 0.3496, 0.3724}},
              {1.052e5,
               {0.1121, 0.1681, 0.2242, 0.2802, 0.3362},
               {0.2529, 0.2822, 0.3084, 0.3316, 0.3517},
               {0.1984, 0.2475, 0.2862, 0.3119, 0.3393}},
              {1.285e5,
               {0.0918, 0.1377, 0.1835, 0.2294, 0.2753},
               {0.2472, 0.2655, 0.2852, 0.3062, 0.3285},
               {0.1762, 0.2073, 0.2384, 0.2695, 0.3005}},
              {1.512e5,
               {0.0780, 0.1170, 0.1559, 0.1949, 0.2339},
               {0.2481, 0.2578, 0.2710, 0.2876, 0.3076},
               {0.1538, 0.1856, 0.2149, 0.2418, 0.2662}},
              {1.729e5,
               {0.0682, 0.1023, 0.1364, 0.1705, 0.2046},
               {0.2467, 0.2560, 0.2659, 0.2765, 0.2877},
               {0.1418, 0.1702, 0.1977, 0.2246, 0.2507}},
              {1.970e5,
               {0.0599, 0.0898, 0.1197, 0.1497, 0.1796},
               {0.2470, 0.2550, 0.2630, 0.2710, 0.2790},
               {0.1360, 0.1584, 0.1807, 0.2031, 0.2254}},
              {2.197e5,
               {0.0537, 0.0805, 0.1073, 0.1342, 0.1610},
               {0.2470, 0.2538, 0.2605, 0.2673, 0.2740},
               {0.1280, 0.1485, 0.1690, 0.1895, 0.2100}},
              {2.414e5,
               {0.0489, 0.0733, 0.0977, 0.1221, 0.1466},
               {0.2470, 0.2538, 0.2605, 0.2673, 0.2740},
               {0.1276, 0.1464, 0.1582, 0.1791, 0.2000}},
          }},
          .decay = {.travel = 2e-5}};  // [@penner-2001] flies with this table
}

/// [@nathan-golf], the sheet before 2023. Its lift beyond S = 0.3 is printed as 0.305.
FlightLaw nathan_earlier() {
  return {.name = "nathan-earlier",
          .source =
              "A. M. Nathan's trajectory calculator for golf, before 2023: coefficients after Lyu et al. (2018), whose "
              "range this is",
          .reynolds = {7.5e4, 2e5},
          .spin = {0.04, 0.32},
          .form = RampLaw{.slow = 0.5,
                          .fast = 0.2,
                          .from = 5e4,
                          .to = 1e5,
                          .drag_spin = 0.18,
                          .lift = QuadraticLift{1.99, -3.25, 0.3}},
          .decay = {.travel = 2e-5}};
}

/// [@nathan-golf], the sheet of 2023
FlightLaw nathan_2023() {
  return {.name = "nathan-2023",
          .source =
              "A. M. Nathan's trajectory calculator for golf, beta of 2023: fitted to seven clubs, driver to 5-iron; "
              "its range is not stated, this is what such flights go through",
          .reynolds = {7e4, 2.4e5},
          .spin = {0.07, 0.45},
          .form = RampLaw{.slow = 1.9451114,
                          .fast = 0.13248,
                          .from = 5e4,
                          .to = 1e5,
                          .drag_spin = 0.2087217,
                          .lift = PowerLift{0.2294096, 0.4}},
          .decay = {.travel = 2e-5}};
}

/// [@libgolf]. Its further lifts below Re = 70,000 and beyond S = 0.35 are left out.
FlightLaw libgolf() {
  return {
      .name = "libgolf",
      .source = "libgolf, G. DiFiore's open-source library: set by hand to a tour's mean shots; no measured range",
      .reynolds = {7e4, 2.4e5},
      .spin = {0.05, 0.35},
      .form =
          RampLaw{
              .slow = 0.5, .fast = 0.2, .from = 5e4, .to = 1e5, .drag_spin = 0.18, .lift = SaturatingLift{0.268, 16}},
      .decay = {.travel = 2e-5}};
}

/// The lower half of the covariance of radar-2022's coefficients, in the order of `inferred_coefficient`.
constexpr std::array kRadarCovariance = {
    7.27099e-06,  -9.586e-07,   4.6916e-05,   -1.316e-05,   -5.15681e-05, 0.000187854,  -1.25077e-05, 4.33395e-05,
    -2.73402e-05, 6.245e-05,    -8.26837e-07, -7.44638e-05, 0.000123922,  -7.04203e-05, 0.000203652,  -1.79253e-05,
    -0.000129117, 0.000321493,  -9.0315e-05,  0.000301853,  0.000648991,  6.14759e-06,  -2.01906e-06, -8.17372e-06,
    -1.27018e-05, 4.23855e-06,  -9.69853e-06, 6.52809e-06,  4.10249e-07,  2.74491e-05,  -2.13846e-05, 2.57296e-05,
    -4.75572e-05, -7.11182e-05, 1.35183e-07,  4.4775e-05,   -1.16914e-05, -2.15074e-05, 6.42496e-05,  2.51093e-06,
    3.8351e-05,   0.000118802,  -1.50965e-05, -4.80417e-05, 0.000182793,  -1.15036e-05, 2.7158e-05,   -3.91393e-06,
    4.68236e-05,  -4.9567e-05,  -4.45493e-05, -1.1273e-05,  3.71237e-05,  -1.82963e-05, 5.43949e-05,  -7.6159e-06,
    -4.81793e-05, 4.69054e-05,  -3.43733e-05, 8.88272e-05,  0.000144835,  -1.07355e-05, -6.99027e-05, 0.000114936,
    -4.55768e-05, 0.000190645,  -1.56558e-05, -7.96476e-05, 0.000110208,  -4.67418e-05, 0.000143712,  0.000278542,
    -1.96611e-05, -0.000125038, 0.000284496,  -7.90196e-05, 0.000289082,  0.000580849,  2.10317e-09,  -2.38748e-09,
    -7.20674e-09, -8.48768e-09, 5.67718e-09,  -6.23721e-09, 2.7632e-09,   -7.41375e-09, -5.1784e-09,  -1.14835e-08,
    9.11007e-09,  8.14449e-09,  6.88672e-12,
};

/// [@radar-flights], by `hosel run radar-law`.
FlightLaw radar_2022() {
  FlightLaw law = {.name = "radar-2022",
                   .source =
                       "inferred by the case radar-law from tour drives that a radar followed in January 2022 "
                       "(Waialae, Kapalua; half of "
                       "the players), jointly with each hole's wind and each shot's axis and ball; one model of ball "
                       "unknown; the level of "
                       "drag rests on a mean wind of none; outside its window libgolf",
                   .reynolds = {8e4, 2.1e5},
                   .spin = {0.05, 0.2},
                   .form = SurfaceLaw{.drag = {0.230526, 0.0595972, -0.03433, 0.0148206, -0.0631741, -0.120096},
                                      .lift = {0.183173, 0.0816399, -0.125602, -0.00382347, -0.173281, -0.173082},
                                      .reynolds = {6e4, 8e4, 2.1e5, 2.7e5},
                                      .spin = {0.03, 0.05, 0.2, 0.28},
                                      .outside = std::get<RampLaw>(libgolf().form)},
                   .decay = {.travel = 1.8687e-05}};
  law.covariance.resize(kInferredCoefficients * kInferredCoefficients);
  for (std::size_t i = 0, k = 0; i < kInferredCoefficients; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      law.covariance[i * kInferredCoefficients + j] = law.covariance[j * kInferredCoefficients + i] =
          kRadarCovariance.at(k++);
  return law;
}

constexpr std::array kLaws = {
    FlightLawEntry{"ferguson-2022", "polynomials in the spin ratio, from tracked shots of all clubs", ferguson_2022},
    FlightLawEntry{"smits-smith-1994", "driver shots in a wind tunnel", smits_smith_1994},
    FlightLawEntry{"lyu-2018", "one modern ball in still air: drag over Re, lift over the spin ratio", lyu_2018},
    FlightLawEntry{"bearman-harvey-1976", "table of a ball with hexagonal dimples, wind tunnel", bearman_harvey_1976},
    FlightLawEntry{"nathan-earlier", "the lift of lyu-2018 with a plainer drag, as a spreadsheet flew it",
                   nathan_earlier},
    FlightLawEntry{"nathan-2023", "the same spreadsheet fitted to seven clubs, driver to 5-iron", nathan_2023},
    FlightLawEntry{"libgolf", "an open-source library, set to a tour's mean shots", libgolf},
    FlightLawEntry{"radar-2022",
                   "provisional (two estimators disagree on its slopes): inferred from drives that a radar followed, "
                   "with covariance",
                   radar_2022},
};

/// The spin ratio at one end of the measured rows, at any Reynolds number.
double end_of_row(const TableLaw& table, double reynolds, double (*end)(const std::vector<double>&)) {
  const auto above = std::ranges::upper_bound(table.rows, reynolds, {}, &TableLaw::Row::reynolds);
  if (above == table.rows.begin()) return end(above->spin);
  if (above == table.rows.end()) return end(table.rows.back().spin);
  const auto below = above - 1;
  const double share = (reynolds - below->reynolds) / (above->reynolds - below->reynolds);
  return std::lerp(end(below->spin), end(above->spin), share);
}

}  // namespace

bool TableLaw::holds(double reynolds, double spin) const {
  return rows.front().reynolds <= reynolds && reynolds <= rows.back().reynolds &&
         end_of_row(*this, reynolds, [](const std::vector<double>& x) { return x.front(); }) <= spin &&
         spin <= end_of_row(*this, reynolds, [](const std::vector<double>& x) { return x.back(); });
}

std::vector<std::string> TableLaw::faults() const {
  const auto rise = [](const auto& x, auto&& of) {
    return std::ranges::adjacent_find(x, std::ranges::greater_equal{}, of) == x.end();
  };
  std::vector<std::string> out;
  if (rows.size() < 2) out.push_back("a table of coefficients has at least two Reynolds numbers");
  if (!rise(rows, &Row::reynolds)) out.push_back("the Reynolds numbers of a table of coefficients rise");
  for (const Row& r : rows) {
    if (r.spin.size() < 2) out.push_back("each Reynolds number of a table has at least two spin ratios");
    if (!rise(r.spin, std::identity{})) out.push_back("the spin ratios of one Reynolds number rise");
    if (r.drag.size() != r.spin.size() || r.lift.size() != r.spin.size())
      out.push_back("each spin ratio of a table has its drag and lift");
    const auto within = [](const std::vector<double>& x, double least) {
      return std::ranges::all_of(x, [&](double c) { return c >= least && c <= 5; });
    };
    if (!within(r.drag, 0) || !within(r.lift, -5))
      out.push_back("drag coefficients lie between 0 and 5, lift coefficients between -5 and 5: no ball has others");
  }
  return out;
}

bool FlightLaw::holds(double re, double s) const {
  if (const auto* table = std::get_if<TableLaw>(&form)) return table->holds(re, s);
  return reynolds.low <= re && re <= reynolds.high && spin.low <= s && s <= spin.high;
}

std::string_view inferred_coefficient_name(int k) {
  static constexpr std::array<std::string_view, kInferredCoefficients> names = {
      "drag",   "drag_s",  "drag_ss", "drag_x",  "drag_xx", "drag_sx",          "lift",
      "lift_s", "lift_ss", "lift_x",  "lift_xx", "lift_sx", "spin_decay_travel"};
  return names.at(std::size_t(k));
}

double& inferred_coefficient(FlightLaw& law, int k) {
  auto& surface = std::get<SurfaceLaw>(law.form);
  constexpr int terms = int(std::tuple_size_v<SurfaceLaw::Terms>);
  if (k < terms) return surface.drag.at(std::size_t(k));
  if (k < 2 * terms) return surface.lift.at(std::size_t(k - terms));
  return law.decay.travel;
}

std::span<const FlightLawEntry> flight_laws() { return kLaws; }

const FlightLawEntry* find_flight_law(std::string_view name) {
  const auto it = std::ranges::find(kLaws, name, &FlightLawEntry::name);
  return it == kLaws.end() ? nullptr : &*it;
}

}  // namespace hosel::models
