// Blind validation of the loop on a finite-element base: shots made by finite elements with an effect that the base
// does not declare, read with an instrument's noise; is it named? Base and shots are computed alike, on one coarse
// mesh. All sets have the same blows and begin with the same surrogate; effects, sizes and noise are drawn anew. Sets
// that differ in their noise alone go on with what the loop asked for the one before.
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <random>
#include <sstream>

#include "golf/parallel.hpp"
#include "golf/shaft_library.hpp"
#include "golf/units.hpp"
#include "loop/shots/features.hpp"
#include "loop/shots/slow.hpp"
#include "models/fe/changeable_fe.hpp"
#include "solvers/random.hpp"

namespace {

using namespace hosel;
using loop::Shot;

/// Standard normal, by Box and Muller.
double gauss(std::mt19937_64& random) {
  const double r = std::sqrt(-2 * std::log(1 - solvers::uniform(random)));
  return r * std::cos(2 * kPi * solvers::uniform(random));
}

/// What is hidden: the name under which the loop should find it, and the ends of its size.
struct Truth {
  const char* name;
  bool full_club;  ///< of the base
  double low, high;
  void (*hide)(double size, Shot& s);
};

const std::array kTruths = {
    Truth{"ball-cover-stiffness", false, -1.4, 1.4, [](double x, Shot& s) { s.change.cover_stiffness = x; }},
    Truth{"friction-limit", false, -1.4, 0, [](double x, Shot& s) { s.blow.contact.friction *= std::exp(x); }},
    Truth{"restitution-law", false, -1, 0.7, [](double x, Shot& s) { s.change.losses = x; }},
    Truth{"ball-relaxation", false, -1.4, 2.3, [](double x, Shot& s) { s.change.relaxation = x; }},
    Truth{"cg-shift", false, -18e-3, 18e-3, [](double x, Shot& s) { s.blow.club.head.cg[2] += x; }},
    Truth{"head-closure", false, -80, 80,
          [](double x, Shot& s) { s.blow.delivery.head_angular_velocity += Vec3(0, 0, x); }},
    Truth{"face-compliance", false, 0, 250e-9, [](double x, Shot& s) { s.change.face_compliance = x; }},
    Truth{"shaft-coupling", false, 0, 1, [](double x, Shot& s) { s.change.shaft = x; }},
    // Well inside what the loop takes for plausible (1.2): at its edge nothing is adopted.
    Truth{"shaft-stiffness", true, -0.85, 0.85, [](double x, Shot& s) { s.change.shaft_stiffness = x; }},
    Truth{"hosel-place", true, -35e-3, 35e-3, [](double x, Shot& s) { s.blow.club.geometry.hosel[1] += x; }},
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

/// Answers of a model, kept in a file too: the same shot is asked once, by a run that goes on after another also.
class Kept {
 public:
  Kept(const models::ChangeableFe& model, const std::filesystem::path& file) : model_(model) {
    const auto changed =
        std::ranges::count_if(loop::features(), [](const loop::Feature& f) { return f.set != nullptr; });
    const auto width = std::size_t(kInputs + changed + kNumbers);
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      std::vector<double> row;
      std::istringstream words(line);
      for (double x = 0; words >> x;) row.push_back(x);
      if (in.eof() || row.size() != width) continue;  // of a killed run
      Launch l;
      auto at = row.end() - kNumbers;
      for (Vec3* v : {&l.velocity, &l.spin, &l.head_velocity, &l.head_spin})
        for (int k = 0; k < 3; ++k) (*v)[k] = *at++;
      answers_[{row.begin(), row.end() - kNumbers}] = l;
    }
    out_.open(file, std::ios::app);
  }
  Launch operator()(const Shot& s) {
    std::vector<double> key;
    for (int k = 0; k < kInputs; ++k) key.push_back(get(s.blow, Input(k)));
    for (const loop::Feature& f : loop::features())
      if (f.set) key.push_back(f.get(s));
    {
      const std::scoped_lock lock(mutex_);
      if (const auto it = answers_.find(key); it != answers_.end()) return it->second;
    }
    const Launch l = model_.launch(s.blow, s.change);
    const std::scoped_lock lock(mutex_);
    answers_[key] = l;
    for (const Vec3& v : {l.velocity, l.spin, l.head_velocity, l.head_spin})
      key.insert(key.end(), v.data(), v.data() + 3);
    fmt::print(out_, "{}\n", fmt::join(key, " "));  // shortest digits that read back the same
    out_.flush();
    return l;
  }
  std::size_t size() const { return answers_.size(); }

 private:
  static constexpr int kNumbers = 12;  // of a launch
  const models::ChangeableFe& model_;
  std::mutex mutex_;
  std::map<std::vector<double>, Launch> answers_;
  std::ofstream out_;
};

const std::array kNoise = {std::pair{"ball_speed_mps", 0.25}, std::pair{"launch_angle_deg", 0.2},
                           std::pair{"azimuth_deg", 0.25}, std::pair{"backspin_rpm", 60.0},
                           std::pair{"sidespin_rpm", 60.0}};

using Reading = std::array<double, kNoise.size()>;
Reading reading(const Launch& l) {
  return {l.ball_speed(), degrees(l.launch_angle()), degrees(l.azimuth()), rpm(l.backspin()), rpm(l.sidespin())};
}

/// Whitened norm of what is hidden over two thirds of so many shots, seen on some of them; and of what of it is no
/// constant of a channel.
struct Signal {
  double all = 0, beyond = 0;

  Signal(const std::vector<Launch>& hidden, const std::vector<Launch>& plain, std::size_t shots) {
    for (std::size_t k = 0; k < kNoise.size(); ++k) {
      double sum = 0, squares = 0;
      for (std::size_t i = 0; i < hidden.size(); ++i) {
        const double x = (reading(hidden[i])[k] - reading(plain[i])[k]) / kNoise[k].second;
        sum += x;
        squares += x * x;
      }
      all += squares;
      beyond += squares - sum * sum / double(hidden.size());
    }
    const double share = 2.0 / 3.0 * double(shots) / double(hidden.size());
    all = std::sqrt(share * all);
    beyond = std::sqrt(share * beyond);
  }
};

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
    std::vector<double> row{
        double(i + 1),           d.club_speed,          degrees(d.attack_angle), degrees(d.club_path),
        degrees(d.dynamic_loft), degrees(d.face_angle), 1e3 * d.impact_toe,      1e3 * d.impact_high};
    const Reading truth = reading(launches[i]);
    for (std::size_t k = 0; k < kNoise.size(); ++k) row.push_back(truth[k] + kNoise[k].second * gauss(random));
    for (std::size_t k = 0; k < row.size(); ++k)
      sheet.columns[k].push_back(k ? fmt::format("{:.10g}", row[k]) : std::to_string(i + 1));
    sheet.lines.push_back(i + 2);
  }
  return loop::read_shots(sheet);
}

/// What the loop said of one set.
struct Examined {
  std::string truth;
  bool alone = false, tied = false, wrong = false, anything = false;
};

Examined judged(const loop::LoopResult& r, const Truth* truth) {
  Examined e{truth ? truth->name : "nothing"};
  const bool in = std::ranges::count(r.adopted, e.truth) > 0;
  e.anything = !r.adopted.empty() || !r.ties.empty();
  e.alone = in && r.adopted.size() == 1 && r.ties.empty();
  e.tied = std::ranges::any_of(r.ties, [&](const auto& t) { return std::ranges::count(t, e.truth) > 0; });
  e.wrong = truth && !in && !e.tied && e.anything;
  std::vector<std::string> ties;
  for (const auto& t : r.ties) ties.push_back(fmt::format("{}", fmt::join(t, " or ")));
  fmt::print("{:<18} adopted [{}] tied [{}]", std::string(loop::name(r.verdict)), fmt::join(r.adopted, ", "),
             fmt::join(ties, "; "));
  return e;
}

}  // namespace

int main(int argc, char** argv) {
  int shots = 60, sizes = 1, draws = 1, nulls = 1;
  unsigned long seed = 1;
  bool full = false, verbose = false;
  std::vector<std::string> only;
  std::filesystem::path answers;
  CLI::App app("shots made by finite elements with a hidden effect: does the loop name it?");
  app.add_option("--shots", shots, "of a set");
  app.add_option("--sizes", sizes, "of each effect, by the signal");
  app.add_option("--draws", draws, "of the noise, for each size");
  app.add_option("--nulls", nulls, "sets without an effect");
  app.add_option("--effect", only, "hidden ones; all of the base unless named");
  app.add_option("--seed", seed);
  app.add_option("--answers", answers, "file that keeps what the model said: a killed run asks nothing twice")
      ->required();
  app.add_flag("--full-club", full, "the effects of a base that has its shaft");
  app.add_flag("--verbose", verbose, "what the loop notes");
  CLI11_PARSE(app, argc, argv);

  // A third of the cost of `look`, 2 % of spin and 0.2 % of speed away from it: examined is the loop, not the mesh.
  models::FeImpactOptions coarse;
  coarse.resolve(models::Accuracy::look);
  coarse.mesh.sector = coarse.mesh.rings = 1;
  coarse.steps_per_contact = 20;
  coarse.newton_relative = 1e-4;
  coarse.after = 0;
  const models::ChangeableFe model(coarse, {}, shaft_library().front().make(), full);
  Kept answer(model, answers);

  loop::ShotCase c;
  c.base = full ? "fe-full-club" : "fe-free-body";
  c.head_mass_declared = c.inertia_declared = c.deformable = c.shaft_declared = true;
  c.full_club = full;
  c.blow = club();
  for (const auto& [header, sigma] : kNoise) c.noise[header] = sigma;
  const loop::SlowBase base{.coarse = [&](const Shot& s) { return answer(s); }, .fine = {}, .checked = 0};
  c.slow = &base;

  const std::vector<Shot> plain = blows(shots, seed);
  std::vector<Examined> all;
  const auto made = [&](std::vector<Shot> of, const Truth* truth, double size) {
    if (truth)
      for (Shot& s : of) truth->hide(size, s);
    std::vector<Launch> out(of.size());
    for_all(std::size_t(0), of.size(), [&](std::size_t i) { out[i] = answer(of[i]); });
    return out;
  };
  // A size by its signal, which is drawn between 8 and 40 and met on some shots: as near as the range allows.
  const auto drawn = [&](const Truth& t, std::mt19937_64& random) {
    std::vector<Shot> some;
    for (std::size_t i = 0; i < plain.size(); i += std::max<std::size_t>(1, plain.size() / 12))
      some.push_back(plain[i]);
    const std::vector<Launch> bare = made(some, nullptr, 0);
    const double side = random() % 2 ? t.high : t.low, end = side != 0 ? side : t.low + t.high;
    const double wanted = 8 * std::pow(5, solvers::uniform(random));
    double size = end;
    for (int k = 0; k < 3; ++k)
      size = end * std::min(1.0, size / end * wanted / Signal(made(some, &t, size), bare, plain.size()).all);
    // Of some shots none may slide: what all of them together hardly show is drawn larger.
    const std::vector<Launch> all_bare = made(plain, nullptr, 0);
    for (int k = 0; k < 4 && Signal(made(plain, &t, size), all_bare, plain.size()).all < 6; ++k)
      size += (end - size) / 2;
    return size;
  };
  std::mt19937_64 first(1000 * seed);
  c.shots = table(plain, made(plain, nullptr, 0), first);
  const loop::Learnt common = loop::learn(c);
  const auto examine = [&](const Truth* truth, unsigned long number, int times) {
    std::mt19937_64 random(1000 * seed + number);
    const double size = truth ? drawn(*truth, random) : 0;
    const std::vector<Launch> launches = made(plain, truth, size);
    const Signal signal(launches, made(plain, nullptr, 0), plain.size());
    loop::Learnt learnt = common;
    for (int k = 0; k < times; ++k) {
      c.shots = table(plain, launches, random);
      const loop::LoopResult r = loop::run_slow(c, learnt);
      fmt::print("{:<22} {:+9.3g} s {:4.1f} ({:4.1f})  ", truth ? truth->name : "nothing", size, signal.all,
                 signal.beyond);
      all.push_back(judged(r, truth));
      fmt::print("  ({} answers, {:.0f} CPU s)\n", answer.size(), double(std::clock()) / CLOCKS_PER_SEC);
      for (const std::string& note : r.notes)
        if (verbose) fmt::print("    {}\n", note);
      std::fflush(stdout);
    }
  };
  unsigned long number = 0;
  examine(nullptr, number, nulls);
  for (int k = 0; k < sizes; ++k)
    for (const Truth& t : kTruths) {
      ++number;
      if (t.full_club == full && (only.empty() || std::ranges::count(only, t.name))) examine(&t, number, draws);
    }
  const auto count = [&](bool Examined::*what) { return std::ranges::count(all, true, what); };
  const auto without = std::ranges::count(all, "nothing", &Examined::truth);
  const auto false_alarms =
      std::ranges::count_if(all, [](const Examined& e) { return e.truth == "nothing" && e.anything; });
  fmt::print("{} sets: named alone {}, in a tie {}, a wrong name {}; {} nulls: adoptions {}\n",
             std::ptrdiff_t(all.size()) - without, count(&Examined::alone), count(&Examined::tied),
             count(&Examined::wrong), without, false_alarms);
  return count(&Examined::wrong) + false_alarms > 0;
}
