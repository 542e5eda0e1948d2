#include "app/read_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/check_memory.hpp"
#include "app/library.hpp"
#include "app/read_face.hpp"
#include "app/read_plate.hpp"
#include "app/read_solid.hpp"
#include "app/read_swing.hpp"
#include "fem/contact_method/methods.hpp"

namespace hosel::app {
namespace {

/// A finite-element ball turns as its layers do. What a resolved case has as the default is not the case's own word.
void check_inertia(Table& ball, const Ball& body, const models::FeBall& layers) {
  if (!ball.has("inertia_factor")) return;
  const std::optional<std::string> named = named_entry(ball, "model", Shelf::balls);
  const double standard = (named ? library_ball(*named).body : Ball{}).inertia_factor, meshed = layers.inertia_factor();
  // A mesh of two rings has 0.3 % less.
  if (body.inertia_factor == standard || std::abs(body.inertia_factor - meshed) <= 0.01 * meshed) return;
  ball.fail("inertia_factor",
            fmt::format("is {:.4g}, and the layers have {:.4g}: a finite-element ball turns as its layers do; leave "
                        "the key out, or give the layers such densities",
                        body.inertia_factor, meshed));
}

/// The mesh has the ball's mass: the densities of the layers are all multiplied by one factor.
void doubt_densities(Table& ball, const Ball& body, const models::FeBall& layers) {
  constexpr double slip = 0.05;  // balls of one construction differ by less
  const double mass = layers.mass(body.radius);
  if (std::abs(mass / body.mass - 1) > slip)
    ball.doubt(
        fmt::format("its layers have {:.3g} g by their densities and radius, and the ball {:.3g} g: every density "
                    "is multiplied by {:.3g}",
                    1e3 * mass, 1e3 * body.mass, body.mass / mass));
}

/// `asked`: a finite-element model is among those of the case.
models::FeImpactOptions read_fe(Table root, const Ball& body, bool asked, PatchFriction& friction,
                                std::shared_ptr<const models::PlateOnDemand>& made) {
  models::FeImpactOptions o;
  if (auto plate = read_optional_plate(root)) {
    if (asked && root.has("motion"))
      root.table("face").fail(
          "plate",
          "a swing turns the head about the face's normal, by its dynamic lie, and a plate does not "
          "turn with it: give a lumped face (`hosel list`)");
    o.face = made = std::make_shared<const models::PlateOnDemand>(*plate);
  }
  if (auto ball = root.optional_table("ball")) {
    o.ball = read_fe_ball(*ball, o.ball);
    if (asked && !root.has("plate")) {  // the stand-in of a plate takes the factor
      check_inertia(*ball, body, o.ball);
      doubt_densities(*ball, body, o.ball);
    }
  }
  if (root.has("accuracy")) {
    o.resolve(accuracy_named(
        root.choice({"accuracy", "mesh, harmonics and steps together; keys of [mesh] and [time] override each"},
                    {"look", "default", "reference"})));
  }
  // Friction is physics: a case with a deformable ball states it.
  const std::optional<NamedContact> named = named_contact(root);
  const bool stated = named && named->face_friction;
  Table contact = stated ? root.default_table("contact") : root.table("contact");
  friction = {};
  contact.decided_by("contact.name or ball.model");
  friction.coefficient =
      contact.number({"face_friction", "Coulomb coefficient between the finite-element ball and the face"}, {0, 5},
                     stated ? named->face_friction : std::nullopt);
  if (contact.has_quantity("face_transition_speed"))
    friction.transition_speed = contact.quantity(
        {"face_transition_speed",
         "regularised friction: slip speed at which it is fully developed; absent: sticking on a spring"},
        "mps", Range::positive());
  if (contact.has("face_static_friction"))
    friction.at_rest = {
        contact.number({"face_static_friction", "coefficient at a point that has not slid yet; absent: as sliding"},
                       {0, 5}),
        contact.quantity({"face_slip_distance", "slip over which friction falls from static to sliding by 1 - 1/e"},
                         "um", Range::positive())};
  o.method = contact.choice({"method", "how ball and face are kept apart"}, names_in(fem::contact_methods()), o.method);
  if (fem::contact_method(o.method)->reaches_penetration)
    o.penetration = contact.number({"penetration", "that a time step may leave, over the ball's radius"}, {1e-9, 1e-2},
                                   o.penetration);
  o.penalty = contact.number(
      {"penalty", "contact stiffness per area, times the ball's radius over its Young's modulus"}, {1, 1e6}, o.penalty);
  o.tangential_penalty = contact.number({"tangential_penalty", "stiffness of sticking over that of contact"},
                                        {1e-3, 10}, o.tangential_penalty);

  Table mesh = root.default_table("mesh");
  read_ball_mesh(mesh, o.mesh);
  if (mesh.has("far"))
    o.mesh.far = mesh.number(
        {"far", "size of surface elements at the other pole over the ungraded ones; absent: graded by half-tangents"},
        {1, 100});
  o.mesh.core =
      mesh.number({"core", "half-width of the core block over the first layer's radius"}, {0.1, 0.7}, o.mesh.core);
  o.harmonics = int(
      mesh.integer({"harmonics", "highest Fourier harmonic over the angle about the mesh's axis"}, 0, 16, o.harmonics));
  o.antisymmetric = int(
      mesh.integer({"antisymmetric", "harmonics across the plane of the slip, where the blow has no plane of symmetry"},
                   1, 16, o.antisymmetric));
  o.angles = int(
      mesh.integer({"angles", "integration angles of the volume over the half circle; 0: 2 N + 4"}, 0, 128, o.angles));
  o.contact_angles =
      int(mesh.integer({"contact_angles", "integration angles of the patch over the half circle; 0: 3 N + 8"}, 0, 256,
                       o.contact_angles));
  o.edge_points = int(mesh.integer({"edge_points", "Gauss points along each surface edge"}, 1, 5, o.edge_points));
  if (mesh.has_quantity("tilt"))
    o.tilt = mesh.quantity(
        {"tilt", "of the mesh's axis against the turn of the ball; absent: half of the turn that is expected"}, "rad",
        {-1, 1});
  Table time = root.default_table("time");
  o.rho_inf = time.number(
      {"rho_inf", "spectral radius of generalized-alpha at infinite frequency: 1 keeps energy, 0 damps most"},
      Range::fraction(), o.rho_inf);
  read_steps(time, o);
  const std::vector<std::string> faults = o.faults();
  if (!faults.empty()) {
    // "mesh: far must be ...": at its key, where the case has it.
    std::string_view fault = faults.front();
    if (!root.has("mesh") || !fault.starts_with("mesh: ")) root.fail(root.has("mesh") ? "mesh" : "", faults.front());
    fault.remove_prefix(6);
    const std::string key(fault.substr(0, fault.find(' ')));
    mesh.fail(mesh.has(key) ? key : "", std::string(fault));
  }
  if (const auto wrong = friction.faults(); !wrong.empty()) root.fail("contact", wrong.front());
  check_memory(root, o);
  return o;
}

}  // namespace

void read_ball_mesh(Table& table, mesh::MeridianOptions& mesh) {
  table.decided_by("accuracy");
  mesh.sector =
      int(table.integer({"sector", "elements per 45 degrees of the surface before grading"}, 1, 64, mesh.sector));
  mesh.rings = int(table.integer({"rings", "rings of elements outside the core block"}, 1, 64, mesh.rings));
  mesh.pole = table.number({"pole", "size of surface elements at the contact pole over the ungraded ones"}, {0.01, 1},
                           mesh.pole);
  mesh.skin = table.number({"skin", "thickness of the outermost ring over the innermost's"}, {0.01, 1}, mesh.skin);
}

void read_steps(Table& time, models::FeImpactOptions& o) {
  time.decided_by("accuracy");
  o.steps_per_contact = int(time.integer({"steps_per_contact", "time steps in a contact of Hertz's duration"}, 10,
                                         100000, o.steps_per_contact));
  o.newton_relative = time.number({"newton_relative", "residual at which Newton stops, over the size of the forces"},
                                  {1e-14, 1e-2}, o.newton_relative);
  o.after = time.number({"after", "time computed after contact, over the contact time"}, {0, 10}, o.after);
}

models::Accuracy accuracy_named(std::string_view name) {
  return name == "look"      ? models::Accuracy::look
         : name == "default" ? models::Accuracy::standard
                             : models::Accuracy::reference;
}

void read_grip(Table& t, models::ShaftMount& mount, bool swung) {
  using models::Grip;
  mount.grip = t.one_of<Grip>(
      {"hold", "what happens at the grip during the blow"},
      {{"clamped", Grip::clamped}, {"free", Grip::free}, {"forced", Grip::forced}, {"hands", Grip::hands}}, "clamped");
  if (mount.grip == Grip::hands) mount.hands = read_springs(t, "hands'");
  if (swung) return;
  mount.elements = int(t.integer({"elements", "finite elements along the shaft"}, 2, 1000, mount.elements));
  if (t.has_quantity("force") || t.has_quantity("moment"))
    mount.load = models::GripLoad{
        .force = t.vector({"force", "that the hands apply at the grip at first contact, grip frame"}, "N"),
        .moment = t.vector({"moment", "that the hands apply at the grip at first contact, grip frame"}, "N_m")};
  if (mount.grip == Grip::forced && !mount.load)
    t.fail("hold", "the hands' wrench goes on: give its force and moment (`free`: there is none)");
}

post::RecorderOptions read_recorder(Table root) {
  post::RecorderOptions o;
  if (auto t = root.optional_table("output")) {
    o.vtk = t->flag({"vtk", "write series for ParaView"}, o.vtk);
    o.steps_per_frame =
        int(t->integer({"steps_per_frame", "time steps from one frame to the next"}, 1, 100000, o.steps_per_frame));
    o.angles = int(t->integer({"angles", "points around the ball's surface in the files"}, 8, 256, o.angles));
    if (o.angles % 2 != 0) t->fail("angles", "takes an even number");
    o.face_width = t->quantity({"face_width", "of the drawn face"}, "mm", {0.005, 0.5}, o.face_width);
    o.face_height = t->quantity({"face_height", "of the drawn face"}, "mm", {0.005, 0.5}, o.face_height);
  }
  return o;
}

models::VolumetricLaw read_volumetric_law(Table table, const std::optional<models::VolumetricLaw>& standard) {
  using Law = models::VolumetricLaw;
  const Range positive = Range::positive(), some = Range::non_negative();
  Law law;
  table.decided_by("published or contact.name or ball.model");
  law.stiffness = table.quantity({"stiffness", "volumetric stiffness: normal force per overlapping volume"}, "N_per_m3",
                                 positive, standard_of(standard, &Law::stiffness));
  law.damping = table.quantity({"damping", "of the normal force, per approach speed"}, "s_per_m", some,
                               standard_of(standard, &Law::damping));
  law.friction =
      table.number({"friction", "sliding friction coefficient"}, some, standard_of(standard, &Law::friction));
  law.static_friction = table.number({"static_friction", "coefficient at vanishing slip"}, some, law.friction);
  law.transition_speed = table.quantity({"transition_speed", "slip speed at which friction is fully developed"}, "mps",
                                        positive, standard_of(standard, &Law::transition_speed));
  law.joint_stiffness = table.quantity({"joint_stiffness", "torsional spring between core and cover"}, "N_m_per_rad",
                                       some, standard_of(standard, &Law::joint_stiffness));
  law.joint_damping = table.quantity({"joint_damping", "torsional damper between core and cover"}, "N_m_s_per_rad",
                                     some, standard_of(standard, &Law::joint_damping));
  law.cover_thickness = table.quantity({"cover_thickness", "of the cover that turns against the core"}, "mm", positive,
                                       standard_of(standard, &Law::cover_thickness));
  law.volume_exponent = table.number({"volume_exponent", "power of the overlapping volume in the normal force"},
                                     {0.5, 1.5}, standard_of(standard, &Law::volume_exponent));
  return law;
}

models::HertzMawLaw read_hertz_maw_law(Table table, const std::optional<models::HertzMawLaw>& standard) {
  using Law = models::HertzMawLaw;
  Law law;
  table.decided_by("contact.name or ball.model");
  law.modulus = table.quantity({"modulus", "Young's modulus of the ball"}, "MPa", Range::positive(),
                               standard_of(standard, &Law::modulus));
  law.poisson =
      table.number({"poisson", "Poisson's ratio of the ball"}, {0, 0.5}, standard_of(standard, &Law::poisson));
  law.friction =
      table.number({"friction", "Coulomb coefficient"}, Range::non_negative(), standard_of(standard, &Law::friction));
  law.damping = table.quantity({"damping", "of the normal force, per approach speed"}, "s_per_m", Range::non_negative(),
                               standard_of(standard, &Law::damping));
  return law;
}

models::Options read_options(Table root, const std::vector<std::string>& models, Blow& blow) {
  models::Options options;
  const auto asked = [&](std::string_view name) { return std::ranges::find(models, name) != models.end(); };
  // The set that a model uses by default is echoed with the case: nobody is to guess whose ball it was.
  const auto table = [&](std::string_view key, bool used) {
    return used ? std::optional(root.default_table(key)) : root.optional_table(key);
  };
  const bool overlap = asked("volumetric") || asked("shaft-coupled");
  // A case with finite-element tables keeps them where only its other models are asked.
  const bool fe = std::ranges::any_of(models, [](const std::string& m) { return m.starts_with("fe-"); });
  const bool there = root.has("accuracy") || root.has("mesh") ||
                     (root.has("contact") && root.table("contact").has("face_friction"));
  std::optional<NamedContact> named;
  if (overlap || asked("hertz-maw")) named = named_contact(root);
  if (there || std::ranges::any_of(models, asks_face)) blow.club.head.compliance = read_club_face(root);
  if (overlap && has_plate(root))
    root.table("face").fail(
        "plate",
        "models without a deformable ball know a lumped face alone: its constants are in the summary "
        "of a plate-face case");
  if (auto t = table("volumetric", overlap)) {
    // Nobody's constants are a default: an iron struck with a driver's is 6 mph too fast.
    std::optional<models::VolumetricLaw> standard;
    if (t->has("published"))
      standard = t->choice({"published", "which published set of parameters the defaults come from"},
                           {"driver", "iron7"}) == "iron7"
                     ? models::VolumetricLaw::published_iron7()
                     : models::VolumetricLaw::published_driver();
    else if (named && named->volume) standard = named->volume;
    else if (!overlap) standard.emplace();  // nobody asks it: its other keys are checked all the same
    else if (!t->has_quantity("stiffness"))
      t->fail("",
              "whose constants? `published = \"driver\"` or \"iron7\", all of them, or a ball or contact of the "
              "library that has them");
    options.volumetric = read_volumetric_law(*t, standard);
    options.volumetric_solution.integrator = t->one_of<models::Integrator>(
        {"integrator", "own linearly implicit method, or SUNDIALS CVODE as the reference"},
        {{"rosenbrock", models::Integrator::rosenbrock}, {"cvode", models::Integrator::cvode}}, "rosenbrock");
    options.volumetric_solution.tolerance = t->number({"tolerance", "relative tolerance of the time integration"},
                                                      {1e-12, 0.1}, options.volumetric_solution.tolerance);
  }
  if (auto t = table("hertz_maw", asked("hertz-maw"))) {
    options.hertz_maw = read_hertz_maw_law(*t, named && named->hertz_maw ? *named->hertz_maw : models::HertzMawLaw{});
    options.hertz_maw_solution.springs = static_cast<int>(
        t->integer({"springs", "springs across half the patch"}, 8, 4000, options.hertz_maw_solution.springs));
    options.hertz_maw_solution.steps = static_cast<int>(t->integer(
        {"steps", "time steps in a contact of Hertz's duration"}, 20, 20000, options.hertz_maw_solution.steps));
  }
  if (asked("shaft-coupled"))
    if (auto t = table("shaft_coupled", true)) {
      options.shaft_beam.feels_translation = t->flag({"feels_translation", "the head's motion bends the shaft"}, true);
      options.shaft_beam.feels_rotation =
          t->flag({"feels_rotation", "the head's rotation bends and twists the shaft"}, true);
    }
  if (asked("fe-full-club") || asked("shaft-coupled"))
    if (auto t = table("grip", true)) {
      read_grip(*t, options.shaft_mount, root.has("motion"));
      if (!asked("fe-full-club") && options.shaft_mount.grip != models::Grip::clamped)
        t->fail("hold",
                "shaft-coupled condenses a shaft whose butt goes on as before the blow: \"clamped\"; for the "
                "others use fe-full-club");
    }
  if (asked("fe-full-club") || asked("shaft-coupled"))
    if (auto t = root.optional_table("joint")) {
      const models::HeadJoint joint = options.shaft_mount.joint = read_head_joint(*t);
      using Joint = models::HeadJoint::Kind;
      if (joint.kind == Joint::none) t->fail("kind", "a blow needs a head on the shaft");
      if (asked("shaft-coupled") && joint.kind != Joint::rigid && !joint.hinge_across())
        t->fail("kind", "shaft-coupled knows a rigid joint and a hinge about YG; for others use fe-full-club");
      options.shaft_beam.hinged = joint.hinge_across();
    }
  if (fe || there) options.fe = read_fe(root, blow.ball, fe, blow.contact.patch, options.plate);
  if (const double head = blow.club.head.mass; options.plate && std::isfinite(head))
    if (const double plate = options.plate->design().mass(); !(plate < head))
      root.table("face").table("plate").fail(
          "thickness",
          fmt::format("the face weighs {:.3g} g and is part of a head of {:g} g", 1e3 * plate, 1e3 * head));
  return options;
}

}  // namespace hosel::app
