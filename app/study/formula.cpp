#include "app/study/formula.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace hosel::app {

std::string formula_name(const std::string& name) {
  std::string entry = name.ends_with(".value") ? name.substr(0, name.size() - 6) : name;
  std::string out = entry.substr(entry.rfind('.') + 1);
  for (char& c : out)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  if (!out.empty() && std::isdigit(static_cast<unsigned char>(out.front()))) out = "_" + out;
  return out;
}

Formula::Formula(const std::string& text, const std::vector<std::string>& names) {
  parser_.DefineNameChars("0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
  for (const std::string& name : names) parser_.DefineVar(name, &values_.emplace_back(name, 1.0).second);
  parser_.SetExpr(text);
  for (const auto& [name, value] : parser_.GetUsedVar()) used_.push_back(name);
  parser_.Eval();
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

}  // namespace hosel::app
