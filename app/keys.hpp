/// The keys of a case, as the reader declares them: what `hosel keys` prints and docs/reference.md holds.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "app/reader.hpp"

namespace hosel::app {

/// One key of one table. Where declarations differ from case to case (a default that depends on a model), each of the
/// sets below has more than one entry.
struct AcceptedKey {
  std::string table;  ///< dotted, `[]` behind a list of tables; empty: the top of the file
  std::string name;   ///< with its unit
  std::string meaning;
  std::set<std::string> kinds;       ///< of the shipped cases that read it
  std::set<std::string> types;       ///< "number", "one of a, b"
  std::set<std::string> ranges;      ///< "0.01 to 5 kg"; empty where a number says nothing more
  std::set<std::string> standards;   ///< defaults; empty: the key is required
  std::set<std::string> decided_by;  ///< keys that decide default or range, where these differ from case to case
  bool required = false;             ///< in some case, without a default
  bool optional = false;             ///< read in some case only where it is there
};

/// The shipped cases, then variants of them that say what none of them says, each as far as it could be read: among
/// them every declaration of the reader is met. Throws InputError where a shipped one cannot be read.
std::vector<CaseFile> cases_with_every_key();
/// Every key that the reader accepts, in the order in which it asks: what it declares while it reads the above.
std::vector<AcceptedKey> accepted_keys();

/// As text for a terminal; of one kind or one table alone where `of` names it. Throws InputError with the nearest name.
std::string keys_text(const std::vector<AcceptedKey>& keys, std::string_view of);
/// What stands for defaults that differ from case to case where no declaration says by which key.
inline constexpr std::string_view kUndecided = "NOT SAID";
/// docs/reference.md.
std::string keys_markdown(const std::vector<AcceptedKey>& keys);

}  // namespace hosel::app
