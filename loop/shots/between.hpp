/// How far groups of shots differ: players, clubs, balls, days, stretches of the session; and what that leaves of an
/// effect.
#pragma once

#include <string>
#include <vector>

#include "loop/shots/shots.hpp"
#include "loop/shots/structure.hpp"

namespace hosel::loop {

/// The residual of `fit` over `rows`, put down to one quantity at a time: each restitution, the error of each reading.
/// A group's value is the weighted mean of its shots', its error comes from the scatter of all within their groups. The
/// variance between the groups is the one that makes the weighted square sum as large as its degrees of freedom
/// [@paule-mandel]; its interval is where the sum is a likely one [@q-profile]. Groups: values of every text column and
/// of `by` (empty: none); where `session`, stretches of fifty shots. Groups of fewer than five shots do not count.
/// Quantities that move no channel are left out.
std::vector<GroupSpread> between_groups(const ShotModel& model, const Shots& shots, const std::vector<int>& row_of,
                                        const std::vector<int>& rows, const std::string& by, bool session,
                                        const Fit& fit);

/// The effects of `fit` beyond `base`, beside errors that the shots of a group share: one random effect in each
/// whitened channel, whose variance is that between its groups, at the upper end of one standard error. Generalised
/// least squares by partial demeaning [@fuller-battese], linear about the fit. Groups: three or more values of the text
/// column, or of `by`, in which they differ most. Absent where they differ by no more than groups that are alike do in
/// one case of a hundred.
std::optional<Clustered> clustered(const ShotModel& model, const Shots& shots, const std::vector<int>& row_of,
                                   const std::vector<int>& rows, const std::string& by, const Fit& base,
                                   const Fit& fit);

}  // namespace hosel::loop
