#include "app/kinds/loop_offer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "loop/shots/inputs.hpp"

namespace hosel::app {
namespace {

using loop::Shot;

bool same_law(const ContactLaw& a, const ContactLaw& b) {
  return a.restitution == b.restitution && a.restitution_slope == b.restitution_slope &&
         a.restitution_falloff == b.restitution_falloff && a.tangential_restitution == b.tangential_restitution &&
         a.friction == b.friction && a.normal_force_offset == b.normal_force_offset;
}

bool same_body(const Head& a, const Head& b) {
  return a.mass == b.mass && a.cg == b.cg && a.inertia == b.inertia && a.face.bulge == b.face.bulge &&
         a.face.roll == b.face.roll;
}

/// What an effect does to a shot, as far as an entry can say it.
struct Touched {
  bool contact = false, head = false, ball = false, layers = false, face = false;
  bool any() const { return contact || head || ball || layers || face; }
};

Touched touched(const Shot& before, const Shot& after) {
  const models::FeChange &a = before.change, &b = after.change;
  return {.contact = !same_law(before.blow.contact, after.blow.contact),
          .head = !same_body(before.blow.club.head, after.blow.club.head),
          .ball = before.blow.ball.inertia_factor != after.blow.ball.inertia_factor,
          .layers = a.cover_stiffness != b.cover_stiffness || a.cover_thickness != b.cover_thickness ||
                    a.losses != b.losses || a.relaxation != b.relaxation,
          .face = a.face_compliance != b.face_compliance};
}

/// The adopted effects, found on shots.
struct Finding {
  Touched of;                       ///< by any of them, alike in all shots
  std::vector<std::string> other;   ///< effects that do something else as well, or that are only tied
  std::vector<Eigen::Index> entry;  ///< the parameters of the effects that it holds
  Shot first;                       ///< with these in it
};

/// Of a fit, the effects among `adopted`. `layers`: the base has a ball of layers, so that what changes the ball can be
/// said.
Finding with_effects(const loop::Fit& fit, const std::vector<std::string>& adopted, const std::vector<Shot>& shots,
                     bool layers) {
  Finding f;
  std::vector<Shot> changed = shots;
  Eigen::Index at = 0;
  for (const loop::Parametrisation* form : fit.model.forms) {
    const auto n = form->parameters.size();
    const std::span<const double> p(fit.p.data() + at, n);
    const Eigen::Index first = std::exchange(at, at + Eigen::Index(n));
    if (!std::ranges::count(adopted, form->effect)) {
      f.other.push_back(form->effect);
      continue;
    }
    bool other = form->after || form->reading || form->flight || !form->before;
    if (form->before) {
      std::vector<Shot> next = changed;
      for (Shot& s : next) form->before(p, s);
      Touched t = touched(changed.front(), next.front());
      other = other || !t.any() || (!layers && (t.ball || t.layers || t.face));
      if (!layers) t.ball = t.layers = t.face = false;
      // From shot to shot alike: else no entry can say it.
      bool alike = true;
      for (std::size_t i = 0; i < next.size(); ++i) {
        const Head &h = next[i].blow.club.head, &g = changed[i].blow.club.head, &h0 = next[0].blow.club.head,
                   &g0 = changed[0].blow.club.head;
        alike = alike && (!t.contact || same_law(next[i].blow.contact, next[0].blow.contact)) &&
                (!t.head || (std::abs((h.mass - g.mass) - (h0.mass - g0.mass)) <= 1e-9 * g.mass &&
                             ((h.cg - g.cg) - (h0.cg - g0.cg)).norm() <= 1e-12)) &&
                next[i].change == next[0].change;
      }
      if (alike && t.any()) {
        f.of = {f.of.contact || t.contact, f.of.head || t.head, f.of.ball || t.ball, f.of.layers || t.layers,
                f.of.face || t.face};
        changed = std::move(next);
        for (Eigen::Index k = first; k < at; ++k) f.entry.push_back(k);
      } else {
        other = true;
      }
    }
    if (other) f.other.push_back(form->effect);
  }
  f.first = changed.front();
  return f;
}

/// Without `left_out` of them at either end.
Use range_of_shots(const std::vector<Shot>& shots, double left_out) {
  std::vector<double> speed, loft;
  for (const Shot& s : shots) {
    const Use use = use_of(s.blow);
    speed.push_back(use.impact_speed.low);
    loft.push_back(use.spin_loft.low);
  }
  const auto most = [&](std::vector<double>& x) {
    std::ranges::sort(x);
    const auto out = std::min((x.size() - 1) / 2, static_cast<std::size_t>(std::ceil(left_out * double(x.size()))));
    return Interval{x[out], x[x.size() - 1 - out]};
  };
  return {most(speed), most(loft)};
}

Offer told_of(const loop::ShotCase& c, const loop::LoopResult& r, const std::vector<Shot>& shots,
              const std::vector<int>& row_of, const Finding& found) {
  Offer o{
      .what = fmt::format("{}: {} with {}", r.title.empty() ? "a loop" : r.title, r.base, fmt::join(r.adopted, ", ")),
      .source = fmt::format("{} measured shots", r.used)};
  const loop::Fit& fit = r.selection.chosen;
  o.covariance = r.covariance(found.entry, found.entry);
  Eigen::Index at = 0;
  for (const loop::Parametrisation* form : fit.model.forms)
    for (const loop::Parameter& p : form->parameters) {
      const Eigen::Index of_fit = at++;
      if (!std::ranges::count(found.entry, of_fit)) continue;
      const auto k = Eigen::Index(o.values.size());
      o.parameters.push_back(fmt::format("{}: {} [{}]", form->effect, p.name, p.unit));
      o.values.push_back(fit.p[of_fit] / p.si);
      o.covariance.row(k) /= p.si;
      o.covariance.col(k) /= p.si;
    }
  o.of.assign(o.values.size(), "value");
  for (const auto& tie : r.ties)
    o.unidentified.push_back(fmt::format("the shots cannot separate {}", fmt::join(tie, " and ")));
  // Rows that the loop set aside are not what the entry saw.
  std::vector<Shot> used;
  for (std::size_t i = 0; i < shots.size(); ++i)
    if (std::ranges::find(r.rows, row_of[i], &loop::UsedRow::row) != r.rows.end()) used.push_back(shots[i]);
  const Use use = range_of_shots(used.empty() ? shots : used, 0);
  o.seen = {.impact_speed = use.impact_speed, .spin_loft = use.spin_loft, .clubs = {}, .not_for = {}};
  if (const loop::Column* club = loop::as_read(c).find_stem("club"); club && !club->numeric)
    for (const std::string& name : club->text)
      if (!name.empty() && std::ranges::find(o.seen.clubs, name) == o.seen.clubs.end()) o.seen.clubs.push_back(name);
  for (const std::string& effect : found.other)
    o.seen.not_for.push_back(
        fmt::format("a claim that needs {}: the loop's model has it too, and this entry does not", effect));
  return o;
}

}  // namespace

std::optional<Use> use_of_shots(const loop::ShotCase& c) {
  try {
    const std::vector<Shot> shots = loop::make_inputs(c.shots, c.blow, c.head_mass_declared, {}, c.loft_unknown).trials;
    if (!shots.empty()) return range_of_shots(shots, 0.05);
  } catch (const DataError&) {}  // the loop says it when it runs
  return {};
}

void offer_corrected(Output& out, const loop::ShotCase& c, const loop::LoopResult& result,
                     const models::ChangeableFe* base, const HeadWords& words) {
  if (result.adopted.empty() || result.selection.chosen.size() == 0) return;
  const loop::Inputs inputs = loop::make_inputs(c.shots, c.blow, c.head_mass_declared, {}, c.loft_unknown);
  const std::vector<Shot>& shots = inputs.trials;
  if (shots.empty()) return;
  std::vector<std::string> adopted = result.adopted;
  adopted.insert(adopted.end(), c.effects.begin(), c.effects.end());  // the case declares these
  const Finding found = with_effects(result.selection.chosen, adopted, shots, base != nullptr);
  Offer o = told_of(c, result, shots, inputs.row_of, found);
  const Blow& blow = found.first.blow;
  if (found.of.contact) {
    NamedContact contact;
    if (base) contact.face_friction = blow.contact.friction;
    else contact.law = blow.contact;
    offer(out, Shelf::contacts, o, contact_tables(contact));
  }
  // A head whose mass is each club's own is no head.
  const bool one_mass = std::ranges::all_of(
      shots, [&](const Shot& s) { return s.blow.club.head.mass == shots.front().blow.club.head.mass; });
  std::optional<FaceCompliance> face;
  if (base) face = models::changed(blow.club.head.compliance, found.first.change.face_compliance, blow.club.head);
  if (found.of.head) {
    if (!one_mass || !blow.club.head.faults().empty() || !blow.club.head.inertia.allFinite())
      out.tell("the head is not offered to the library: its mass is each club's own, or its inertia is not declared");
    else if (words.face.empty() || (base && found.of.face))
      out.tell(
          "the head is not offered to the library: an entry names its face, and this face has no name there. Adopt "
          "the face, name it in [face], and run the loop again");
    else offer(out, Shelf::heads, o, head_tables(blow.club.head, words.face, words.loft, blow.club.geometry));
  }
  if (base && (found.of.layers || found.of.ball))
    offer(out, Shelf::balls, o,
          ball_tables(blow.ball, models::changed(base->impact().ball, found.first.change, blow.ball.radius)));
  if (base && found.of.face && face) offer(out, Shelf::faces, o, face_tables(*face));
}

}  // namespace hosel::app
