/// Time of the processors: for ratios on a machine with other work on it.
#pragma once

#include <ctime>

namespace hosel::bench {

/// CPU time of all threads for some work [s], the mean of `repeats`.
template <class Work>
double seconds(int repeats, const Work& work) {
  const std::clock_t start = std::clock();
  for (int i = 0; i < repeats; ++i) work();
  return double(std::clock() - start) / CLOCKS_PER_SEC / repeats;
}

}  // namespace hosel::bench
