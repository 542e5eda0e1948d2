/// What kinds that map the face read alike.
#pragma once

#include <string>
#include <vector>

#include "app/reader.hpp"
#include "post/claim.hpp"
#include "post/face_map.hpp"

namespace hosel::app {

/// `[grid]`; the published 75 x 37.5 mm with 15 x 9 points where it is absent.
post::FaceGrid read_face_grid(Table root);
/// `[[statements]]`, each a text and comparisons of `figures`.
std::vector<post::Claim> read_statements(Table root, const std::vector<std::string>& figures);

}  // namespace hosel::app
