#include "app/check_memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace hosel::app {
namespace {

thread_local int at_a_time = 1;

int cores() { return tbb::this_task_arena::max_concurrency(); }

}  // namespace

BlowsBeside::BlowsBeside() : before_(at_a_time) { at_a_time = cores(); }
BlowsBeside::~BlowsBeside() { at_a_time = before_; }

double memory_of(const models::FeImpactOptions& fe) {
  // The core block, the rings, and one more for each interface that no ring's boundary is near.
  const double sector = fe.mesh.sector, rings = fe.mesh.rings + double(fe.ball.layers.size()) - 1;
  const double elements = 2 * sector * sector + 4 * sector * rings;
  const double across = std::min(fe.antisymmetric, fe.harmonics);
  const double of_a_node = fe.harmonics == 0 ? 2 : 3.0 * (fe.harmonics + across) + 3;
  const double matrix = 8 * of_a_node * 8 * of_a_node * sizeof(double);
  return 40e6 + 8 * elements * matrix;  // the program itself, then what was measured
}

double address_limit() {
  rlimit limit{};
  return ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY ? double(limit.rlim_cur) : INFINITY;
}

void check_memory(const Table& root, const models::FeImpactOptions& fe) {
  const double one = memory_of(fe), wanted = at_a_time * one,
               present = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  if (wanted > present)
    root.fail("mesh",
              fmt::format("the solution would take some {:.0f} GB{}, this machine has {:.0f} GB: fewer sectors, "
                          "rings or harmonics",
                          1e-9 * wanted, at_a_time > 1 ? fmt::format(" ({} blows at a time)", at_a_time) : "",
                          1e-9 * present));
  // The libraries and what OpenBLAS reserves for each thread: without it, its threads wait for memory for ever.
  const double addresses = 500e6 + 100e6 * cores() + wanted;
  if (address_limit() < addresses)
    throw InputError(
        fmt::format("the address space of this process is limited to {:.0f} MB (ulimit -v): a "
                    "finite-element blow wants {:.0f} MB",
                    1e-6 * address_limit(), 1e-6 * addresses));
}

}  // namespace hosel::app
