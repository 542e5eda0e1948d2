#include "app/version.hpp"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstring>
#include <span>
#include <stdexcept>

#include "build_info.hpp"

namespace hosel::app {
namespace {

/// The build ID among the notes of a segment: what the linker (`--build-id`) computed of all that it wrote. Empty:
/// none.
std::string build_id(std::span<const char> notes, std::size_t alignment) {
  const auto padded = [&](std::size_t size) { return (size + alignment - 1) / alignment * alignment; };
  ElfW(Nhdr) note{};
  while (notes.size() > sizeof note) {
    std::memcpy(&note, notes.data(), sizeof note);
    const std::size_t value = padded(sizeof note + note.n_namesz), end = value + padded(note.n_descsz);
    if (value + note.n_descsz > notes.size()) break;
    std::string hex;
    if (note.n_type == NT_GNU_BUILD_ID &&
        std::string_view(notes.data() + sizeof note, note.n_namesz).starts_with("GNU"))
      for (const char byte : notes.subspan(value, note.n_descsz))
        hex += fmt::format("{:02x}", static_cast<unsigned char>(byte));
    if (!hex.empty()) return hex;
    notes = notes.subspan(std::min(end, notes.size()));
  }
  return "";
}

struct Search {
  std::uintptr_t address;
  std::string found;
};

/// Of the loaded file in which the address lies: inside Python that is the module, not the interpreter.
int look(dl_phdr_info* file, std::size_t, void* data) {
  Search& search = *static_cast<Search*>(data);
  const std::span segments(file->dlpi_phdr, file->dlpi_phnum);
  bool here = false;
  for (const auto& s : segments) {
    const std::uintptr_t begin = file->dlpi_addr + s.p_vaddr;
    here = here || (s.p_type == PT_LOAD && search.address >= begin && search.address < begin + s.p_memsz);
  }
  if (!here) return 0;
  for (const auto& s : segments)
    if (s.p_type == PT_NOTE && search.found.empty()) {
      const auto* notes = reinterpret_cast<const char*>(file->dlpi_addr + s.p_vaddr);  // NOLINT: told as a number
      search.found = build_id({notes, s.p_memsz}, s.p_align < 8 ? 4 : 8);
    }
  return 1;
}

}  // namespace

std::string program_version() {
  static const std::string version = [] {
    Search search{reinterpret_cast<std::uintptr_t>(&program_version), ""};
    dl_iterate_phdr(look, &search);
    if (search.found.empty()) throw std::logic_error("this program was linked without --build-id");
    return fmt::format("{} build {}", HOSEL_VERSION, search.found);
  }();
  return version;
}

}  // namespace hosel::app
