#include "models/shaft_impedance.hpp"
