#pragma once
// Faults of whole columns: wrong from top to bottom, or computed on most rows.

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "session.hpp"

namespace examination {

/// A slip of one or two whole columns, applied to what is recorded (shots x inputs, shots x channels).
struct ColumnSlip {
  std::string slip;                  ///< unit, sign, swapped, offset, scale, level-shift
  std::vector<std::string> columns;  ///< one, or the two that are swapped
  std::function<void(Eigen::MatrixXd& inputs, Eigen::MatrixXd& outputs)> apply;
};

/// Slips in turn by `which`; nothing where this session has no such column. A level shift may come with a column
/// that tells the equipment.
std::optional<ColumnSlip> draw_slip(Session& session, int which, Random& random);

/// Distance of a recorded session to what its base predicts, whitened, and to the nearest offset or scale of any
/// column other than that of the slip (about the recorded values). Throws std::domain_error where a blow misses.
struct SlipDistance {
  double base, other;
};
SlipDistance distance(const Session& session, const std::vector<Swing>& misread, const Eigen::MatrixXd& outputs,
                      const std::vector<Eigen::MatrixXd>& whitening, const ColumnSlip& slip);

/// Overwrites a column on a share of the rows with what other columns give, scalars or directions; the key.
std::optional<nlohmann::ordered_json> compute_mostly(Session& session, int which, Random& random);

}  // namespace examination
