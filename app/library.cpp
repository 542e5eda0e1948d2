#include "app/library.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <utility>

#include "app/of_file.hpp"
#include "app/read_blow.hpp"
#include "app/read_face.hpp"
#include "app/read_options.hpp"
#include "app/read_shaft.hpp"
#include "app/read_solid.hpp"
#include "build_info.hpp"
#include "post/file.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace fs = std::filesystem;

std::string_view name(Shelf shelf) {
  constexpr std::array names = {"balls", "faces", "heads", "contacts"};
  return names[static_cast<std::size_t>(shelf)];
}

std::string_view singular(Shelf shelf) {
  const std::string_view all = name(shelf);
  return all.substr(0, all.size() - 1);
}

fs::path user_library() {
  for (const auto& [variable, below] : {std::pair{"HOSEL_LIBRARY", ""}, {"XDG_DATA_HOME", "hosel"}})
    if (const char* named = std::getenv(variable); named && *named) return fs::path(named) / below;
  const char* home = std::getenv("HOME");
  if (!home || !*home) return {};
  return fs::path(home) / ".local" / "share" / "hosel";
}

fs::path shipped_library() {
  const fs::path tree = fs::path(HOSEL_SOURCE_DIR) / "library";
  return fs::is_directory(tree) ? tree : fs::path(HOSEL_INSTALLED_LIBRARY);
}

namespace {

/// What stands above the values in every entry: the rest of the file is read by who knows the shelf.
Seen read_saw(Table root) {
  Seen s;
  auto t = root.optional_table("saw");
  if (!t) return s;
  const auto interval = [&](Key key, std::string_view unit, Range range) -> std::optional<Interval> {
    if (!t->has_quantity(key.name)) return {};
    const auto ends = t->quantities(key, unit, 2, range);
    if (ends[0] > ends[1]) t->fail("", fmt::format("{}: give the lowest and the highest", key.name));
    return Interval{ends[0], ends[1]};
  };
  s.impact_speed =
      interval({"impact_speed", "normal speed of approach, as on a wall: lowest and highest"}, "mps", {0, 200});
  s.spin_loft =
      interval({"spin_loft", "between the path and the face's normal: lowest and highest"}, "deg", {0, radians(92)});
  s.clubs = t->texts({"clubs", "that were struck"}, std::vector<std::string>{});
  s.faces = t->texts({"faces", "on which the ball was struck: the set is for these"}, std::vector<std::string>{});
  s.not_for = t->texts({"not_for", "sentences: what the entry must not be used for"}, std::vector<std::string>{});
  return s;
}

/// Where the numbers come from and how well they are known: read for its faults.
void read_origin(Table root) {
  root.text({"what", "one sentence for `hosel list`"});
  Table p = root.table("provenance");
  p.text({"source", "where the numbers come from"});
  p.text({"case", "that found them: its title or its name"}, "");
  p.text({"inputs", "digest of everything that the case reads"}, "");
  p.text({"build", "of the program that found them"}, "");
  if (auto fit = root.optional_table("fit")) {
    const auto parameters = fit->texts({"parameters", "that were fitted, each with its unit"});
    const std::size_t n = parameters.size();
    fit->numbers({"values", "found, one for each parameter"}, n);
    const auto c = fit->numbers({"covariance", "of the parameters, row by row"}, n * n, Range::finite().or_infinite());
    const auto of = fit->texts({"of", "what the covariance is of, for each parameter: value or logarithm"});
    if (of.size() != n ||
        std::ranges::any_of(of, [](const std::string& o) { return o != "value" && o != "logarithm"; }))
      fit->fail("of", "say of each parameter: \"value\" or \"logarithm\"");
    fit->texts({"unidentified", "what the data did not decide"}, std::vector<std::string>{});
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j <= i; ++j)
        if (i == j ? !(c[i * n + i] >= 0) : std::abs(c[i * n + j] - c[j * n + i]) > 1e-9 * std::abs(c[i * n + j]))
          fit->fail("covariance", "a covariance is symmetric and has no negative variance");
  }
}

/// The parts of a contact that stand in a table: of an entry's file, or of one set in a ball's.
NamedContact read_parts(Table t, const std::string& called) {
  NamedContact c{.name = called};
  if (auto contact = t.optional_table("contact")) {
    if (contact->has("face_friction"))
      c.face_friction = contact->number(
          {"face_friction", "Coulomb coefficient between the finite-element ball and the face"}, {0, 5});
    if (contact->has("restitution")) c.law = read_contact_law(*contact, {});
  }
  if (auto volume = t.optional_table("volumetric")) c.volume = read_volumetric_law(*volume, {});
  if (auto hertz = t.optional_table("hertz_maw")) c.hertz_maw = read_hertz_maw_law(*hertz, {});
  if (!c.law && !c.face_friction && !c.volume && !c.hertz_maw)
    t.fail("", "says nothing of a contact: a table [contact], [volumetric] or [hertz_maw]");
  c.seen = read_saw(t);
  return c;
}

BallEntry read_ball_entry(Table root) {
  BallEntry e;
  Table ball = root.table("ball");
  e.body = read_ball(ball);
  e.layers = read_layers(ball);
  std::vector<std::string> taken;
  for (Table t : root.tables("reduced"))
    e.reduced.push_back(read_parts(t, t.name({"name", "of this set, for `[ball] reduced`"}, taken)));
  return e;
}

FaceEntry read_face_entry(Table root) {
  FaceEntry e;
  e.face = read_compliance(root.table("face"), {});
  return e;
}

/// What heads of one kind differ by, one standard deviation: for the reader.
void read_spread(Table t) {
  t.text({"source", "where the standard deviations come from"});
  const auto one = [&](Key key, std::string_view unit) {
    if (t.has_quantity(key.name)) t.quantity(key, unit, Range::non_negative());
  };
  one({"mass", "of the head"}, "kg");
  one({"bulge", "of the face's radius from heel to toe"}, "mm");
  one({"roll", "of the face's radius up the face"}, "mm");
  one({"loft", "of the head"}, "deg");
  if (t.has("inertia")) t.number({"inertia", "of each principal moment, relative"}, {0, 1});
  if (t.has_quantity("cg")) t.vector({"cg", "of the centre of gravity, each way"}, "mm", Range::non_negative());
}

HeadEntry read_head_entry(Table root) {
  HeadEntry e;
  Table head = root.table("head");
  e.head = read_head_values(head, true, {});
  if (head.has_quantity("loft"))
    e.loft = head.quantity({"loft", "of the face at its centre, the shaft upright"}, "deg", limits::angle);
  e.face = head.text({"face", "of the library, or \"rigid\""});
  if (e.face == kRigidFace) e.face.clear();
  else try {
      library_face(e.face);
    } catch (const InputError& error) { head.fail("face", error.what()); }
  if (auto t = root.optional_table("hosel")) e.hosel = read_hosel(*t, {});
  if (auto t = root.optional_table("spread")) read_spread(*t);
  return e;
}

NamedContact read_contact_entry(Table root) { return read_parts(std::move(root), ""); }

/// A file of the library, read whole: what is left over is an error.
template <class Entry>
Entry read_entry(const fs::path& file, Entry (*read)(Table)) {
  static OfFile<Entry> entries(true);
  return entries.get(file, [&] {
    CaseFile text(file);
    Table root = text.root();
    read_origin(root);
    Entry entry = read(root);
    if constexpr (requires { entry.seen; }) entry.seen = read_saw(root);
    else read_saw(root);  // of a head: for the reader
    text.finish();
    return entry;
  });
}

/// Names and files of one folder in the order of names, nothing read.
using Folder = std::shared_ptr<const std::vector<LibraryEntry>>;
Folder in_folder(const fs::path& folder, bool shipped) {
  static OfFile<Folder> of_hosel(true), of_user(true);  // the same folder may be both
  return (shipped ? of_hosel : of_user).get(folder, [&] {
    std::vector<LibraryEntry> here;
    std::error_code none;
    if (!shipped &&
        fs::equivalent(folder, shipped_library() / folder.filename(), none))  // who ships entries makes them
      return std::make_shared<const std::vector<LibraryEntry>>();
    for (const auto& file : fs::directory_iterator(folder, none))
      if (file.path().extension() == ".toml" && file.is_regular_file())
        here.push_back({.name = file.path().stem().string(), .what = {}, .file = file.path(), .shipped = shipped});
    std::ranges::sort(here, {}, &LibraryEntry::name);
    return std::make_shared<const std::vector<LibraryEntry>>(std::move(here));
  });
}

/// Names and files of a shelf, folder by folder: the shipped one first. All points of a study see the same.
const std::vector<Folder>& on_shelf(Shelf shelf) {
  struct Contents {
    unsigned long by = 0;
    std::vector<Folder> folders;
  };
  thread_local std::map<Shelf, Contents> all;
  Contents& seen = all[shelf];
  const unsigned long study = StudyFiles::now();
  if (study && seen.by == study) return seen.folders;
  static const fs::path of_hosel = shipped_library();
  seen = {study, {in_folder(of_hosel / name(shelf), true)}};
  if (const fs::path own = user_library(); !own.empty()) seen.folders.push_back(in_folder(own / name(shelf), false));
  return seen.folders;
}

std::vector<std::string> names_on(Shelf shelf) {
  std::vector<std::string> out;
  for (const Folder& folder : on_shelf(shelf))
    for (const LibraryEntry& e : *folder) out.push_back(e.name);
  if (shelf == Shelf::faces) out.emplace_back(kRigidFace);
  return out;
}

LibraryEntry find_entry(Shelf shelf, const std::string& wanted) {
  const LibraryEntry* found = nullptr;
  for (const Folder& folder : on_shelf(shelf))
    if (const auto it = std::ranges::find(*folder, wanted, &LibraryEntry::name); it != folder->end()) {
      if (found)
        throw InputError(
            fmt::format("{}: a shipped {} has this name: rename yours", it->file.string(), singular(shelf)));
      found = &*it;
    }
  if (!found)
    throw InputError(fmt::format("no {} '{}' in the library{}", singular(shelf), wanted,
                                 or_nearest(wanted, names_on(shelf), "; `hosel list` shows them")));
  return *found;
}

}  // namespace

std::vector<LibraryEntry> library(Shelf shelf) {
  std::vector<LibraryEntry> all;
  for (const Folder& folder : on_shelf(shelf)) all.insert(all.end(), folder->begin(), folder->end());
  for (LibraryEntry& e : all) try {
      e.what = CaseFile(e.file).root().text({"what", "one sentence for `hosel list`"});
    } catch (const InputError& error) { e.what = fmt::format("(unreadable: {})", error.what()); }
  return all;
}

BallEntry library_ball(const std::string& wanted) {
  BallEntry e = read_entry(find_entry(Shelf::balls, wanted).file, read_ball_entry);
  e.layers.name = wanted;
  return e;
}

FaceEntry library_face(const std::string& wanted) {
  return read_entry(find_entry(Shelf::faces, wanted).file, read_face_entry);
}

HeadEntry library_head(const std::string& wanted) {
  return read_entry(find_entry(Shelf::heads, wanted).file, read_head_entry);
}

NamedContact library_contact(const std::string& wanted) {
  NamedContact c = read_entry(find_entry(Shelf::contacts, wanted).file, read_contact_entry);
  c.name = wanted;
  return c;
}

void check_entry(Shelf shelf, const fs::path& file) {
  switch (shelf) {
    case Shelf::balls: read_entry(file, read_ball_entry); break;
    case Shelf::faces: read_entry(file, read_face_entry); break;
    case Shelf::heads: read_entry(file, read_head_entry); break;
    case Shelf::contacts: read_entry(file, read_contact_entry); break;
  }
}

std::optional<std::string> named_entry(Table& table, std::string_view key, Shelf shelf) {
  if (!table.has(key)) return {};
  const std::string meaning = fmt::format("a {} of the library (`hosel list`)", singular(shelf));
  std::string wanted = table.choice({key, meaning}, names_on(shelf));
  if (shelf == Shelf::faces && wanted == kRigidFace) return wanted;
  const LibraryEntry entry = find_entry(shelf, wanted);
  if (!entry.shipped) {
    table.note_file(entry.file);
    const std::string now = post::digest(post::read_file(entry.file));
    table.keep("digest");
    if (table.text({"digest", "of your own entry when the case was resolved"}, now) != now)
      table.fail("digest",
                 fmt::format("'{}' is not what it was when this case was resolved: {}", wanted, entry.file.string()));
  }
  return wanted;
}

Use use_of(const Blow& blow) {
  const Delivery& d = blow.delivery;
  const Vec3 velocity = d.velocity(), normal = d.face_to_global().col(0);
  const double mass = blow.club.head.mass;
  const double share = std::isinf(mass) ? 1 : std::sqrt(mass / (mass + blow.ball.mass));
  const double approach = share * velocity.dot(normal);
  const double loft = std::acos(std::clamp(velocity.normalized().dot(normal), -1.0, 1.0));
  return {{approach, approach}, {loft, loft}};
}

Use both(const Use& a, const Use& b) {
  const auto hull = [](const Interval& x, const Interval& y) {
    return Interval{std::min(x.low, y.low), std::max(x.high, y.high)};
  };
  return {hull(a.impact_speed, b.impact_speed), hull(a.spin_loft, b.spin_loft)};
}

namespace {

/// What of a use lies beyond what was seen, as a sentence; empty where nothing does. A thousandth of the range is
/// forgiven: the ends of intervals are rounded.
std::string beyond(const Seen& seen, const Use& use) {
  const auto outside = [](const std::optional<Interval>& saw, const Interval& asked, std::string_view what, double unit,
                          std::string_view symbol) -> std::string {
    if (!saw) return {};
    const double slack = 1e-3 * (saw->high - saw->low);
    if (asked.low >= saw->low - slack && asked.high <= saw->high + slack) return {};
    const std::string asks = asked.high - asked.low > slack
                                 ? fmt::format("{:.3g} to {:.3g}", asked.low / unit, asked.high / unit)
                                 : fmt::format("{:.3g}", asked.low / unit);
    return fmt::format("saw {} of {:g} to {:g} {} and is asked about {} {}", what, saw->low / unit, saw->high / unit,
                       symbol, asks, symbol);
  };
  std::string text = outside(seen.impact_speed, use.impact_speed, "impact speeds (normal, as on a wall)", 1, "m/s");
  if (text.empty()) text = outside(seen.spin_loft, use.spin_loft, "spin lofts", kRadPerDeg, "deg");
  return text;
}

void refuse(Table& table, std::string_view key, const std::string& called, const Seen& seen,
            const std::optional<Use>& use) {
  const bool beyond_all_the_same = table.has("extrapolate") &&
                                   table.flag({"extrapolate", "use the library's entry beyond what it saw"}, false);
  if (!use || beyond_all_the_same) return;
  if (const std::string text = beyond(seen, *use); !text.empty())
    table.fail(key, fmt::format("'{}' {}: `extrapolate = true` beside its name uses it all the same", called, text));
}

/// The face that the case or its head names; empty where neither does.
std::string face_name(Table root) {
  if (auto face = root.optional_table("face"); face && !face->keys().empty())
    return named_entry(*face, "name", Shelf::faces).value_or("");
  if (auto head = root.optional_table("head"))
    if (const auto called = named_entry(*head, "name", Shelf::heads)) return library_head(*called).face;
  return "";
}

}  // namespace

// A set that knows the case's face comes before one of the right loft alone.
const NamedContact* LoftSets::at(const Blow& blow) const {
  for (const bool same_face : {true, false})
    for (const NamedContact& s : sets)
      if (same_face == (std::ranges::find(s.seen.faces, face) != s.seen.faces.end()) &&
          beyond({.spin_loft = s.seen.spin_loft}, use_of(blow)).empty())
        return &s;
  return nullptr;
}

bool LoftSets::matter_to(const std::string& model) const {
  if (!model.starts_with("fe-")) return true;
  return std::ranges::any_of(sets,
                             [&](const NamedContact& s) { return s.face_friction != sets.front().face_friction; });
}

std::optional<LoftSets> sets_by_loft(Table root) {
  auto contact = root.optional_table("contact");
  auto ball = root.optional_table("ball");
  if (!ball || ball->has("reduced") || root.has("motion") || (contact && contact->has("name"))) return {};
  const auto model = named_entry(*ball, "model", Shelf::balls);
  if (!model) return {};
  LoftSets out{library_ball(*model).reduced, face_name(root), *model};
  return out.sets.size() > 1 ? std::optional(std::move(out)) : std::nullopt;
}

std::vector<std::string> with_set(std::vector<std::string> overrides, const std::string& set) {
  // The loft at which the search begins may lie beyond what the set saw.
  overrides.insert(overrides.end(), {fmt::format("ball.reduced=\"{}\"", set), "ball.extrapolate=true"});
  return overrides;
}

std::string consistent_set(const LoftSets& sets, const std::function<Blow(const std::string&)>& match) {
  std::vector<std::string> consistent, chosen, found;
  for (const NamedContact& s : sets.sets) try {
      const Blow blow = match(s.name);
      found.push_back(fmt::format("'{}' {:.2f} deg", s.name, degrees(blow.delivery.dynamic_loft)));
      if (const NamedContact* own = sets.at(blow); own && own->name == s.name)
        consistent.push_back(s.name), chosen.push_back(found.back());
    } catch (const solvers::NonConvergence&) {}
  if (consistent.size() == 1) return consistent.front();
  if (!consistent.empty())
    throw solvers::NonConvergence(
        fmt::format("several of the ball's sets of parameters lead to a loft that chooses them ({}): say which by "
                    "ball.reduced",
                    fmt::join(chosen, ", ")));
  throw solvers::NonConvergence(fmt::format(
      "none of the ball's sets of parameters leads to a loft that chooses it ({}): say which by ball.reduced",
      found.empty() ? "none gives the launch angle" : fmt::format("{}", fmt::join(found, ", "))));
}

std::string used_beyond(const CaseFile& file, const std::vector<std::string>& overrides, const Blow& blow,
                        const std::string& model) {
  CaseFile found(file, overrides);
  try {
    check_use(found.root(), use_of(blow), {model});
  } catch (const InputError& e) { return e.what(); }
  return {};
}

namespace {

/// Whether finite elements alone answer, with a friction of the case: of a set they would take the friction alone.
bool needs_no_set(Table root) {
  auto contact = root.optional_table("contact");
  if (!contact || !contact->has("face_friction") || !root.has("models")) return false;
  return std::ranges::all_of(root.texts({"models"}), [](const std::string& m) { return m.starts_with("fe-"); });
}

}  // namespace

std::optional<NamedContact> named_contact(Table root) {
  if (auto contact = root.optional_table("contact"))
    if (const auto wanted = named_entry(*contact, "name", Shelf::contacts)) return library_contact(*wanted);
  auto ball = root.optional_table("ball");
  if (!ball) return {};
  const auto model = named_entry(*ball, "model", Shelf::balls);
  if (!model) return {};
  LoftSets by_loft{library_ball(*model).reduced, {}, *model};
  const std::vector<NamedContact>& sets = by_loft.sets;
  if (sets.empty()) return {};
  const std::vector<std::string> names = names_in(sets);
  if (ball->has("reduced")) {
    const std::string wanted =
        ball->choice({"reduced", "which of the ball's sets of parameters the reduced models take"}, names);
    return *std::ranges::find(sets, wanted, &NamedContact::name);
  }
  if (sets.size() == 1) return sets.front();
  std::string loft = root.has("motion") ? "the loft is not known before the swing" : "each shot has a loft of its own";
  if (root.has("delivery") && root.has("head") && !root.has("motion")) {
    Blow blow;
    blow.delivery = read_delivery_of(root);
    loft = fmt::format("none of them saw this loft, a spin loft of {:.3g} deg (dynamic loft less attack angle)",
                       degrees(blow.delivery.dynamic_loft - blow.delivery.attack_angle));
    if (blow.delivery.dynamic_loft == 0 && !root.table("delivery").has_quantity("dynamic_loft"))
      loft =
          "[delivery] has no dynamic_loft_deg to choose one by; a study that varies the loft needs one there as well";
    by_loft.face = face_name(root);
    if (const NamedContact* s = by_loft.at(blow)) return *s;
  }
  if (needs_no_set(root)) return {};
  ball->fail("model", fmt::format("'{}' has several sets of parameters and {}: say which by `reduced` ({})", *model,
                                  loft, fmt::join(names, ", ")));
}

bool asks_law(std::string_view model) {
  constexpr std::array laws = {"rigid-planar", "rigid-eccentric", "stick-slip", "pendulum-club", "hinged-head"};
  return std::ranges::find(laws, model) != laws.end();
}

bool asks_face(std::string_view model) {
  return model.starts_with("fe-") || model == "volumetric" || model == "shaft-coupled";
}

void check_use(Table root, const std::optional<Use>& use, const std::vector<std::string>& models) {
  const bool fe = std::ranges::any_of(models, [](const std::string& m) { return m.starts_with("fe-"); });
  const bool volume =
      std::ranges::any_of(models, [](const std::string& m) { return m == "volumetric" || m == "shaft-coupled"; });
  const bool hertz = std::ranges::find(models, "hertz-maw") != models.end();
  const bool law = std::ranges::any_of(models, asks_law);
  auto ball = root.optional_table("ball");
  if (ball && fe)
    if (const auto model = named_entry(*ball, "model", Shelf::balls))
      refuse(*ball, "model", *model, library_ball(*model).seen, use);
  std::optional<NamedContact> contact = named_contact(root);
  if (!contact && ball)  // a ball that says nothing of a contact
    if (const auto model = named_entry(*ball, "model", Shelf::balls)) contact = NamedContact{.name = *model};
  if (contact) {
    auto own = root.optional_table("contact");
    const bool by_name = own && own->has("name");
    Table& at = by_name ? *own : *ball;
    const char* key = by_name ? "name" : "model";
    const auto needs = [&](bool asked, bool there, std::string_view what) {
      if (asked && !there)
        at.fail(key, fmt::format("'{}' has no {}: state them in the case, or name another", contact->name, what));
    };
    needs(law, contact->law || (own && own->has("restitution")), "restitution and friction for the rigid models");
    needs(volume, contact->volume || root.has("volumetric"), "constants of the volumetric model");
    needs(hertz, contact->hertz_maw || root.has("hertz_maw"), "constants of hertz-maw");
    if (law || volume || hertz || (fe && contact->face_friction)) refuse(at, key, contact->name, contact->seen, use);
  }
  if (std::ranges::none_of(models, asks_face)) return;
  if (auto face = root.optional_table("face"); face && !face->keys().empty()) {
    if (const auto called = named_entry(*face, "name", Shelf::faces); called && *called != kRigidFace)
      refuse(*face, "name", *called, library_face(*called).seen, use);
  } else if (auto head = root.optional_table("head")) {
    if (const auto called = named_entry(*head, "name", Shelf::heads))
      if (const std::string f = library_head(*called).face; !f.empty())
        refuse(*head, "name", f, library_face(f).seen, use);
  }
}

}  // namespace hosel::app
