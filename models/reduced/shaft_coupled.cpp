#include "models/reduced/shaft_coupled.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <mutex>
#include <vector>

namespace hosel::models {
namespace {

/// Everything a condensed shaft depends on, as numbers.
std::vector<double> signature(const Club& club, const ShaftImpedanceOptions& o) {
  std::vector<double> s = {double(o.functions),      o.highest,        double(o.feels_translation),
                           double(o.feels_rotation), double(o.hinged), club.shaft ? club.shaft->damping_time : -1};
  for (const Vec3& v : {club.geometry.hosel, club.geometry.shaft_axis, club.head.cg})
    s.insert(s.end(), v.data(), v.data() + 3);
  if (club.shaft)
    for (const ShaftStation& t : club.shaft->stations) {
      for (const auto& centre : {t.centres.elastic, t.centres.shear, t.centres.mass})
        s.insert(s.end(), centre.begin(), centre.end());
      s.insert(s.end(),
               {t.arc_length, t.bending_stiffness_y, t.bending_stiffness_z, t.torsional_stiffness, t.axial_stiffness,
                t.shear_stiffness, t.mass_per_length, t.rotary_inertia_y, t.rotary_inertia_z});
    }
  return s;
}

/// The condensation costs milliseconds, a blow microseconds, and a face map asks for one club: the
/// last club asked for stays at hand. A pure function of its argument all the same.
std::shared_ptr<const ShaftImpedance> condensed(const Club& club, const ShaftImpedanceOptions& options) {
  static std::mutex mutex;
  static std::vector<double> key;
  static std::shared_ptr<const ShaftImpedance> kept;
  std::vector<double> wanted = signature(club, options);
  {
    const std::lock_guard lock(mutex);
    if (kept && key == wanted) return kept;
  }
  auto fresh = std::make_shared<const ShaftImpedance>(shaft_impedance(club, options));
  const std::lock_guard lock(mutex);
  key = std::move(wanted);
  return kept = std::move(fresh);
}

}  // namespace

Launch ShaftCoupled::launch(const Blow& blow) const {
  const auto shaft = condensed(blow.club, beam_);
  if (beam_.hinged && (mount_.loaded || mount_.load))
    throw std::invalid_argument(
        "shaft-coupled: the condensed shaft stands on the head as the club was built, and a swing turns a hinge far: "
        "use fe-full-club for a loaded start with a hinge");
  std::optional<LoadedShaft> loaded = mount_.loaded;
  if (!loaded && mount_.load)
    loaded = loaded_by_grip(blow, *mount_.load, mount_.grip_point, mount_.elements, mount_.growth, mount_.shear);
  if (!loaded) return volumetric_impact(blow, law_, options_, shaft.get()).launch;
  ShaftImpedance accelerating = *shaft;
  accelerating.acceleration.emplace() << loaded->head_acceleration, loaded->head_angular_acceleration;
  return volumetric_impact(blow, law_, options_, &accelerating).launch;
}

std::vector<Answer> ShaftCoupled::launches(std::span<const Blow> blows) const {
  if (loaded()) return ImpactModel::launches(blows);
  std::vector<Answer> answers;
  answers.reserve(blows.size());
  while (answers.size() < blows.size()) {
    const std::span<const Blow> rest = blows.subspan(answers.size());
    const std::vector<double> club = signature(rest.front().club, beam_);
    const auto other = std::find_if(rest.begin() + 1, rest.end(),
                                    [&](const Blow& blow) { return signature(blow.club, beam_) != club; });
    const auto alike = rest.first(static_cast<std::size_t>(other - rest.begin()));
    try {
      const auto shaft = condensed(rest.front().club, beam_);
      std::ranges::move(volumetric_launches(alike, law_, options_, shaft.get()), std::back_inserter(answers));
    } catch (...) { answers.resize(answers.size() + alike.size(), {{}, std::current_exception()}); }  // no shaft
  }
  return answers;
}

}  // namespace hosel::models
