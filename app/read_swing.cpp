#include "app/read_swing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/read_sheet.hpp"

namespace hosel::app {
namespace {

bool has(const post::Sheet& sheet, std::string_view stem) {
  return std::ranges::any_of(sheet.names,
                             [&](const std::string& n) { return n == stem || split_unit(n).stem == stem; });
}

}  // namespace

MotionInput read_motion(Table table) {
  MotionInput in;
  in.file = table.data_file({"file", "CSV of the grip's motion: time, position, attitude"});
  in.smoothing = table.quantity({"smoothing", "time constant of the smoothing spline; 0 interpolates"}, "ms",
                                Range::non_negative(), 0);
  const double gap =
      table.quantity({"longest_gap", "longest allowed gap between samples"}, "ms", Range::positive(), 0.02);
  const double turn =
      table.quantity({"turn_about_shaft", "turns the recorded grip about the shaft's axis"}, "deg", Range::finite(), 0);
  const double lower_hand = table.quantity(
      {"lower_hand", "down the shaft from the recorded point to where the hands let go: the motion is carried there"},
      "mm", Range::non_negative(), 0);
  const double tolerance =
      table.number({"orthonormal_tolerance", "allowed error of recorded axes"}, {0, 0.1, true}, 1e-3);
  const bool span = table.has_quantity("begin") || table.has_quantity("end");
  in.present = std::filesystem::exists(in.file);
  if (span) {
    in.begin = table.quantity({"begin", "first instant used, with `end`; without both: the record's"}, "s");
    in.end = table.quantity({"end", "last instant used (impact), with `begin`; without both: the record's"}, "s");
    if (!(in.end > in.begin)) table.fail("end", "the motion ends before it begins");
  }
  if (!in.present) return in;

  const post::Sheet sheet = read_sheet(in.file);
  models::GripTrack& track = in.track;
  track.times = column(sheet, "time", Dimension::time, true);
  const auto x = column(sheet, "grip_x", Dimension::length, true), y = column(sheet, "grip_y", Dimension::length, true),
             z = column(sheet, "grip_z", Dimension::length, true);
  const std::size_t n = track.times.size();
  for (std::size_t i = 0; i < n; ++i) track.positions.emplace_back(x[i], y[i], z[i]);
  if (has(sheet, "grip_a")) {
    const auto a = column(sheet, "grip_a", Dimension::angle, true), b = column(sheet, "grip_b", Dimension::angle, true),
               c = column(sheet, "grip_c", Dimension::angle, true);
    for (std::size_t i = 0; i < n; ++i) {
      if (std::abs(std::cos(b[i])) < 0.01)
        throw InputError(fmt::format(
            "{}:{}: the Y-X-Z Euler angles are at gimbal lock (grip_b within 0.6 deg of 90 deg): give rotation columns",
            sheet.file, sheet.lines[i]));
      track.attitudes.push_back(models::from_yxz(a[i], b[i], c[i]));
    }
  } else {
    std::array<std::array<std::vector<double>, 3>, 2> axes;
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        axes[k][c] = column(sheet, fmt::format("grip_e{}_{}", "xy"[k], "xyz"[c]), Dimension::length, false);
    for (std::size_t i = 0; i < n; ++i) {
      const auto axis = [&](std::size_t k) { return Vec3(axes[k][0][i], axes[k][1][i], axes[k][2][i]); };
      try {
        track.attitudes.push_back(models::from_axes(axis(0), axis(1), tolerance));
      } catch (const std::invalid_argument& e) {
        throw InputError(fmt::format("{}:{}: {}", sheet.file, sheet.lines[i], e.what()));
      }
    }
  }
  const Eigen::Quaterniond about(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
  for (Eigen::Quaterniond& q : track.attitudes) q = q * about;
  for (std::size_t i = 0; i < track.positions.size(); ++i)
    track.positions[i] -= track.attitudes[i] * Vec3(0, 0, lower_hand);
  if (const auto wrong = track.faults(gap); !wrong.empty())
    throw InputError(fmt::format("{}: {}", sheet.file, wrong.front()));
  if (!span) {
    in.begin = track.times.front();
    in.end = track.times.back();
  }
  if (in.begin < track.times.front() - 1e-9 || in.end > track.times.back() + 1e-9)
    table.fail(table.has_quantity("begin") ? "begin" : "end",
               fmt::format("the motion covers {:g} to {:g} s only", track.times.front(), track.times.back()));
  // What comes after the end is not the swing's: an impact would reach back through the smoothing.
  if (span) track.cut(in.end);
  return in;
}

fem::JointStiffness read_springs(Table& t, std::string_view whose) {
  const auto three = [&](const char* name, const char* what, std::string_view unit, bool needed) {
    if (!needed && !t.has_quantity(name)) return Vec3(Vec3::Zero());
    const std::string meaning = fmt::format("of the {} {} the grip's axes", whose, what);
    const auto v = t.quantities({name, meaning}, unit, 3, Range::non_negative());
    return Vec3(v[0], v[1], v[2]);
  };
  fem::JointStiffness k;
  k.translation = three("stiffness", "springs along", "N_per_m", true);
  k.rotation = three("rotational_stiffness", "springs about", "N_m_per_rad", true);
  k.translation_damping = three("damping", "dampers along", "N_s_per_m", false);
  k.rotation_damping = three("rotational_damping", "dampers about", "N_m_s_per_rad", false);
  return k;
}

GripInput read_grip_drive(Table root) {
  GripInput in;
  auto t = root.optional_table("grip");
  if (!t) return in;
  using Kind = models::GripDrive::Kind;
  in.kind = t->one_of<Kind>(
      {"drive", "what moves the grip: the recorded motion, the same through springs, or recorded forces"},
      {{"prescribed", Kind::prescribed}, {"hands", Kind::hands}, {"forced", Kind::forced}}, "prescribed");
  if (in.kind == Kind::hands) in.hands = read_springs(*t, "hands'");
  if (in.kind == Kind::forced)
    in.wrench = t->data_file({"wrench",
                              "CSV of the recorded force and moment on the shaft, at the point that `lower_hand` says, "
                              "along the grip's axes turned by `turn_about_shaft`: as swing.csv has them"});
  return in;
}

models::GripDrive make_drive(const GripInput& grip, const MotionInput& span, fem::Motion motion) {
  models::GripDrive drive{.kind = grip.kind, .motion = std::move(motion), .wrench = {}, .hands = grip.hands};
  if (grip.kind != models::GripDrive::Kind::forced) return drive;
  const post::Sheet sheet = read_sheet(grip.wrench);
  const std::vector<double> times = column(sheet, "time", Dimension::time, true);
  std::array<std::vector<double>, 6> parts;
  for (std::size_t c = 0; c < 3; ++c) {
    parts[c] = column(sheet, fmt::format("force_{}", "xyz"[c]), Dimension::force, true);
    parts[3 + c] = column(sheet, fmt::format("moment_{}", "xyz"[c]), Dimension::moment, true);
  }
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1]))
      throw InputError(fmt::format("{}:{}: time goes backwards or stands still", sheet.file, sheet.lines[i]));
  if (times.size() < 2 || times.front() > span.begin + 1e-9 || times.back() < span.end - 1e-9)
    throw InputError(
        fmt::format("{}: the wrench does not cover the motion, {:g} to {:g} s", sheet.file, span.begin, span.end));
  drive.wrench = [times, parts, motion = drive.motion](double t) {
    const auto after = std::ranges::upper_bound(times, t);
    const auto k = std::clamp<std::ptrdiff_t>(after - times.begin(), 1, std::ssize(times) - 1);
    const auto b = static_cast<std::size_t>(k), a = b - 1;
    const double w = (t - times[a]) / (times[b] - times[a]);
    const auto at = [&](std::size_t c) { return (1 - w) * parts[c][a] + w * parts[c][b]; };
    return fem::Wrench{motion(t).rotation * Vec3(at(0), at(1), at(2)), Vec3(at(3), at(4), at(5))};
  };
  return drive;
}

models::HeadJoint read_head_joint(Table& t) {
  using Kind = models::HeadJoint::Kind;
  models::HeadJoint joint{
      .kind = t.one_of<Kind>(
          {"kind", "how the head is joined to the shaft"},
          {{"rigid", Kind::rigid}, {"hinge", Kind::hinge}, {"spring", Kind::spring}, {"none", Kind::none}}, "rigid")};
  if (joint.kind == Kind::hinge) {
    const auto axis = t.numbers({"axis", "of the hinge, grip frame: YG lies across the shaft and the face's normal"}, 3,
                                Range::finite(), std::vector<double>{0, 1, 0});
    joint.axis = Vec3(axis[0], axis[1], axis[2]);
    if (!(joint.axis.norm() > 0)) t.fail("axis", "the axis of a hinge has a direction");
  }
  if (joint.kind == Kind::spring) joint.stiffness = read_springs(t, "joint's");
  return joint;
}

models::SwingOptions read_swing_options(Table root) {
  models::SwingOptions o;
  if (auto t = root.optional_table("solution")) {
    o.elements = static_cast<int>(t->integer({"elements", "finite elements along the shaft"}, 1, 1000, o.elements));
    o.growth = t->number({"growth", "of the elements' lengths towards the tip"}, {0.5, 2}, o.growth);
    o.step = t->quantity({"step", "longest time step"}, "ms",
                         Range{1e-7, 0.1}.because("a swing lasts a second, its bends take milliseconds"), o.step);
    o.rho_inf = t->number({"rho_inf", "spectral radius of generalized-alpha at infinite frequency"}, Range::fraction(),
                          o.rho_inf);
    o.shear = t->flag({"shear", "Timoshenko (true) or shear-rigid (false)"}, o.shear);
    o.modal_damping = t->numbers({"modal_damping", "damping ratios of the first modes, besides the shaft's own"}, 0,
                                 {0, 0.999}, std::vector<double>{});
    using Integrator = models::SwingIntegrator;
    o.integrator = t->one_of<Integrator>(
        {"integrator", "own scheme with an energy ledger, or SUNDIALS IDA"},
        {{"generalized-alpha", Integrator::generalized_alpha}, {"ida", Integrator::ida}}, "generalized-alpha");
    o.kinsol = t->choice({"equilibrium", "how the hanging club is found: Newton, or SUNDIALS KINSOL"},
                         {"newton", "kinsol"}, "newton") == "kinsol";
    o.grip_point = t->quantity(
        {"grip_point", "from the butt to the point that moves as said: the recorded one, or `lower_hand` below it"},
        "mm", Range::non_negative(), o.grip_point);
  }
  if (auto t = root.optional_table("joint")) o.joint = read_head_joint(*t);
  return o;
}

models::SwingEnd SwungClub::swing(const Club& club) const {
  const models::GripMotion grip(motion.track, motion.smoothing);
  const auto ended = [&](const models::SwingOptions& how, std::optional<double> lie) {
    return models::swing_end(
        club, how, [&](double t) { return grip.at(t); }, motion.begin, motion.end, lie);
  };
  models::SwingEnd end = ended(options, {});
  if (start != Start::weightless) return end;
  models::SwingOptions weightless = options;
  weightless.gravity.setZero();
  end.shaft = ended(weightless, end.lie).shaft;
  return end;
}

void SwungClub::begin(const models::SwingEnd& end, Blow& blow, models::ShaftMount& mount) const {
  const Delivery place = blow.delivery;
  blow.club = end.club;
  blow.delivery = end.delivery;
  blow.delivery.impact_toe = place.impact_toe;
  blow.delivery.impact_high = place.impact_high;
  models::turn_place(end.lie, blow.delivery);
  if (start == Start::swing || start == Start::weightless) mount.loaded = end.shaft;
  if (start == Start::hands) mount.load = end.hands;
}

std::optional<SwungClub> read_swung_club(Table root, const std::vector<std::string>& models,
                                         models::ShaftMount& mount) {
  if (!root.has("motion")) return {};
  root.table("shaft");
  SwungClub out{.motion = read_motion(root.table("motion")), .options = read_swing_options(root)};
  const models::HeadJoint& joint = out.options.joint;
  const auto asked = [&](const char* model) { return std::ranges::find(models, model) != models.end(); };
  if (joint.kind == models::HeadJoint::Kind::none) root.fail("joint", "a blow needs a head on the shaft");
  if (asked("shaft-coupled") && joint.gives())
    root.fail("joint", "a condensed shaft does not know how far the swing turns a joint: ask fe-full-club");
  mount.elements = out.options.elements;
  mount.growth = out.options.growth;
  mount.shear = out.options.shear;
  mount.grip_point = out.options.grip_point;
  mount.joint = joint;
  if (!asked("fe-full-club") && !asked("shaft-coupled")) return out;
  Table grip = root.default_table("grip");
  using Start = SwungClub::Start;
  out.start = grip.one_of<Start>({"start",
                                  "the shaft of a swung club at first contact: straight, as the swing leaves it, as "
                                  "one without gravity would, or as "
                                  "the hands' wrench demands"},
                                 {{"straight", Start::straight},
                                  {"swing", Start::swing},
                                  {"weightless", Start::weightless},
                                  {"hands", Start::hands}},
                                 "swing");
  if (joint.gives() && (out.start == Start::weightless || out.start == Start::hands))
    grip.fail("start", "a joint that gives arrives as the swing has turned it: straight or swing");
  if (mount.grip == models::Grip::forced && out.start == Start::straight)
    grip.fail("hold", "a straight shaft asks nothing of the hands: `free` says so, or another `start`");
  return out;
}

}  // namespace hosel::app
