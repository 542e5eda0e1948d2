#include "hosel/post/history.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "hosel/post/file.hpp"

namespace hosel::post {
namespace {

/// Header and the first `rows` lines, and their digest, each line's taken over that of the lines before.
struct Beginning {
  std::string text, digest;
  long rows = -1;
};

Beginning beginning(const std::filesystem::path& file, long rows) {
  Beginning b;
  std::ifstream in(file);
  for (std::string line; b.rows < rows && std::getline(in, line) && !in.eof(); ++b.rows) {
    b.text += line + "\n";
    b.digest = digest(b.digest + line + "\n");
  }
  return b;
}

}  // namespace

bool History::holds(const std::filesystem::path& file, const Mark& mark) {
  const Beginning b = beginning(file, mark.rows);
  return b.rows == mark.rows && b.digest == mark.digest;
}

History::History(const std::filesystem::path& file, const std::vector<std::string>& columns, const Mark* kept)
    : file_(file.string()), columns_(columns.size()) {
  const std::string header = fmt::format("{}\n", fmt::join(columns, ","));
  if (kept) {
    const Beginning b = beginning(file, kept->rows);
    if (b.digest != kept->digest) throw std::runtime_error(fmt::format("{}: is not what it was", file_));
    write_file(file, b.text);
    mark_ = *kept;
  } else {
    write_file(file, header);
    mark_ = {0, digest(header)};
  }
  out_.open(file, std::ios::app);
  if (!out_) throw std::runtime_error(fmt::format("{}: cannot be written", file_));
}

void History::write(std::span<const double> values) {
  if (values.size() != columns_)
    throw std::invalid_argument(fmt::format("{}: {} values for {} columns", file_, values.size(), columns_));
  const std::string line = fmt::format("{:.9g}\n", fmt::join(values, ","));
  out_ << line << std::flush;  // a killed run keeps it
  if (!out_) throw std::runtime_error(fmt::format("{}: cannot be written", file_));
  ++mark_.rows;
  mark_.digest = digest(mark_.digest + line);
}

}  // namespace hosel::post
