#include "app/offer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <toml++/toml.h>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "app/version.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "post/file.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
namespace {

constexpr std::array kShelves = {Shelf::balls, Shelf::faces, Shelf::heads, Shelf::contacts};

fs::path offered_file(const fs::path& out, Shelf shelf) {
  return out / "entries" / fmt::format("{}.toml", singular(shelf));
}

std::string toml_list(const std::vector<std::string>& texts) {
  std::vector<std::string> all;
  for (const std::string& t : texts) all.push_back(toml_text(t));
  return fmt::format("[{}]", fmt::join(all, ", "));
}

/// Every digit: what is read is what was found.
std::string toml_list(const std::vector<double>& values) { return fmt::format("[{}]", fmt::join(values, ", ")); }
std::string toml_list(const Vec3& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

std::string saw_tables(const Seen& seen, std::string_view table) {
  std::string text;
  const auto interval = [&](const std::optional<Interval>& i, std::string_view key, double unit) {
    if (i) text += fmt::format("{} = [{:.6g}, {:.6g}]\n", key, i->low / unit, i->high / unit);
  };
  interval(seen.impact_speed, "impact_speed_mps", 1);
  interval(seen.spin_loft, "spin_loft_deg", kRadPerDeg);
  if (!seen.clubs.empty()) text += fmt::format("clubs = {}\n", toml_list(seen.clubs));
  if (!seen.not_for.empty()) text += fmt::format("not_for = {}\n", toml_list(seen.not_for));
  return text.empty() ? text : fmt::format("\n[{}]\n{}", table, text);
}

}  // namespace

std::string toml_text(const std::string& text) {
  const toml::value<std::string> value(text);
  std::ostringstream out;
  out << toml::toml_formatter(value, toml::format_flags{});
  return out.str();
}

std::string ball_tables(const Ball& body, const models::FeBall& layers) {
  std::string text = fmt::format("\n[ball]\nmass_kg = {}\nradius_mm = {}\ninertia_factor = {}\n", body.mass,
                                 1e3 * body.radius, body.inertia_factor);
  for (const models::BallLayer& layer : layers.layers) {
    const auto* law = layer.material.elastic.as<fem::Hyperelastic>();
    if (!law) throw std::invalid_argument("only layers of neo-hooke, mooney-rivlin and yeoh can be adopted");
    const bool yeoh = law->c20 != 0 || law->c30 != 0;
    if (yeoh && law->c01 != 0)
      throw std::invalid_argument("a layer with c01 beside c20 or c30 has no name in a case and cannot be adopted");
    std::vector<double> moduli, times;
    for (const auto& b : layer.material.branches) moduli.push_back(b.modulus / 1e6), times.push_back(b.time * 1e3);
    text += fmt::format("[[ball.layers]]\nradius_fraction = {}\nlaw = \"{}\"\nc10_MPa = {}\n", layer.radius,
                        law->c01 != 0 ? "mooney-rivlin"
                        : yeoh        ? "yeoh"
                                      : "neo-hooke",
                        law->c10 / 1e6);
    if (law->c01 != 0) text += fmt::format("c01_MPa = {}\n", law->c01 / 1e6);
    if (yeoh) text += fmt::format("c20_MPa = {}\nc30_MPa = {}\n", law->c20 / 1e6, law->c30 / 1e6);
    text += fmt::format("bulk_MPa = {}\ndensity_kg_per_m3 = {}\nbranch_moduli_MPa = {}\nbranch_times_ms = {}\n",
                        law->bulk / 1e6, layer.material.density, toml_list(moduli), toml_list(times));
  }
  return text;
}

std::string face_tables(const FaceCompliance& f) {
  return fmt::format(
      "\n[face]\neffective_mass_g = {}\nstiffness_N_per_m = {}\ndamping_N_s_per_m = {}\nhalf_width_mm = {}\n"
      "half_height_mm = {}\n",
      1e3 * f.mass, f.stiffness, f.damping, 1e3 * f.half_width, 1e3 * f.half_height);
}

std::string head_tables(const Head& h, std::string_view face, const std::optional<double>& loft,
                        const std::optional<ClubGeometry>& geometry) {
  std::vector<std::string> rows;
  for (int k = 0; k < 3; ++k) rows.push_back(toml_list(Vec3(h.inertia.row(k))));
  std::string text =
      fmt::format("\n[head]\nmass_kg = {}\ncg_mm = {}\ninertia_kg_m2 = [{}]\nbulge_mm = {}\nroll_mm = {}\nface = {}\n",
                  h.mass, toml_list(Vec3(1e3 * h.cg)), fmt::join(rows, ", "), 1e3 * h.face.bulge, 1e3 * h.face.roll,
                  toml_text(std::string(face)));
  if (loft) text += fmt::format("loft_deg = {}\n", degrees(*loft));
  if (geometry) {
    const Vec3& a = geometry->shaft_axis;
    text += fmt::format("\n[hosel]\nposition_mm = {}\nlie_deg = {}\nlean_deg = {}\n",
                        toml_list(Vec3(1e3 * geometry->hosel)), degrees(std::atan2(std::hypot(a.x(), a.z()), a.y())),
                        degrees(std::atan2(a.x(), a.z())));
  }
  return text;
}

std::string contact_tables(const NamedContact& c) {
  std::string text;
  if (c.law || c.face_friction) text += "\n[contact]\n";
  if (c.face_friction) text += fmt::format("face_friction = {}\n", *c.face_friction);
  if (c.law)
    text += fmt::format(
        "restitution = {}\nrestitution_slope_s_per_m = {}\nrestitution_falloff_per_m2 = {}\n"
        "tangential_restitution = {}\nfriction = {}\nnormal_force_offset = {}\n",
        c.law->restitution, c.law->restitution_slope, c.law->restitution_falloff, c.law->tangential_restitution,
        c.law->friction, c.law->normal_force_offset);
  if (const auto& v = c.volume)
    text += fmt::format(
        "\n[volumetric]\nstiffness_N_per_m3 = {}\ndamping_s_per_m = {}\nfriction = {}\nstatic_friction = {}\n"
        "transition_speed_mps = {}\njoint_stiffness_N_m_per_rad = {}\njoint_damping_N_m_s_per_rad = {}\n"
        "cover_thickness_mm = {}\nvolume_exponent = {}\n",
        v->stiffness, v->damping, v->friction, v->static_friction, v->transition_speed, v->joint_stiffness,
        v->joint_damping, 1e3 * v->cover_thickness, v->volume_exponent);
  if (const auto& h = c.hertz_maw)
    text += fmt::format("\n[hertz_maw]\nmodulus_MPa = {}\npoisson = {}\nfriction = {}\ndamping_s_per_m = {}\n",
                        1e-6 * h->modulus, h->poisson, h->friction, h->damping);
  return text;
}

void offer(Output& out, Shelf shelf, const Offer& o, const std::string& tables) {
  std::string text = fmt::format("what = {}\n\n[provenance]\nsource = {}\ncase = {}\ninputs = {}\nbuild = {}\n",
                                 toml_text(o.what), toml_text(o.source),
                                 toml_text(toml::parse(out.resolved_case())["title"].value_or(std::string())),
                                 toml_text(out.fingerprint()), toml_text(program_version()));
  if (!o.parameters.empty()) {
    // Infinite along what the data do not show: such a parameter is uncertain by itself.
    Eigen::MatrixXd covariance = o.covariance;
    for (Eigen::Index i = 0; i < covariance.rows(); ++i)
      for (Eigen::Index j = 0; j < covariance.cols(); ++j)
        if (!std::isfinite(covariance(i, j))) covariance(i, j) = i == j ? std::numeric_limits<double>::infinity() : 0;
    text += fmt::format("\n[fit]\nparameters = {}\nvalues = {}\ncovariance = {}\nof = {}\n", toml_list(o.parameters),
                        toml_list(o.values),
                        toml_list(std::vector<double>(covariance.data(), covariance.data() + covariance.size())),
                        toml_list(o.of));
    if (!o.unidentified.empty()) text += fmt::format("unidentified = {}\n", toml_list(o.unidentified));
  }
  text += saw_tables(o.seen, "saw") + tables;
  const fs::path file = offered_file(out.directory(), shelf);
  out.write(fs::path(file).lexically_relative(out.directory()).string(), text);
  try {
    check_entry(shelf, file);
  } catch (const InputError& error) {  // a law may extrapolate beyond what the library takes, a restitution above 1 say
    post::remove_file(file);
    out.tell(
        fmt::format("the {} is not offered to the library, which would refuse it: {}", singular(shelf), error.what()));
    return;
  }
  out.tell(
      fmt::format("offers a {} to the library: hosel adopt {} --as NAME", singular(shelf), out.directory().string()));
}

void withdraw_offers(Output& out) {
  for (const Shelf shelf : kShelves) {
    std::error_code none;
    fs::remove(offered_file(out.directory(), shelf), none);
  }
}

std::vector<fs::path> adopt(const fs::path& out, const std::string& name, bool force) {
  if (!fs::is_regular_file(out / "summary.json"))
    throw InputError(fmt::format("{}: no finished run lies there", out.string()));
  std::vector<Shelf> shelves;
  for (const Shelf shelf : kShelves)
    if (fs::is_regular_file(offered_file(out, shelf))) shelves.push_back(shelf);
  if (shelves.empty())
    throw InputError(
        fmt::format("{}: offers nothing to the library: that do calibrate-ball, calibrate-face, and a loop "
                    "on shots that adopted an effect on ball, face, head or contact",
                    out.string()));
  constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyz0123456789-";
  if (name.empty() || name.size() > 60 || name.find_first_not_of(allowed) != std::string::npos || name == kRigidFace)
    throw InputError(fmt::format("--as {}: a name is made of small letters, digits and hyphens", name));
  const fs::path home = user_library();
  if (home.empty())
    throw InputError("no place for a library of your own: neither HOSEL_LIBRARY nor XDG_DATA_HOME nor HOME is set");
  // All are looked at before any is written.
  for (const Shelf shelf : shelves) {
    check_entry(shelf, offered_file(out, shelf));
    for (const LibraryEntry& e : library(shelf)) {
      if (e.name != name) continue;
      if (e.shipped)
        throw InputError(fmt::format("--as {}: the shipped library has a {} of this name", name, singular(shelf)));
      if (!force) throw InputError(fmt::format("{}: is there already; --force replaces it", e.file.string()));
    }
  }
  std::vector<fs::path> written;
  for (const Shelf shelf : shelves) {
    const fs::path file = home / app::name(shelf) / (name + ".toml");
    fs::create_directories(file.parent_path());
    post::write_file(file, post::read_file(offered_file(out, shelf)));
    written.push_back(file);
  }
  return written;
}

}  // namespace hosel::app
