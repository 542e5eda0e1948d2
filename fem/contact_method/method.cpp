#include "fem/contact_method/method.hpp"

namespace hosel::fem {

double ContactMethod::next(double, double) const { return 0; }
bool ContactMethod::repeats(double, double) const { return false; }
double ContactMethod::offset(const NormalState&, const NormalState&) const { return 0; }

}  // namespace hosel::fem
