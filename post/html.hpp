/// A self-contained page for people: the style sheet inline, nothing fetched.
#pragma once

#include <string>

namespace hosel::post {

/// Text as it may stand between tags and inside an attribute.
std::string escape_html(const std::string& text);

/// The whole document around a body. Classes: `verdict` with `good`, `open` or `bad`; `figures`, `scroll`, `key`; `l`
/// sets a cell left; those of the pictures in svg.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace hosel::post
