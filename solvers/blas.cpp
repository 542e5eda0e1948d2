#include "solvers/blas.hpp"

extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace hosel::solvers {

void keep_blas_in_one_thread() {
  if (openblas_set_num_threads) openblas_set_num_threads(1);
}

}  // namespace hosel::solvers
