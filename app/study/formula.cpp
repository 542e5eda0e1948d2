#include "app/study/formula.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

namespace hosel::app {

namespace {

std::string as_variable(std::string key) {
  for (char& c : key)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  if (!key.empty() && std::isdigit(static_cast<unsigned char>(key.front()))) key = "_" + key;
  return key;
}

bool assigns(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') ++i;
    else if (i == 0 || std::string_view("<>!").find(text[i - 1]) == std::string_view::npos) return true;
  }
  return false;
}

std::string whole_key(const std::string& name) {
  return name.ends_with(".value") ? name.substr(0, name.size() - 6) : name;
}

std::string last_part(const std::string& name) {
  const std::string whole = whole_key(name);
  return as_variable(whole.substr(whole.rfind('.') + 1));
}

}  // namespace

FormulaNames formula_names(const std::vector<std::string>& columns, const std::vector<std::string>& outputs) {
  std::map<std::string, std::set<std::string>> ends;
  for (const auto* names : {&columns, &outputs})
    for (const std::string& n : *names) ends[last_part(n)].insert(whole_key(n));
  FormulaNames out;
  const auto called = [&](const std::string& n) {
    return ends[last_part(n)].size() > 1 ? as_variable(whole_key(n)) : last_part(n);
  };
  for (const std::string& c : columns) out.columns.push_back(called(c));
  for (const std::string& o : outputs) out.outputs.push_back(called(o));
  return out;
}

Formula::Formula(const std::string& text, const std::vector<std::string>& names) {
  parser_.DefineNameChars("0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
  for (const std::string& name : names) parser_.DefineVar(name, &values_.emplace_back(name, 1.0).second);
  parser_.SetExpr(text);
  for (const auto& [name, value] : parser_.GetUsedVar()) used_.push_back(name);
  if (assigns(text)) throw mu::Parser::exception_type("one `=` assigns: equality is `==`");
  parser_.Eval();  // names and grammar first: the other does not look at them
  int results = 0;
  parser_.Eval(results);
  if (results != 1) throw mu::Parser::exception_type("a comma separates two formulas: decimals have a point");
  for (auto& [name, x] : values_) x = NAN;
}

void Formula::set(const std::string& name, double value) {
  for (auto& [own, x] : values_)
    if (own == name) x = value;
}

std::optional<double> Formula::value() {
  for (const auto& [name, x] : values_)
    if (uses(name) && !std::isfinite(x)) return {};
  return parser_.Eval();
}

std::optional<bool> Formula::operator()() {
  const auto x = value();
  return x ? std::optional(*x != 0) : std::nullopt;
}

bool Formula::uses(const std::string& name) const { return std::ranges::find(used_, name) != used_.end(); }

void check_formula(const Table& table, std::string_view key, const std::string& text,
                   const std::vector<std::string>& names) {
  try {
    Formula(text, names);
  } catch (const mu::Parser::exception_type& e) {
    std::string known;
    for (const std::string& n : names)
      if (n.find('.') == std::string::npos) known += (known.empty() ? "" : ", ") + n;
    table.fail(key, fmt::format("{} (known: {})", e.GetMsg(), known));
  }
}

void check_condition(const Table& table, std::string_view key, const std::string& text,
                     const std::vector<std::string>& names) {
  check_formula(table, key, text, names);
  for (const char* compares : {"<", ">", "==", "!=", "&&", "||"})
    if (text.find(compares) != text.npos) return;
  table.fail(
      key, fmt::format("'{}' is a number, and neither true nor false: compare it, with <, <=, ==, !=, >= or >", text));
}

}  // namespace hosel::app
