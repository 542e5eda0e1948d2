/// A self-contained page for people: the style sheet inline, nothing fetched.
#pragma once

#include <string>

namespace hosel::post {

/// `<`, `>` and `&` as a page writes them.
std::string escape_html(const std::string& text);

/// The whole document around a body. Classes: `verdict` with `good`, `open` or `bad`; `figures`, `scroll`, `key`; `l`
/// sets a cell left; those of the pictures in svg.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace hosel::post
