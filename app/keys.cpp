#include "app/keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/cases.hpp"
#include "app/job.hpp"
#include "app/reader.hpp"

namespace hosel::app {
namespace {

/// A shipped case with changes that lead the reader where no shipped case goes. It may end in an error, of a file that
/// is not there or of a table left over: what has been asked for until then counts. tests/app/keys_test.cpp says which
/// declaration is still without one.
struct Sample {
  const char* name;
  std::vector<std::string> set;
};

std::vector<Sample> samples() {
  const std::string springs =
      "stiffness_N_per_m=[1,1,1], rotational_stiffness_N_m_per_rad=[1,1,1], damping_N_s_per_m=[1,1,1], "
      "rotational_damping_N_m_s_per_rad=[1,1,1]";
  return {
      {"driver-toe",
       {"output.vtk=true", "mesh.tilt_rad=0.1", "contact.face_transition_speed_mps=0.5",
        "contact.method=augmented-lagrangian", "grip.force_N=[0,0,0]", "grip.moment_N_m=[0,0,0]"}},
      {"driver-toe", {"grip={hold='hands', " + springs + "}", "face={effective_mass_g=10, stiffness_N_per_m=5e6}"}},
      {"driver-toe", {"joint={kind='hinge', axis=[0,1,0]}"}},
      {"driver-toe", {"shaft={table={file='case.toml'}}"}},
      {"driver-toe", {"ball.changes={}", "ball.temperature={now_C=5}"}},
      {"driver-toe",
       {"shaft={polynomial={length_m=1, bending_stiffness_N_m2=[40], torsional_stiffness_N_m2=[40], "
        "mass_per_length_kg_per_m=[0.06], mean_radius_m=[0.005]}, offsets={arc_length_mm=[0]}, "
        "tip={from_mm=500, bending_scale=1, torsion_scale=1}}"}},
      {"driver-toe",
       {"shaft={tube={arc_length_mm=[0,1000], outer_radius_mm=[7,4], wall_mm=[1,1], shear_factor=0.5, "
        "layer=[{E_GPa=100, G_GPa=20, density_kg_per_m3=1600}]}}"}},
      // Other lengths than those of the shipped cases: any is allowed.
      {"driver-toe",
       {"shaft={table={arc_length_mm=[0,500,1000], bending_stiffness_N_m2=[3,2,1], torsional_stiffness_N_m2=[3,2,1], "
        "mass_per_length_g_per_m=[60,60,60], mean_radius_mm=[6,5,4]}}"}},
      {"driver-toe",
       {"shaft={tube={arc_length_mm=[0,500,1000], outer_radius_mm=[7,6,4], wall_mm=[1,1,1], "
        "layer=[{E_GPa=100, G_GPa=20, density_kg_per_m3=1600}]}}"}},
      {"driver-toe", {"contact.face_static_friction=0.5", "contact.face_slip_distance_um=1"}},
      {"ball-modes", {"ball={layers=[{law='mooney-rivlin', c10_MPa=1, c01_MPa=1, bulk_MPa=100}]}"}},
      {"ball-modes", {"ball={layers=[{law='yeoh', c10_MPa=1, c20_MPa=1, bulk_MPa=100}]}"}},
      {"ball-modes", {"ball={layers=[{law='ogden', bulk_MPa=100, moduli_MPa=[1,2], exponents=[2,3]}]}"}},
      {"ball-modes", {"ball={layers=[{law='ogden', bulk_MPa=100, moduli_MPa=[1], exponents=[2]}]}"}},
      {"ball-modes", {"ball={layers=[{law='gent', shear_MPa=1, limit=5, bulk_MPa=100}]}"}},
      {"material-point", {"material={law='mooney-rivlin', c10_MPa=1, c01_MPa=1, bulk_MPa=100}", "path.kind=uniaxial"}},
      {"material-point", {"material={law='yeoh', c10_MPa=1, c20_MPa=1, bulk_MPa=100}"}},
      {"material-point", {"material={law='ogden', bulk_MPa=100, moduli_MPa=[1], exponents=[2]}"}},
      {"material-point",
       {"material={law='gent', shear_MPa=1, limit=5, bulk_MPa=100, temperature={now_C=5}}", "path.kind=uniaxial"}},
      {"radar-drive", {"flight.law=table", "flight.coefficients=case.toml"}},
      {"radar-drive",
       {"flight.spin_decay_per_s=0.04", "flight.wind={speed_mps=3, towards_deg=0}",
        "flight.ground={height_m=0, slope_deg=0}"}},
      {"rollback", {"launch={ball_speed_mps=70, launch_angle_deg=10, azimuth_deg=0, spin_rate_rpm=2500}"}},
      {"rollback", {"launch={backspin_rpm=2500}"}},
      {"plate-face",
       {"face.plate.material=own", "face.plate.young_GPa=110", "face.plate.poisson=0.3",
        "face.plate.density_kg_per_m3=4500", "face.plate.outline={form='superellipse', exponent=3}",
        "face.plate.thickness={map='rings', share=[0.3,0.8], value_mm=[3,2.5]}",
        "face.plate.rim={support='springs', rotation_N=1e3, deflection_GPa=1, stretch_GPa=1}"}},
      {"plate-face",
       {"face.plate.thickness={map='bulge', centre_mm=3, rim_mm=2, half_width_mm=30, half_height_mm=18}",
        "face.plate.outline={form='polygon', file='outline.csv'}"}},
      {"plate-face", {"face.plate.thickness={map='grid', file='thickness.csv'}"}},
      {"driver-toe", {"face={plate={thickness={value_mm=2.8}}}"}},
      {"loaded-club",
       {"accuracy=look", "flight={units='metres'}", "shaft.tip={from_mm=500, bending_scale=1, torsion_scale=1}"}},
      {"launch-ratio", {"keep_bounce_mps=40"}},
      {"calibrate-tour", {"free=[{what='head-mass', shots=['driver 2023']}]"}},
      {"loop-flights", {"data.paths='not-there/paths.csv'", "data.position_noise_m=0.1", "unknown.spin_rate_rpm=2600"}},
      {"loop-flights-waialae",
       {"paths.channels=ends", "paths.carry_noise_m=1", "paths.side_noise_m=1", "paths.apex_noise_m=1",
        "paths.time_noise_s=0.1"}},
      {"shaft-mass-sweep", {"sample={points=2, seed=1}", "axis=[{key='shaft.mass_scale', range=[0.5,2]}]"}},
      {"launch-ratio", {"rows.file='case.toml'"}},
      {"launch-ratio", {"compare={with='variant', variant='driver, one piece'}"}},
      {"launch-ratio",
       {"measured.launch_ratio=[0.8,0.9]", "grid={columns=3, rows=3}",
        "statement=[{text='it is', holds='launch_ratio > 0'}]", "figure=[{kind='bars'}]"}},
      {"swing-driver", {"joint={kind='hinge', axis=[0,1,0]}", "grip={drive='hands', " + springs + "}"}},
      {"swing-driver", {"grip={drive='forced', wrench='grip.csv'}", "joint={kind='spring', " + springs + "}"}},
      {"loop-bench", {"bench={start='impulse', impulse_N_s=[1,0,0], rotation_axis='droop'}", "grip={hold='clamped'}"}},
      {"loop-bench",
       {"data.series='not-there/record.csv'", "sensors.lead_mid_mm.axis=lead", "sensors.lead_mid_mm.radius_mm=5"}},
      {"swing-driver", {"kind=identify-shaft", "swing=[{motion={file='grip.csv'}, deflection='grip.csv'}]"}},
  };
}

/// What a declaration says of the allowed values beyond its type.
std::string range_of(const Declared& d) {
  if (d.type == "3x3 matrix" || !(d.type.starts_with("list of") || d.type.ends_with("number"))) return {};
  if (d.type == "list of texts" || d.type == "list of values") return {};
  const Range& r = d.range;
  if (r.min == Range::finite().min && r.max == Range::finite().max && !r.also_infinite) return {};
  std::optional<Unit> unit;
  const auto all = all_units();
  if (const auto it = std::ranges::find(all, d.unit, &Unit::suffix); it != all.end()) unit = *it;
  return r.allowed(unit);
}

void add(std::vector<AcceptedKey>& keys, const std::string& kind, const std::vector<Declared>& declared) {
  for (const Declared& d : declared) {
    const auto dot = d.shown.rfind('.');
    const std::string table = dot == std::string::npos ? "" : d.shown.substr(0, dot);
    const std::string name = dot == std::string::npos ? d.shown : d.shown.substr(dot + 1);
    auto it = std::ranges::find_if(keys, [&](const AcceptedKey& k) {
      return k.table == table && k.name == name && (k.meaning == d.meaning || d.meaning.empty());
    });
    if (it == keys.end()) it = keys.insert(keys.end(), {.table = table, .name = name, .meaning = d.meaning});
    it->kinds.insert(kind);
    it->types.insert(d.type);
    it->ranges.insert(range_of(d));
    if (!d.decided_by.empty()) it->decided_by.emplace(d.decided_by);
    if (d.standard) it->standards.insert(*d.standard);
    it->optional = it->optional || d.optional;
    it->required = it->required || (!d.standard && !d.optional);
  }
}

std::string heading(const std::string& table) {
  if (table.empty()) return "top of the file";
  std::string plain = table;
  for (std::size_t at; (at = plain.find("[]")) != std::string::npos;) plain.erase(at, 2);
  return table.ends_with("[]") ? fmt::format("[[{}]]", plain) : fmt::format("[{}]", plain);
}

/// "by head.name".
std::string decided(const AcceptedKey& k) { return fmt::format("by {}", fmt::join(k.decided_by, " or ")); }

/// "number, 0.01 to 5 kg".
std::string value_of(const AcceptedKey& k) {
  std::string type = *k.types.begin();
  if (k.types.size() > 1) {
    const bool lists = std::ranges::all_of(k.types, [](const std::string& t) { return t.starts_with("list of"); });
    const auto choice = std::ranges::find_if(k.types, [](const std::string& t) { return t.starts_with("one of"); });
    // "text" as well: one reader only passes over the key.
    type = lists                                                 ? "list of numbers"
           : choice != k.types.end() && k.types.contains("text") ? *choice
                                                                 : fmt::format("{}", fmt::join(k.types, " or "));
  }
  if (type.starts_with("one of ") && std::ranges::count(type, ',') > 7) return "a name (`hosel list`)";
  if (k.ranges.size() > 2 && !k.decided_by.empty()) return type + ", range " + decided(k);
  if (k.ranges.size() > 1) return fmt::format("{}, {}", type, fmt::join(k.ranges, "; or "));
  const std::string& range = *k.ranges.begin();
  return range.empty() ? type : fmt::format("{}, {}", type, range);
}

std::string default_of(const AcceptedKey& k) {
  if (k.standards.empty()) return k.optional ? "-" : "required";
  std::string standard = k.standards.begin()->empty() ? "empty" : *k.standards.begin();
  if (k.standards.size() > 1) standard = k.decided_by.empty() ? std::string(kUndecided) : decided(k);
  return k.required ? "required, or " + standard : standard;
}

std::string listed(const std::set<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

/// One table of the case file and its keys, in the order of asking.
struct Section {
  std::string table;
  std::set<std::string> kinds;
  std::vector<const AcceptedKey*> keys;
};

std::vector<Section> by_table(const std::vector<AcceptedKey>& keys) {
  std::vector<Section> out;
  for (const AcceptedKey& k : keys) {
    auto it = std::ranges::find(out, k.table, &Section::table);
    if (it == out.end()) it = out.insert(out.end(), {k.table, {}, {}});
    it->kinds.insert(k.kinds.begin(), k.kinds.end());
    it->keys.push_back(&k);
  }
  return out;
}

}  // namespace

std::vector<CaseFile> cases_with_every_key() {
  std::vector<CaseFile> read;
  for (const auto& [name, title] : shipped_cases()) {
    CaseFile& file = read.emplace_back(find_case(name));
    file.for_keys_alone();
    read_job(file);
  }
  for (const Sample& v : samples()) {
    CaseFile& file = read.emplace_back(find_case(v.name), v.set);
    file.for_keys_alone();
    const auto kind = std::ranges::find(kinds(), file.root().text("kind", "impact"), &Kind::name);
    try {
      kind->read(file);
    } catch (const std::exception&) {}  // as Sample says
  }
  return read;
}

std::vector<AcceptedKey> accepted_keys() {
  std::vector<CaseFile> read = cases_with_every_key();
  std::vector<AcceptedKey> keys;
  for (const Kind& kind : kinds())
    for (CaseFile& file : read)
      if (file.root().text("kind", "impact") == kind.name) add(keys, std::string(kind.name), file.declared());
  // One reader of layers serves every kind: which of its laws a sample has is chance.
  constexpr std::string_view layers = "ball.layers[]";
  std::set<std::string> with_layers;
  for (const AcceptedKey& k : keys)
    if (k.table == layers) with_layers.insert(k.kinds.begin(), k.kinds.end());
  for (AcceptedKey& k : keys)
    if (k.table == layers) k.kinds = with_layers;
  return keys;
}

std::string keys_text(const std::vector<AcceptedKey>& keys, std::string_view of) {
  std::vector<std::string> names = names_in(kinds());
  const bool kind = std::ranges::find(names, of) != names.end();
  std::string out;
  for (const Section& s : by_table(keys)) {
    names.push_back(s.table);
    const bool inside = s.table == of ||
                        (s.table.starts_with(of) && s.table.find_first_of(".[", of.size()) == of.size());
    if (!of.empty() && !kind && !inside) continue;
    std::vector<const AcceptedKey*> wanted;
    for (const AcceptedKey* k : s.keys)
      if (!kind || k->kinds.contains(std::string(of))) wanted.push_back(k);
    if (wanted.empty()) continue;
    std::size_t name = 0, value = 0, standard = 0;
    for (const AcceptedKey* k : wanted) {
      name = std::max(name, k->name.size());
      value = std::max(value, std::min<std::size_t>(40, value_of(*k).size()));
      standard = std::max(standard, default_of(*k).size());
    }
    out += heading(s.table) + "\n";
    for (const AcceptedKey* k : wanted)
      out += fmt::format("  {:<{}}  {:<{}}  {:<{}}  {}\n", k->name, name, value_of(*k), value, default_of(*k), standard,
                         k->meaning);
  }
  if (out.empty())
    throw InputError(
        fmt::format("keys: no kind and no table '{}'{}", of, or_nearest(of, names, "; `hosel keys` prints all")));
  return out;
}

std::string keys_markdown(const std::vector<AcceptedKey>& keys) {
  std::string out = R"(# Reference: every key of a case

Written by `scripts/write-reference` from what the reader declares where it reads (`hosel keys` prints the same,
`hosel keys KIND` or `hosel keys TABLE` a part of it). A key with a unit at its end may carry any other unit of the same
dimension: `club_speed_mps`, `club_speed_mph`. What is not listed is an error. A list of tables `[[table]]` may stand
several times. Default `-`: the key may be left out, and then says nothing. Default `by KEY`: what that key says decides;
`hosel check CASE` prints it for a case. `Read in`: the kinds of the shipped cases that
read the table; a case of another kind that asks the same model reads it as well.
)";
  for (const Section& s : by_table(keys)) {
    out += fmt::format("\n## {}\n\nRead in: {}.\n\n| key | value | default | meaning |\n|---|---|---|---|\n",
                       s.table.empty() ? "Top of the file" : "`" + heading(s.table) + "`", listed(s.kinds));
    for (const AcceptedKey* k : s.keys)
      out += fmt::format("| `{}` | {} | {} | {}{} |\n", k->name, value_of(*k), default_of(*k), k->meaning,
                         k->kinds == s.kinds ? "" : fmt::format(" ({})", listed(k->kinds)));
  }
  return out;
}

}  // namespace hosel::app
