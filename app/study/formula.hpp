/// Formulas over the columns and outputs of a study (muParser).
#pragma once

#include <muParser.h>

#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/reader.hpp"

namespace hosel::app {

/// What formulas call the columns and outputs of a study: the last part of a dotted key, and all of it where another's
/// ends alike; with _ for what is no letter or digit.
struct FormulaNames {
  std::vector<std::string> columns, outputs;
};
FormulaNames formula_names(const std::vector<std::string>& columns, const std::vector<std::string>& outputs);

/// A formula with its variables; unset ones are NaN.
class Formula {
 public:
  /// Throws mu::Parser::exception_type on what is no formula of `names`.
  Formula(const std::string& text, const std::vector<std::string>& names);
  void set(const std::string& name, double value);
  /// Nothing where a number that it needs is missing.
  std::optional<double> value();
  /// Whether it is true; nothing where a number that it needs is missing.
  std::optional<bool> operator()();
  bool uses(const std::string& name) const;

 private:
  mu::Parser parser_;
  std::list<std::pair<std::string, double>> values_;  // the parser holds pointers into it
  std::vector<std::string> used_;
};

/// Throws InputError at `key` of `table`, with the names that are known, where `text` is no formula of them.
void check_formula(const Table& table, std::string_view key, const std::string& text,
                   const std::vector<std::string>& names);
/// The same for a formula that is true or false: a number alone is refused.
void check_condition(const Table& table, std::string_view key, const std::string& text,
                     const std::vector<std::string>& names);

}  // namespace hosel::app
