/// What somebody says about a result, as a case writes it: a sentence and the comparisons that bear it out.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hosel::post {

/// A named figure in the unit of its name.
struct NamedFigure {
  std::string name;
  double value;
};

/// `left < right`, with <, <=, > or >= between two terms; a term is a number, a figure's name, or `abs(name)`.
class Comparison {
 public:
  /// Throws std::invalid_argument with a sentence on anything else, and on a name that `figures` does not hold.
  Comparison(std::string_view text, const std::vector<std::string>& figures);
  bool holds(const std::vector<NamedFigure>& figures) const;

 private:
  struct Term {
    std::string name;  ///< empty: a number
    double number = 0;
    bool absolute = false;
  };
  static Term term(std::string_view text, const std::vector<std::string>& figures);
  static double value(const Term& term, const std::vector<NamedFigure>& figures);
  Term left_, right_;
  std::string relation_;
};

/// A statement and what it says: it holds where every comparison does.
struct Claim {
  std::string text;
  std::vector<Comparison> where;

  bool holds(const std::vector<NamedFigure>& figures) const;
};

}  // namespace hosel::post
