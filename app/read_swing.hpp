/// A swing from a case's tables: the grip's motion from a file, the club, how it is solved.
#pragma once

#include <filesystem>

#include "app/reader.hpp"
#include "models/club/grip_motion.hpp"
#include "models/club/mounted_shaft.hpp"
#include "models/club/swing_end.hpp"

namespace hosel::app {

/// `[motion]`: `file`, smoothing, span. `present` is false where the (large, measured) file is not there.
struct MotionInput {
  std::filesystem::path file;
  bool present = true;
  models::GripTrack track;
  double smoothing = 0, begin = 0, end = 0;  ///< [s]
};
/// Positions `grip_x_*`, `grip_y_*`, `grip_z_*` with either Y-X-Z Euler angles `grip_a_*`, `grip_b_*`,
/// `grip_c_*` or two axes `grip_ex_x` ... `grip_ey_z`. Throws InputError: time backwards, gaps, gimbal lock,
/// axes that are not orthonormal, cells that are not numbers.
MotionInput read_motion(Table table);

/// Springs and dampers of the hands or of a joint, `whose`, along and about the grip's axes: `stiffness`,
/// `rotational_stiffness` and (0) `damping`, `rotational_damping`, three each.
fem::JointStiffness read_springs(Table& table, std::string_view whose);

/// `[grip]` of a swing: `drive = "prescribed"` (the motion itself), `"hands"` (springs to it) or `"forced"` by a
/// `wrench` file with the columns that a swing's own `swing.csv` has.
struct GripInput {
  models::GripDrive::Kind kind = models::GripDrive::Kind::prescribed;
  fem::JointStiffness hands;
  std::filesystem::path wrench;
};
GripInput read_grip_drive(Table root);
/// The drive of a swing along `motion`. A wrench is given in the axes of that motion. Throws InputError where the
/// file does not cover the motion's span.
models::GripDrive make_drive(const GripInput& grip, const MotionInput& span, fem::Motion motion);

/// `[joint]`: how the head hangs on the shaft.
models::HeadJoint read_head_joint(Table& table);

/// `[solution]` and `[joint]` of a swing.
models::SwingOptions read_swing_options(Table root);

/// A blow at the end of a swing: `[motion]`, `[solution]` and `[joint]` stand for the delivery.
struct SwungClub {
  /// The shaft of a whole club at first contact.
  enum class Start {
    straight,    ///< moving with the head as one rigid body
    swing,       ///< bent, stressed and moving as the swing leaves it
    weightless,  ///< likewise, of the same swing without gravity
    hands,       ///< bent as the hands' wrench, gravity and the club's rigid acceleration demand
  };
  MotionInput motion;
  models::SwingOptions options;
  Start start = Start::straight;

  /// Throws what models::swing_end throws. The shaft is that of `start`.
  models::SwingEnd swing(const Club& club) const;
  /// Delivery, club and loaded shaft at the end of the swing; the place on the face stays the blow's.
  void begin(const models::SwingEnd& end, Blow& blow, models::ShaftMount& mount) const;
};
/// Nothing where the case has no `[motion]`. The mount takes mesh, grip point and joint of the swing.
std::optional<SwungClub> read_swung_club(Table root, const std::vector<std::string>& models, models::ShaftMount& mount);

}  // namespace hosel::app
