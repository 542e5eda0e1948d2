/// Numbers that stand where nothing was measured: codes, zeros, nines.
#pragma once

#include <string>
#include <vector>

#include "app/import/reading.hpp"

namespace hosel::app {

/// What some programs write where nothing was measured.
bool no_reading(double value);

/// The cells whose value no reading can have, and which fill a field or stand several times among readings.
std::vector<bool> find_placeholders(const MonitorQuantity& q, const Row& raw, const std::string& unit, bool comma);

/// The cells that no instrument can have measured, among others that mostly are readings.
std::vector<bool> find_impossible(const MonitorQuantity& q, const Row& raw, const std::string& unit, bool comma);

/// In the row of a value that stands for nothing the same value stands for nothing in other columns, too, where it
/// might be a reading.
void leave_out_placeholders(Reading& r);

/// Zeros of the club beside no speed of it, of the axis beside no spin, and through a whole column.
void leave_out_zeros(Reading& r);

}  // namespace hosel::app
