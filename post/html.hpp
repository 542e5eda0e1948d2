/// A self-contained page for people: the style sheet inline, nothing fetched.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hosel::post {

/// Text as it may stand between tags and inside an attribute.
std::string escape_html(const std::string& text);

/// A picture (svg, png) as the address of an image, so that the page needs no other file.
std::string data_uri(const std::filesystem::path& picture);

/// The whole document around a body, for a light and a dark screen and for paper. Classes: `verdict` with `good`,
/// `open` or `bad`; `answers`, `figures`, `inputs`, `scroll`, `key`, `wide`; `l` sets a cell left; `command` of a
/// `pre`; `moving` and `sliders` of figures that a script draws; `curves` of a picture that may be inverted in the
/// dark; those of the pictures in svg. The page's policy lets nothing be fetched, and no other script run than
/// `scripts`, at its end.
struct PageScript {
  std::string text, checksum;  ///< checksum: base64 of the text's SHA-256
};
std::string html_page(const std::string& title, const std::string& body, const std::vector<PageScript>& scripts = {});

}  // namespace hosel::post
