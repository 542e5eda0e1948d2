#include "solvers/blas.hpp"

#include <mutex>

extern "C" void openblas_set_num_threads(int) __attribute__((weak));
extern "C" int openblas_get_num_threads() __attribute__((weak));

namespace hosel::solvers {

void keep_blas_in_one_thread() {
  if (openblas_set_num_threads) openblas_set_num_threads(1);
}

namespace {

std::mutex blas_guard;
int blas_users = 0, blas_threads = 1;

}  // namespace

BlasThreads::BlasThreads() {
  const std::lock_guard lock(blas_guard);
  if (!blas_users++ && openblas_get_num_threads) blas_threads = openblas_get_num_threads();
}

BlasThreads::~BlasThreads() {
  const std::lock_guard lock(blas_guard);
  if (!--blas_users && openblas_set_num_threads) openblas_set_num_threads(blas_threads);
}

}  // namespace hosel::solvers
