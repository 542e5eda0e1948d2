/// How a model is solved, as opposed to what it is asked: one struct for all, each model reads its own.
#pragma once

namespace hosel::models {

struct Options {};

}  // namespace hosel::models
