// One reader under libFuzzer: HOSEL_READER names it. Built and run by scripts/deep-check.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "readers.hpp"

namespace {

const hosel::fuzz::Reader* wanted() {
  const char* name = std::getenv("HOSEL_READER");
  for (const hosel::fuzz::Reader& r : hosel::fuzz::kReaders)
    if (name && std::strcmp(r.name, name) == 0) return &r;
  return nullptr;
}

}  // namespace

/// The corpus, the last of the arguments, begins with a good file.
extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  const std::filesystem::path corpus = (*arguments)[*count - 1];
  const hosel::fuzz::Reader* r = wanted();
  if (!r || !std::filesystem::is_directory(corpus)) {
    std::fputs("HOSEL_READER=NAME fuzz_reader [options] CORPUS\n", stderr);
    std::exit(2);
  }
  if (r->good) hosel::post::write_file(corpus / "good", r->good(), false);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const hosel::fuzz::Reader& r = *wanted();
  r.read({reinterpret_cast<const char*>(data), size});
  return 0;
}
