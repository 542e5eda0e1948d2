// One reader under libFuzzer: HOSEL_READER names it. Built and run by scripts/deep-check.
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "readers.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const char* wanted = std::getenv("HOSEL_READER");
  for (const hosel::fuzz::Reader& r : hosel::fuzz::kReaders)
    if (wanted && std::strcmp(r.name, wanted) == 0) r.read({reinterpret_cast<const char*>(data), size});
  return 0;
}
