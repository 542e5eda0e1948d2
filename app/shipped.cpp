#include "app/shipped.hpp"

#include "build_info.hpp"

namespace hosel::app {
namespace fs = std::filesystem;

fs::path shipped(const fs::path& in_checkout, const fs::path& installed) {
  const fs::path own = fs::path(HOSEL_SOURCE_DIR) / in_checkout;
  return fs::exists(own) ? own : fs::path(HOSEL_INSTALLED_CASES).parent_path() / installed;
}

}  // namespace hosel::app
