/// OUT/report.html: what a run tells people, on one page that needs no network.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "post/figure.hpp"
#include "post/html.hpp"
#include "post/text_table.hpp"

namespace hosel::app {

/// Filled while a job runs, written with its summary. Sections stand in the order in which they come.
class RunPage {
 public:
  /// What was found, in words: the page's first text.
  void sentence(std::string_view text);
  /// A number that the question asks for, large at the top; `note` in small type beneath.
  void answer(std::string_view what, std::string_view value, std::string_view note = {});
  /// A table beneath those numbers.
  void answer(const post::TextTable& table);
  /// HTML under a heading; under the one before where it is empty.
  void section(std::string_view heading, std::string_view html);
  /// A picture that stands in the page's own text, beside others that come with it.
  void figure(std::string_view caption, std::string svg);
  /// A blow in three dimensions, by post::json_for_viewer; hidden where a browser cannot draw it. Says so where the
  /// script that draws it is not installed, and shows nothing.
  void moving(std::string_view caption, const std::string& blow);
  /// Sliders over what app::sliders gives; nothing where that is null. Says so where the script is not installed.
  void sliders(std::string_view caption, const nlohmann::json& study);
  /// What post::draw has made: lines as they are, maps as one picture of points.
  void figure(const post::Figure& figure, const std::filesystem::path& stem);
  /// A picture beside the page.
  void link(std::string_view file);
  void doubt(std::string_view text);
  /// A line that the run has printed: the answer where the page has no other.
  void print(std::string_view line);
  /// What to try next.
  void suggest(std::string_view why, std::string_view command);

  /// The document. `resolved`: the case with every default; `command`: what was typed.
  std::string html(const std::string& resolved, const std::string& command,
                   const std::filesystem::path& directory) const;

 private:
  void close_figures();
  /// NAME.js with NAME.sha256 of post/viewer. Where it is not there: `missing` among the doubts, and false.
  bool add_script(const std::string& name, std::string_view missing);

  std::string sentences_, answers_, tables_, body_, figures_, printed_, doubts_, links_;
  std::vector<post::PageScript> scripts_;
  int moving_ = 0;
  bool sections_ = false;
  std::vector<std::pair<std::string, std::string>> next_;
};

}  // namespace hosel::app
