// Blind validation of the loop on a finite-element base: shots made by finite elements with an effect that the base
// does not declare, read with an instrument's noise; is it named? The base is asked at accuracy "look" through its
// surrogate, the shots are made on a finer mesh. All sets have the same blows, so that they share the surrogate's
// answers; effects, sizes and noise are drawn anew.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <random>

#include "hosel/golf/shaft_library.hpp"
#include "hosel/golf/units.hpp"
#include "hosel/loop/shots/run.hpp"
#include "hosel/models/changeable_fe.hpp"
#include "hosel/solvers/random.hpp"

namespace {

using namespace hosel;
using loop::Shot;

/// Standard normal, by Box and Muller.
double gauss(std::mt19937_64& random) {
  const double r = std::sqrt(-2 * std::log(1 - solvers::uniform(random)));
  return r * std::cos(2 * kPi * solvers::uniform(random));
}

/// What is hidden: the name under which the loop should find it, and its size from a number in [-1, -0.5] or [0.5, 1].
struct Truth {
  const char* name;
  bool full_club;  ///< of the base
  void (*hide)(double size, Shot& s);
};

const std::array kTruths = {
    Truth{"ball-cover-stiffness", false, [](double u, Shot& s) { s.change.cover_stiffness = 0.9 * u; }},
    Truth{"friction-limit", false, [](double u, Shot& s) { s.blow.contact.friction *= std::exp(-0.9 * std::abs(u)); }},
    Truth{"restitution-law", false, [](double u, Shot& s) { s.change.losses = 0.25 * u; }},
    Truth{"ball-relaxation", false, [](double u, Shot& s) { s.change.relaxation = 2.2 * std::abs(u); }},
    Truth{"cg-shift", false, [](double u, Shot& s) { s.blow.club.head.cg[2] += 6e-3 * u; }},
    Truth{"head-closure", false,
          [](double u, Shot& s) { s.blow.delivery.head_angular_velocity += Vec3(0, 0, 40 * u); }},
    Truth{"shaft-coupling", false, [](double, Shot& s) { s.change.shaft = 1; }},
    Truth{"shaft-stiffness", true, [](double u, Shot& s) { s.change.shaft_stiffness = 0.9 * u; }},
    Truth{"hosel-place", true, [](double u, Shot& s) { s.blow.club.geometry.hosel[1] += 20e-3 * u; }},
};

/// A driver, and a ball of the library.
Blow club() {
  Blow b;
  b.club.head = {.mass = 0.204,
                 .cg = Vec3(-0.0423, 0.001, 0.0029),
                 .inertia = Vec3(2.843e-4, 4.085e-4, 5.679e-4).asDiagonal(),
                 .face = {0.305, 0.305}};
  b.club.geometry.hosel = Vec3(-0.015, 0.055, 0.01);
  b.contact.friction = 0.4;
  return b;
}

std::vector<Shot> blows(int shots, unsigned long seed) {
  std::mt19937_64 random(seed);
  std::vector<Shot> out;
  for (int i = 0; i < shots; ++i) {
    Shot s;
    s.blow = club();
    s.blow.delivery = {.club_speed = 45 + 2.5 * gauss(random),
                       .attack_angle = radians(1 + 2 * gauss(random)),
                       .club_path = radians(2 * gauss(random)),
                       .dynamic_loft = radians(14 + 3 * gauss(random)),
                       .face_angle = radians(2 * gauss(random)),
                       .impact_toe = 8e-3 * gauss(random),
                       .impact_high = 6e-3 * gauss(random)};
    out.push_back(s);
  }
  return out;
}

/// Answers of a model, kept: the same shot is asked once.
class Kept {
 public:
  explicit Kept(const models::ChangeableFe& model) : model_(model) {}
  Launch operator()(const Shot& s) {
    const Delivery& d = s.blow.delivery;
    const Head& h = s.blow.club.head;
    const Vec3 &w = d.head_angular_velocity, &hosel = s.blow.club.geometry.hosel;
    const models::FeChange& c = s.change;
    std::vector<double> key{d.club_speed,
                            d.attack_angle,
                            d.club_path,
                            d.dynamic_loft,
                            d.face_angle,
                            d.impact_toe,
                            d.impact_high,
                            w[0],
                            w[1],
                            w[2],
                            h.mass,
                            h.cg[0],
                            h.cg[1],
                            h.cg[2],
                            hosel[0],
                            hosel[1],
                            hosel[2],
                            s.blow.contact.friction,
                            c.cover_stiffness,
                            c.cover_thickness,
                            c.losses,
                            c.relaxation,
                            c.shaft,
                            c.shaft_stiffness};
    key.insert(key.end(), h.inertia.data(), h.inertia.data() + 9);
    {
      const std::scoped_lock lock(mutex_);
      if (const auto it = answers_.find(key); it != answers_.end()) return it->second;
    }
    const Launch l = model_.launch(s.blow, s.change);
    const std::scoped_lock lock(mutex_);
    return answers_[key] = l;
  }
  std::size_t size() const { return answers_.size(); }

 private:
  const models::ChangeableFe& model_;
  std::mutex mutex_;
  std::map<std::vector<double>, Launch> answers_;
};

const std::array kNoise = {std::pair{"ball_speed_mps", 0.25}, std::pair{"launch_angle_deg", 0.2},
                           std::pair{"azimuth_deg", 0.25}, std::pair{"backspin_rpm", 60.0},
                           std::pair{"sidespin_rpm", 60.0}};

/// The table that a monitor would write of these launches.
loop::Shots table(const std::vector<Shot>& shots, const std::vector<Launch>& launches, std::mt19937_64& random) {
  post::Sheet sheet{"made", {}, {}, {}};
  for (const char* h : {"shot", "club_speed_mps", "attack_angle_deg", "club_path_deg", "dynamic_loft_deg",
                        "face_angle_deg", "impact_toe_mm", "impact_high_mm"})
    sheet.names.emplace_back(h);
  for (const auto& [h, sigma] : kNoise) sheet.names.emplace_back(h);
  sheet.columns.resize(sheet.names.size());
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const Delivery& d = shots[i].blow.delivery;
    const Launch& l = launches[i];
    std::vector<double> row{
        double(i + 1),           d.club_speed,          degrees(d.attack_angle), degrees(d.club_path),
        degrees(d.dynamic_loft), degrees(d.face_angle), 1e3 * d.impact_toe,      1e3 * d.impact_high};
    const double truth[] = {l.ball_speed(), degrees(l.launch_angle()), degrees(l.azimuth()), rpm(l.backspin()),
                            rpm(l.sidespin())};
    for (std::size_t k = 0; k < kNoise.size(); ++k) row.push_back(truth[k] + kNoise[k].second * gauss(random));
    for (std::size_t k = 0; k < row.size(); ++k)
      sheet.columns[k].push_back(k ? fmt::format("{:.10g}", row[k]) : std::to_string(i + 1));
    sheet.lines.push_back(i + 2);
  }
  return loop::read_shots(sheet);
}

}  // namespace

int main(int argc, char** argv) {
  int shots = 60, sets = 1, nulls = 1;
  unsigned long seed = 1;
  bool full = false;
  CLI::App app("shots made by finite elements with a hidden effect: does the loop name it?");
  app.add_option("--shots", shots, "of a set");
  app.add_option("--sets", sets, "of each effect");
  app.add_option("--nulls", nulls, "sets without an effect");
  app.add_option("--seed", seed);
  app.add_flag("--full-club", full, "the effects of a base that has its shaft");
  CLI11_PARSE(app, argc, argv);

  models::FeImpactOptions look, finer;
  look.resolve(models::Accuracy::look);
  finer.resolve(models::Accuracy::look);
  finer.mesh.rings = 3;
  finer.harmonics = finer.antisymmetric = 3;
  finer.steps_per_contact = 40;
  const Shaft shaft = shaft_library().front().make();
  const models::ChangeableFe coarse(look, {}, shaft, full), fine(finer, {}, shaft, full);
  Kept quick(coarse), slow(fine);

  loop::ShotCase c;
  c.base = full ? "fe-full-club" : "fe-free-body";
  c.head_mass_declared = c.inertia_declared = c.deformable = c.shaft_declared = true;
  c.full_club = full;
  c.blow = club();
  for (const auto& [header, sigma] : kNoise) c.noise[header] = sigma;
  const loop::SlowBase base{
      .coarse = [&](const Shot& s) { return quick(s); }, .fine = [&](const Shot& s) { return slow(s); }, .checked = 8};
  c.slow = &base;

  const std::vector<Shot> plain = blows(shots, seed);
  int total = 0, alone = 0, tied = 0, wrong = 0, false_alarms = 0;
  const auto examine = [&](const Truth* truth, unsigned long number) {
    std::mt19937_64 random(1000 * seed + number);
    const double size = (random() % 2 ? 1 : -1) * (0.5 + 0.5 * solvers::uniform(random));
    std::vector<Shot> hidden = plain;
    if (truth)
      for (Shot& s : hidden) truth->hide(size, s);
    std::vector<Launch> launches(hidden.size());
    tbb::parallel_for(std::size_t(0), hidden.size(), [&](std::size_t i) { launches[i] = slow(hidden[i]); });
    c.shots = table(plain, launches, random);
    const loop::LoopResult r = loop::run(c);
    std::vector<std::string> ties;
    for (const auto& t : r.ties) ties.push_back(fmt::format("{}", fmt::join(t, " or ")));
    const std::string name = truth ? truth->name : "nothing";
    const bool in = std::ranges::count(r.adopted, name) > 0;
    const bool in_tie = std::ranges::any_of(r.ties, [&](const auto& t) { return std::ranges::count(t, name) > 0; });
    if (!truth) {
      false_alarms += !r.adopted.empty() || !r.ties.empty();
    } else {
      ++total;
      alone += in && r.adopted.size() == 1 && r.ties.empty();
      tied += in_tie;
      wrong += !in && !in_tie && (!r.adopted.empty() || !r.ties.empty());
    }
    fmt::print("{:<22} {:+.2f}  {:<18} adopted [{}] tied [{}]", name, size, std::string(loop::name(r.verdict)),
               fmt::join(r.adopted, ", "), fmt::join(ties, "; "));
    if (r.corrected)
      for (std::size_t k = 0; k < r.channels.size(); ++k)
        fmt::print(" {} {:.3g}->{:.3g}", r.channels[k].name, rms(r.corrected->rows, &loop::Corrected::Row::before, k),
                   rms(r.corrected->rows, &loop::Corrected::Row::after, k));
    fmt::print("  ({} + {} answers so far)\n", quick.size(), slow.size());
    std::fflush(stdout);
  };
  unsigned long number = 0;
  for (int k = 0; k < nulls; ++k) examine(nullptr, ++number);
  for (int k = 0; k < sets; ++k)
    for (const Truth& t : kTruths)
      if (t.full_club == full) examine(&t, ++number);
  fmt::print("{} sets: named alone {}, in a tie {}, a wrong name {}; {} nulls: adoptions {}\n", total, alone, tied,
             wrong, nulls, false_alarms);
  return wrong + false_alarms > 0;
}
