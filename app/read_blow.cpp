#include "app/read_blow.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "app/library.hpp"
#include "app/read_shaft.hpp"
#include "models/registry.hpp"

namespace hosel::app {

Range limits::of(Input input) {
  switch (input) {
    case Input::club_speed: return club_speed;
    case Input::attack_angle:
    case Input::club_path:
    case Input::face_angle:
    case Input::dynamic_loft: return angle;
    case Input::impact_toe:
    case Input::impact_high: return impact_place;
    case Input::head_mass: return head_mass;
  }
  return Range::finite();
}

Ball read_ball(Table table) {
  const std::optional<std::string> named = named_entry(table, "model", Shelf::balls);
  const Ball standard = named ? library_ball(*named).body : Ball{};
  Ball ball;
  ball.mass = table.quantity({"mass", "of the ball"}, "kg", limits::ball_mass, standard.mass);
  ball.radius = table.quantity({"radius", "of the ball"}, "mm", limits::ball_radius, standard.radius);
  ball.inertia_factor = table.number({"inertia_factor", "moment of inertia over mass times radius squared"},
                                     Range{0.05, 0.6667}.because("0.4 is a uniform sphere, 2/3 a shell"),
                                     standard.inertia_factor);
  return ball;
}

Ball read_optional_ball(Table root) {
  if (auto ball = root.optional_table("ball")) return read_ball(*ball);
  return {};
}

Head read_head(Table table, bool whole) {
  std::optional<HeadEntry> named;
  if (const auto name = named_entry(table, "name", Shelf::heads)) named = library_head(*name);
  return read_head_values(table, whole, standard_of(named, &HeadEntry::head));
}

Head read_head_values(Table table, bool whole, const std::optional<Head>& named) {
  Head head;
  table.decided_by("head.name");
  head.mass = table.quantity({"mass", "of the clubhead; inf is a head that no blow moves"}, "kg", limits::head_mass,
                             standard_of(named, &Head::mass));
  head.face.bulge = table.quantity({"bulge", "radius of the face's curvature from heel to toe; inf is flat"}, "mm",
                                   limits::face_radius, named ? named->face.bulge : limits::inf);
  head.face.roll = table.quantity({"roll", "radius of the face's curvature up the face; inf is flat"}, "mm",
                                  limits::face_radius, named ? named->face.roll : limits::inf);
  const bool needed = whole && std::isfinite(head.mass);
  const bool given = table.has_quantity("inertia") || table.has_quantity("cg") || named;
  if (!needed && !given) {
    if (std::isfinite(head.mass)) head.inertia = Vec3::Constant(limits::inf).asDiagonal();
    return head;
  }
  head.cg = table.vector({"cg", "centre of gravity in the face frame (Xc out of the face, Yc to the heel, Zc up)"},
                         "mm", limits::head_place, standard_of(named, &Head::cg));
  head.inertia = table.matrix({"inertia", "inertia tensor about the centre of gravity, face frame"}, "kg_m2",
                              standard_of(named, &Head::inertia));
  auto faults = head.faults();
  if (std::isfinite(head.mass) && faults.empty()) {
    const Vec3 principal = Eigen::SelfAdjointEigenSolver<Mat3>(head.inertia).eigenvalues();
    for (const double moment : {principal[0], principal[2]})
      if (const double r = std::sqrt(moment / head.mass); !limits::gyration.contains(r))
        faults.push_back(fmt::format(
            "a principal moment of {:g} kg m2 of a head of {:g} kg is a radius of gyration of "
            "{:g} mm (allowed: {:g} to {:g} mm; {})",
            moment, head.mass, 1e3 * r, 1e3 * limits::gyration.min, 1e3 * limits::gyration.max, limits::gyration.why));
  }
  if (!faults.empty()) {
    // At the tensor, or at the mass where a case changes that alone; what the command line says comes first.
    std::string at;
    for (const std::string_view stem : {"inertia", "mass"})
      for (const std::string& key : table.keys())
        if (split_unit(key).stem == stem && (at.empty() || (table.set_by_command(key) && !table.set_by_command(at))))
          at = key;
    if (named || !at.empty()) table.fail(at, faults.front());
  }
  for (const std::string& key : table.keys()) {
    if (key.starts_with("cg") && head.cg.x() > 0)
      table.fail(key, fmt::format("the centre of gravity lies {:g} mm in front of the face (Xc points out of the face: "
                                  "the first component is negative or zero)",
                                  1e3 * head.cg.x()));
  }
  return head;
}

namespace {

void read_place(Table& table, Delivery& d) {
  d.impact_toe = table.quantity({"impact_toe", "where the ball meets the face, from its centre towards the toe"}, "mm",
                                limits::impact_place, 0);
  d.impact_high = table.quantity({"impact_high", "where the ball meets the face, from its centre up"}, "mm",
                                 limits::impact_place, 0);
}

}  // namespace

Delivery read_delivery(Table table, double loft) {
  Delivery d;
  d.club_speed = table.quantity({"club_speed", "speed of the head's centre of gravity at first contact"}, "mps",
                                limits::club_speed);
  d.attack_angle = table.quantity({"attack_angle", "direction of the head's velocity, up"}, "deg", limits::angle, 0);
  d.club_path =
      table.quantity({"club_path", "direction of the head's velocity, right of the target"}, "deg", limits::angle, 0);
  table.decided_by("head.name");
  d.dynamic_loft =
      table.quantity({"dynamic_loft", "tilt of the face's normal at its centre, up"}, "deg", limits::angle, loft);
  d.face_angle = table.quantity({"face_angle", "direction of the face's normal at its centre, right of the target"},
                                "deg", limits::angle, 0);
  read_place(table, d);
  d.head_angular_velocity = table.vector({"head_angular_velocity", "of the head at first contact, global frame"},
                                         "rad_per_s", limits::spin, Vec3::Zero());
  return d;
}

ContactLaw read_contact_law(Table table, const std::optional<ContactLaw>& standard) {
  ContactLaw law;
  table.decided_by("contact.name or ball.model");
  law.restitution = table.number({"restitution", "normal coefficient of restitution at 0 m/s approach speed"},
                                 Range{0, 1}.because("above 1 the blow creates energy"),
                                 standard_of(standard, &ContactLaw::restitution));
  law.restitution_slope = table.quantity({"restitution_slope", "change of restitution with approach speed"}, "s_per_m",
                                         {-0.1, 0.1}, standard_of(standard, &ContactLaw::restitution_slope));
  law.restitution_falloff = table.number(
      {"restitution_falloff_per_m2", "fall of restitution with the squared distance from the face's centre"},
      {-1e4, 1e4}, standard ? standard->restitution_falloff : 0);
  law.tangential_restitution =
      table.number({"tangential_restitution",
                    "minus the contact point's tangential velocity after over before: 0 rolls, 1 returns everything"},
                   {-1, 1}, standard_of(standard, &ContactLaw::tangential_restitution));
  law.friction = table.number({"friction", "Coulomb limit of the impulse; inf sticks"}, {0, limits::inf},
                              standard_of(standard, &ContactLaw::friction));
  law.normal_force_offset = table.number(
      {"normal_force_offset",
       "the normal impulse passes this far below the ball's centre, down the face along the slip, over its radius; "
       "positive adds spin"},
      {-0.5, 0.5}, standard_of(standard, &ContactLaw::normal_force_offset));
  return law;
}

ContactLaw read_contact(Table root, const std::vector<std::string>& models) {
  const std::optional<NamedContact> named = named_contact(root);
  const bool law = named && named->law;
  if (!law && !root.has("contact") && std::ranges::none_of(models, asks_law)) return {};
  return read_contact_law(root.default_table("contact"), law ? *named->law : ContactLaw{});
}

Delivery read_delivery_of(Table root) {
  if (root.has("motion")) {
    Delivery place;
    Table table = root.default_table("delivery");
    read_place(table, place);
    return place;
  }
  double loft = 0;
  if (auto head = root.optional_table("head"))
    if (const auto name = named_entry(*head, "name", Shelf::heads)) loft = library_head(*name).loft.value_or(0);
  return read_delivery(root.table("delivery"), loft);
}

std::vector<std::string> read_models(Table root) {
  std::vector<std::string> wanted =
      root.texts({"models", "the models that answer (`hosel list`); a study without them follows the stated [launch]"});
  if (wanted.empty()) root.fail("models", "name at least one model");
  for (const std::string& m : wanted) {
    if (std::ranges::count(wanted, m) > 1) root.fail("models", fmt::format("'{}' is there twice", m));
    if (!models::find(m))
      root.fail("models", fmt::format("no model '{}'{}", m,
                                      or_nearest(m, names_in(models::registry()), "; `hosel list` shows them")));
  }
  return wanted;
}

Blow read_blow(Table root, const std::vector<std::string>& models) {
  Blow blow;
  blow.ball = read_optional_ball(root);
  const bool whole = std::ranges::any_of(models, [](const std::string& m) { return m != "rigid-planar"; });
  blow.club.head = read_head(root.table("head"), whole);
  blow.delivery = read_delivery_of(root);
  if (auto shaft = root.optional_table("shaft")) blow.club.shaft = read_shaft(*shaft);
  blow.club.geometry = read_club_geometry(root, blow.club.shaft.has_value());
  blow.contact = read_contact(root, models);
  check_use(root, root.has("motion") ? std::nullopt : std::optional(use_of(blow)), models);
  return blow;
}

void check_shaft(const Table& root, const Blow& blow, const std::vector<std::string>& models) {
  for (const std::string& m : models)
    if (!blow.club.shaft && (m == "fe-full-club" || m == "shaft-coupled"))
      root.fail("models", fmt::format("{} needs the club's shaft: [shaft] with a `name`, or a table of its own", m));
}

std::string off_the_face(const Blow& blow, const mesh::PlateOutline* outline) {
  const double toe = blow.delivery.impact_toe, high = blow.delivery.impact_high;
  const std::optional<FaceCompliance>& face = blow.club.head.compliance;
  const bool bounded = face && std::isfinite(face->half_width) && std::isfinite(face->half_height);
  const double width = bounded ? face->half_width : 0.0635, height = bounded ? face->half_height : 0.0355;
  const Eigen::Vector2d place(-toe, high);
  const bool on = outline   ? outline->share(place) < 1
                  : bounded ? place.dot(face->ellipse() * place) < 1
                            : std::abs(toe) <= width && std::abs(high) <= height;
  if (on) return {};
  const std::string where = fmt::format("the ball is struck off the face: {:g} mm towards the {} and {:g} mm {}",
                                        1e3 * std::abs(toe), toe < 0 ? "heel" : "toe", 1e3 * std::abs(high),
                                        high < 0 ? "down" : "up");
  if (outline) return where + ", beside the outline of [face.plate]";
  return fmt::format("{}, where {} reaches {:g} mm to either side and {:g} mm up and down", where,
                     bounded ? "the ellipse on which this face deflects" : "no face by the rules", 1e3 * width,
                     1e3 * height);
}

}  // namespace hosel::app
