/// The domain's nouns from a case's tables: each key is declared here, once, with unit and range.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/reader.hpp"
#include "golf/blow.hpp"
#include "golf/quantities.hpp"
#include "mesh/plate.hpp"

namespace hosel::app {

/// What balls and clubs can be, and why [SI].
namespace limits {
inline constexpr double inf = std::numeric_limits<double>::infinity();
inline constexpr Range ball_mass = Range{1e-6, 1}.because("a golf ball weighs 0.046 kg");
inline constexpr Range ball_radius = Range{2e-3, 0.1}.because("a golf ball's is 21.3 mm");
inline constexpr Range head_mass =
    Range{0.01, 5}.or_infinite().because("a clubhead weighs 0.2 to 0.3 kg, inf is a wall");
inline constexpr Range club_speed = Range{0, 150, true}.because("the fastest swings reach 70 m/s");
inline constexpr Range angle = Range{-kPi / 2, kPi / 2}.because("beyond a right angle the face looks back");
inline constexpr Range impact_place = Range{-0.1, 0.1}.because("no face is wider");
inline constexpr Range head_place = Range{-0.3, 0.3}.because("a clubhead is no larger");
/// A head's own radius of gyration [m].
inline constexpr Range gyration = Range{1e-3, 0.3}.because("a clubhead is no larger");
inline constexpr Range spin = Range{-1e3, 1e3}.because("a swung head turns at 40 rad/s");
/// Of what is told of each blow, whether in a case, in a table or from Python.
Range of(Input input);
inline constexpr Range face_radius = Range{0.01, 1e4}.or_infinite().because("inf is a flat face");
}  // namespace limits

/// `[ball]`: mass, radius and inertia, by default those of the library's `model` where it is named.
Ball read_ball(Table table);
/// `[ball]` of a case, a usual ball without it.
Ball read_optional_ball(Table root);
/// `[head]`: `name` of the library, single values of it replaced; without one all that is needed is required.
/// `mass_kg = inf` is a rigid wall; `whole = false` reads the mass alone (rigid-planar). The centre of gravity lies
/// behind the face.
Head read_head(Table table, bool whole = true);
/// The same with what `named` has for default.
Head read_head_values(Table table, bool whole, const std::optional<Head>& named);
/// `loft` is the dynamic loft where none is stated [rad].
Delivery read_delivery(Table table, double loft = 0);
/// `[delivery]` of a case: without a dynamic loft that of the head that the case names. Where a `[motion]` swings the
/// club it says the place on the face alone.
Delivery read_delivery_of(Table root);
/// Without a standard every value but the falloff is required.
ContactLaw read_contact_law(Table table, const std::optional<ContactLaw>& standard);
/// `[contact]` of a case, on top of what it names in the library; with every default where one of `models` asks it.
ContactLaw read_contact(Table root, const std::vector<std::string>& models);

/// `models = [...]`: names from the registry, at least one.
std::vector<std::string> read_models(Table root);
/// Everything that the models of a case are asked about, from its tables.
Blow read_blow(Table root, const std::vector<std::string>& models);
/// Refuses a model of the whole club where the case has no shaft.
void check_shaft(const Table& root, const Blow& blow, const std::vector<std::string>& models);
/// A sentence where the ball is struck off the face; empty where it is struck on it: within the ellipse on which a
/// compliant face deflects, within the outline of a face with a thickness, or else within what the widest heads of the
/// rules of golf have (127 mm heel to toe, 71 mm high).
std::string off_the_face(const Blow& blow, const mesh::PlateOutline* outline = nullptr);

}  // namespace hosel::app
