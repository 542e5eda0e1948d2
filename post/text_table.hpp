/// A table of words and numbers, for a terminal and for a page.
#pragma once

#include <string>
#include <vector>

namespace hosel::post {

struct TextTable {
  std::vector<std::vector<std::string>> rows;  ///< the first is the heading; the first cell of each is its name
  std::size_t first_width = 18;                ///< of the first column on a terminal, at least
  std::size_t margin = 0;                      ///< behind its longest cell; 0: it has that width, whatever its cells
  std::size_t least_width = 17;                ///< of the others
  bool even = true;                            ///< the others are all as wide as the widest of them

  /// Aligned for a terminal, no line break at the end.
  std::string text() const;
  /// For a page. A table much wider than long is turned on its side.
  std::string html() const;
};

}  // namespace hosel::post
