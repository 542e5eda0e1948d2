// The energy balance closes: what was there and what came from outside is what is listed below.
#include <gtest/gtest.h>

#include <cstdlib>

#include "post/energy_table.hpp"

namespace hosel::post {
namespace {

solvers::Ledger some() {
  solvers::Ledger l{.kinetic = 200, .strain = {{"ball", 3}, {"shaft", 4}}, .contact = 0.5, .friction = 6};
  l.viscous = 7, l.numerical = 0.25, l.external = 10.75, l.initial = 210;
  l.closure = l.initial + l.external - 200 - 7 - 0.5 - 6 - 7 - 0.25;
  return l;
}

double after_less_before(const TextTable& t) {
  double sum = 0;
  for (std::size_t r = 1; r < t.rows.size(); ++r) sum += (r < 3 ? -1 : 1) * std::atof(t.rows[r][1].c_str());
  return sum;
}

TEST(EnergyTable, OfABlowCloses) {
  const TextTable t = energy_table({{"fe-full-club", some()}}, EnergyOf::blow);
  EXPECT_EQ(t.rows[0][1], "fe-full-club");
  EXPECT_EQ(t.rows[2][1], "10.7500") << "of hands, gravity and grip";
  EXPECT_NEAR(after_less_before(t), 0, 1e-9);
}

TEST(EnergyTable, OfASwingHasNoContact) {
  solvers::Ledger l = some();
  l.initial -= l.contact + l.friction, l.contact = l.friction = 0, l.numerical = -1e-6;
  const TextTable t = energy_table({{"swing", l}}, EnergyOf::swing);
  EXPECT_EQ(t.rows.size(), energy_table({{"swing", l}}, EnergyOf::blow).rows.size() - 2);
  EXPECT_EQ(t.rows[t.rows.size() - 2][1], "0.0000") << "no sign";
}

}  // namespace
}  // namespace hosel::post
