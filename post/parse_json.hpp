/// JSON and CBOR that somebody else may have written: refused where they nest deeper than a stack is deep.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace hosel::post {

/// Throws nlohmann::json::exception where the text is broken, std::length_error where more than a hundred lists and
/// objects stand in one another.
nlohmann::json parse_json(std::string_view text);

/// The same of CBOR (RFC 8949).
nlohmann::json parse_cbor(std::string_view bytes);

}  // namespace hosel::post
