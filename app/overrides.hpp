/// Which keys of a case overrides set, `key=value`, and what of an earlier one a later one leaves.
#pragma once

#include <string>
#include <vector>

namespace hosel::app {

std::string key_of(const std::string& override);
/// That key and, of an inline table or a list of tables, every key in it.
std::vector<std::string> keys_of(const std::string& override);

/// The same key, or the same quantity in another unit.
bool same_quantity(const std::string& a, const std::string& b);
/// Whether this is an element of that list.
bool element_of(const std::string& key, const std::string& list);
/// Whether a key that is set later leaves nothing of an earlier one: it is the same, the list of which that is an
/// element, or the table that holds it.
bool replaces(const std::string& later, const std::string& earlier);
/// The first key of an earlier override of which a later one leaves nothing; empty where there is none.
std::string replaced(const std::string& later, const std::string& earlier);

}  // namespace hosel::app
