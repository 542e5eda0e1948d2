/// The linear algebra below CHOLMOD, UMFPACK and Ceres.
#pragma once

namespace hosel::solvers {

/// From here on the BLAS works in the threads that call it and opens none of its own: on matrices as small as ours they
/// cost more than they bring, and they divide sums by the number of cores, so that the last digits of an answer would
/// depend on the machine. Does nothing where the BLAS is not OpenBLAS. From any thread.
void keep_blas_in_one_thread();

/// For a process whose BLAS is not ours alone: when the last of these dies, it has the threads that it had before the
/// first. From any thread.
class BlasThreads {
 public:
  BlasThreads();
  ~BlasThreads();
  BlasThreads(const BlasThreads&) = delete;
  BlasThreads& operator=(const BlasThreads&) = delete;
};

}  // namespace hosel::solvers
