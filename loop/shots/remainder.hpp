/// The remainder: per channel a Gaussian process of the residual over the inputs, the session and the unknown columns.
#pragma once

#include "loop/shots/structure.hpp"

namespace hosel::loop {

/// Of the residuals of a fit on the training rows `rows`. Lengths and noise by the marginal likelihood
/// (`solvers::Kriging::noisy`), of long sets of some rows, evenly spread, whose process then goes through all
/// (`solvers::Kriging::through`; of more than 5,000 rows, through so many). A channel has one where the rows in five
/// parts of whole groups (`group` per shot of the model), each foretold by the other parts alone, are nearer to what
/// was measured: in squared noise units by more than chance brings. Values that stand far off are drawn in, inputs kept
/// inside the range of the training rows. Absent where the rows are too few.
std::optional<Remainder> remainder(const ShotModel& model, const Shots& shots, const std::vector<int>& row_of,
                                   const std::vector<int>& rows, const std::vector<int>& group, const Fit& fit);

}  // namespace hosel::loop
