/// The library: balls, faces, heads and contacts as TOML files with where they come from and what they saw. One reader
/// for what is shipped and for what a user made by `hosel adopt`. The format: library/README.md.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/read_shaft.hpp"
#include "app/reader.hpp"
#include "golf/blow.hpp"
#include "golf/face_compliance.hpp"
#include "models/fe/fe_ball.hpp"
#include "models/options.hpp"
#include "models/reduced/volumetric.hpp"
#include "models/rigid/hertz_maw.hpp"

namespace hosel::app {

/// Instead of a face's name: none that yields.
inline constexpr std::string_view kRigidFace = "rigid";

enum class Shelf { balls, faces, heads, contacts };
std::string_view name(Shelf shelf);      ///< of the folder: "balls"
std::string_view singular(Shelf shelf);  ///< "ball"

/// Where a user's own entries lie: HOSEL_LIBRARY, else XDG_DATA_HOME/hosel, else ~/.local/share/hosel; empty where
/// none of them is set.
std::filesystem::path user_library();
/// The shipped one: the tree's (a build in its checkout), else the installed one.
std::filesystem::path shipped_library();

struct LibraryEntry {
  std::string name;
  std::string what;  ///< one sentence for `hosel list`, or why it cannot be read
  std::filesystem::path file;
  bool shipped = true;
};
/// In the order of their names, shipped ones first.
std::vector<LibraryEntry> library(Shelf shelf);

struct Interval {
  double low, high;
};

/// What an entry saw, and is good for therefore. Absent: not limited.
struct Seen {
  /// Normal speed of approach at the face's centre, as it would be on a wall: times sqrt(M / (M + m)) on a head of mass
  /// M [m/s].
  std::optional<Interval> impact_speed;
  /// Between the head's velocity and the face's normal; the angle of incidence of a thrown ball [rad].
  std::optional<Interval> spin_loft;
  std::vector<std::string> clubs;    ///< for the reader
  std::vector<std::string> faces;    ///< of a ball's set of reduced parameters: for which faces it is
  std::vector<std::string> not_for;  ///< likewise: what it must not be used for
};

/// What a blow asks of an entry.
struct Use {
  Interval impact_speed, spin_loft;
};
Use use_of(const Blow& blow);
Use both(const Use& a, const Use& b);

/// Parameters of the models that have no deformable ball, and the friction of those that have: each part where stated.
struct NamedContact {
  std::string name;                             ///< of the entry, and of the set in a ball's file
  std::optional<ContactLaw> law;                ///< of the rigid models
  std::optional<double> face_friction;          ///< of the finite-element models
  std::optional<models::VolumetricLaw> volume;  ///< without a face
  std::optional<models::HertzMawLaw> hertz_maw;
  Seen seen;
};

struct BallEntry {
  Ball body;
  models::FeBall layers;
  std::vector<NamedContact> reduced;
  Seen seen;
};

struct FaceEntry {
  FaceCompliance face;
  Seen seen;
};

struct HeadEntry {
  Head head;
  std::optional<double> loft;  ///< of the face at its centre, the shaft upright [rad]
  std::string face;            ///< of the library; empty: rigid
  std::optional<HoselPlace> hosel;
};

/// Throw InputError with file and line of the entry, or saying which names there are.
BallEntry library_ball(const std::string& name);
FaceEntry library_face(const std::string& name);
HeadEntry library_head(const std::string& name);
NamedContact library_contact(const std::string& name);
/// Reads a file of that shelf and refuses what is wrong in it.
void check_entry(Shelf shelf, const std::filesystem::path& file);

/// The entry that TABLE names under KEY, if it does: a name of the shelf, marked as read. A user's entry is echoed with
/// its digest, and refused where the case was resolved with another content of it.
std::optional<std::string> named_entry(Table& table, std::string_view key, Shelf shelf);

/// The contact of a case: `[contact] name`, else what `[ball] model` carries for this loft (`[ball] reduced` names one
/// of several). Nothing where neither is there.
std::optional<NamedContact> named_contact(Table root);

/// The sets of reduced parameters of a case's ball, of which the loft chooses one.
struct LoftSets {
  std::vector<NamedContact> sets;
  std::string face;  ///< of the case or its head; empty: none
  std::string ball;  ///< whose they are
  /// The set that saw the spin loft of this blow; nullptr where none did.
  const NamedContact* at(const Blow& blow) const;
  /// Whether it matters to a model which of them is taken.
  bool matter_to(const std::string& model) const;
};
/// Nothing where the ball has one set, or the case says which, or a swing says the loft.
std::optional<LoftSets> sets_by_loft(Table root);
/// Overrides of a case that take this set whatever the loft.
std::vector<std::string> with_set(std::vector<std::string> overrides, const std::string& set);
/// The only set that is the choice of the loft to which it leads itself. `match`: the blow that meets the measured
/// launch angle with that set. Throws solvers::NonConvergence where several sets are, or none.
std::string consistent_set(const LoftSets& sets, const std::function<Blow(const std::string& set)>& match);

/// Whether this model takes its contact from [contact]: restitution and friction.
bool asks_law(std::string_view model);
/// Whether this model knows a face that yields: [face], or that of the head.
bool asks_face(std::string_view model);

/// Refuses, with a sentence, an entry that has nothing of what `models` ask, and one that is used beyond what it saw
/// unless `extrapolate = true` stands beside its name. Without a use, which a swing tells at its end, the first alone.
void check_use(Table root, const std::optional<Use>& use, const std::vector<std::string>& models);
/// The sentence of check_use about a blow that was found by a search; empty where the entries saw it.
std::string used_beyond(const CaseFile& file, const std::vector<std::string>& overrides, const Blow& blow,
                        const std::string& model);

}  // namespace hosel::app
