#pragma once

#include <stdexcept>

namespace hosel {

/// Data that cannot be used at all: one line a person can act on, `file:line: what is wrong`.
class DataError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hosel
