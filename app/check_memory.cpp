#include "hosel/app/check_memory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

namespace hosel::app {

double memory_of(const models::FeImpactOptions& fe) {
  // The core block, the rings, and one more for each interface that no ring's boundary is near.
  const double sector = fe.mesh.sector, rings = fe.mesh.rings + double(fe.ball.layers.size()) - 1;
  const double elements = 2 * sector * sector + 4 * sector * rings;
  const double across = std::min(fe.antisymmetric, fe.harmonics);
  const double of_a_node = fe.harmonics == 0 ? 2 : 3.0 * (fe.harmonics + across) + 3;
  const double matrix = 8 * of_a_node * 8 * of_a_node * sizeof(double);
  return 40e6 + 8 * elements * matrix;  // the program itself, then what was measured
}

void check_memory(const Table& root, const models::FeImpactOptions& fe) {
  const double wanted = memory_of(fe), present = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  if (wanted > present)
    root.fail("mesh", fmt::format("the solution would take some {:.0f} GB, this machine has {:.0f} GB: fewer sectors, "
                                  "rings or harmonics",
                                  1e-9 * wanted, 1e-9 * present));
}

}  // namespace hosel::app
