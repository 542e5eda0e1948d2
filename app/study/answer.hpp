/// What one model says of one blow of a study, and the one table of quantities that are read of it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/library.hpp"
#include "app/read_flight.hpp"
#include "app/read_swing.hpp"
#include "app/reader.hpp"
#include "golf/blow.hpp"
#include "golf/face_compliance.hpp"
#include "models/calibration/ball_calibration.hpp"
#include "models/club/hosel_load.hpp"
#include "models/fe/elastic_plate.hpp"
#include "models/options.hpp"

namespace hosel::app {

/// A blow as the tables of a study say it. Without `models`, where [launch] says all of the launch, nothing is struck:
/// one model without a name "answers" with it.
struct StudyBlow {
  std::vector<std::string> models;
  Blow blow;
  models::Options options;
  std::optional<StatedLaunch> launch;  ///< in place of what a model says
  std::optional<FlightSetup> flight;
  std::optional<models::ElasticSolid> plate;         ///< the wall, where it is not rigid
  std::optional<SwungClub> swung;                    ///< where a swing delivers the club
  std::shared_ptr<const models::SwingEnd> end = {};  ///< of that, once it was swung: `blow` begins there
  /// The club's own face, where it is asked for and none of the models reads it: the blow does not have it.
  std::optional<FaceCompliance> face = {};
  std::shared_ptr<const models::PlateOnDemand> face_plate = {};
  std::optional<LoftSets> sets = {};  ///< of the ball, where the loft chooses one of several
};
/// `of_face`: an output asks for the club's own face.
StudyBlow read_study_blow(Table root, bool of_face = false);
/// Whether an output is what face and head make of a strike of their own, whichever model answers.
bool asks_for_the_face(const std::string& output);

/// Conditions under which variants of a club or ball are compared.
struct StudyConditions {
  bool matched_launch = false;         ///< the loft is an unknown: the launch angle is the measured one
  std::optional<double> bounce_speed;  ///< moduli are scaled until the ball bounces as the first blow's does [m/s]
  bool histories = false;              ///< forces over time are kept: of the contact, of finite elements at the hosel
  bool followed = false;               ///< what an output needs of every step of a finite-element blow is kept
};

/// At one instant of a blow.
struct ForceSample {
  double time, normal, tangential;  ///< [s], [N], [N] along the slip of ball on face at first contact
};

struct KeptBounce {
  double restitution, contact_time;  ///< on a rigid wall, before the moduli were scaled
  double elastic = 1, viscous = 1;   ///< factors on the moduli
};

/// What a blow doubts of its own answer. Those of one kind are told together, with the worst of them.
struct PointDoubt {
  std::string kind;
  double size;
  std::string sentence;
};

struct StudyAnswer {
  Blow blow;
  std::optional<FaceCompliance> face;
  std::shared_ptr<const models::PlateOnDemand> face_plate;  ///< a face with a thickness
  Launch launch;
  std::optional<post::ShotFlight> flight;
  std::optional<KeptBounce> bounce;
  std::vector<ForceSample> history;
  models::HoselHistory hosel;                   ///< of a finite-element club
  std::shared_ptr<const models::SwingEnd> end;  ///< of the swing that delivered it
  std::optional<double> face_stress;  ///< largest von Mises stress of a face with a thickness, where it was kept [Pa]
  std::vector<PointDoubt> doubts;
};

/// A quantity by its name and unit, as a study asks for it: "ball_speed_mph", "launch_ratio".
struct StudyOutput {
  std::string name;
  double si = 1;
  std::function<std::optional<double>(const StudyAnswer&)> value;  ///< SI; nothing where the answer does not have it
  bool cause = false;     ///< of the contact itself: may explain why a launch differs
  bool followed = false;  ///< is there where StudyConditions::followed asks for it
};
/// Throws InputError at `key` of `table`, with the nearest name, where nothing is called so, of the launch and the
/// flight alone where nothing is `struck`.
StudyOutput find_study_output(const Table& table, std::string_view key, const std::string& name, bool flies,
                              bool struck = true);

/// The axial bounce on a rigid wall, of the ball and numerics of a blow.
models::NormalImpactPoint wall_bounce(const StudyBlow& blow, double speed);

/// What the model answers. `launch_angle`: the measured one, where it has to be met [rad]. `reference`: the bounce that
/// is to be kept. Throws what the model throws.
StudyAnswer answer(const std::string& model, const StudyBlow& asked, const StudyConditions& conditions,
                   const std::optional<double>& launch_angle, const models::NormalImpactPoint* reference);

}  // namespace hosel::app
