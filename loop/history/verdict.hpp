/// From a selection on records to what is said of it.
#pragma once

#include "hosel/loop/history/study.hpp"

namespace hosel::loop {

/// Completes `study.result`. The holdout is read here, once.
void conclude(HistoryStudy& study);

}  // namespace hosel::loop
