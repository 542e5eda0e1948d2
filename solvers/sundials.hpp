/// What SUNDIALS hands out, freed when it goes out of scope, and the codes that its functions return.
#pragma once

#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>

#include <memory>
#include <string>
#include <type_traits>

#include "solvers/errors.hpp"

namespace hosel::solvers::sundials {

/// Its handler of errors: failures come back as codes.
inline void quiet(int, const char*, const char*, char*, void*) {}

/// Throws NonConvergence on a code below zero.
inline void check(int code, const char* what) {
  if (code < 0) throw NonConvergence(std::string(what) + " failed with code " + std::to_string(code));
}

struct FreeContext {
  void operator()(SUNContext c) const { SUNContext_Free(&c); }
};
struct FreeVector {
  void operator()(N_Vector v) const { N_VDestroy(v); }
};
struct FreeMatrix {
  void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
};
struct FreeSolver {
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
};
template <void (*free)(void**)>
struct FreeMemory {
  void operator()(void* m) const { free(&m); }
};
template <class Handle, class Deleter>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Deleter>;

// Declared in this order: each is freed before what it was made with.
using Context = Owned<SUNContext, FreeContext>;
using Vector = Owned<N_Vector, FreeVector>;
using Matrix = Owned<SUNMatrix, FreeMatrix>;
using LinearSolver = Owned<SUNLinearSolver, FreeSolver>;
template <void (*free)(void**)>
using Memory = Owned<void*, FreeMemory<free>>;

inline Context context() {
  SUNContext raw = nullptr;
  check(SUNContext_Create(nullptr, &raw), "SUNDIALS: context");
  return Context(raw);
}

}  // namespace hosel::solvers::sundials
