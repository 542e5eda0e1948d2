#include "post/claim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace hosel::post {
namespace {

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && s.front() == ' ') s.remove_prefix(1);
  while (!s.empty() && s.back() == ' ') s.remove_suffix(1);
  return s;
}

}  // namespace

Comparison::Term Comparison::term(std::string_view text, const std::vector<std::string>& figures) {
  Term t;
  text = trimmed(text);
  if (text.starts_with("abs(") && text.ends_with(")")) {
    t.absolute = true;
    text = trimmed(text.substr(4, text.size() - 5));
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), t.number);
  if (!text.empty() && error == std::errc() && end == text.data() + text.size()) return t;
  if (std::ranges::find(figures, text) == figures.end())
    throw std::invalid_argument(fmt::format("no figure '{}' (known: {})", text, fmt::join(figures, ", ")));
  t.name = text;
  return t;
}

Comparison::Comparison(std::string_view text, const std::vector<std::string>& figures) {
  const std::size_t at = text.find_first_of("<>");
  if (at == std::string_view::npos)
    throw std::invalid_argument(fmt::format("'{}': expected a comparison with <, <=, > or >=", text));
  relation_ = text.substr(at, at + 1 < text.size() && text[at + 1] == '=' ? 2 : 1);
  left_ = term(text.substr(0, at), figures);
  right_ = term(text.substr(at + relation_.size()), figures);
}

double Comparison::value(const Term& t, const std::vector<NamedFigure>& figures) {
  const double x = t.name.empty() ? t.number : std::ranges::find(figures, t.name, &NamedFigure::name)->value;
  return t.absolute ? std::abs(x) : x;
}

bool Comparison::holds(const std::vector<NamedFigure>& figures) const {
  const double a = value(left_, figures), b = value(right_, figures);
  if (relation_ == "<") return a < b;
  if (relation_ == "<=") return a <= b;
  return relation_ == ">" ? a > b : a >= b;
}

bool Claim::holds(const std::vector<NamedFigure>& figures) const {
  return std::ranges::all_of(where, [&](const Comparison& c) { return c.holds(figures); });
}

}  // namespace hosel::post
