#include "post/history.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "post/csv.hpp"

namespace hosel::post {
namespace {

/// Header and the first `rows` lines, and their digest, each line's taken over that of the lines before.
struct Beginning {
  std::string text, digest;
  long rows = -1;
};

Beginning beginning(const std::filesystem::path& file, long rows) {
  Beginning b;
  if (!std::filesystem::is_regular_file(file)) return b;
  const std::string all = read_file(file);
  for (std::size_t at = 0, end; b.rows < rows && (end = all.find('\n', at)) != all.npos; at = end + 1, ++b.rows) {
    const std::string line = all.substr(at, end + 1 - at);
    b.text += line;
    b.digest = digest(b.digest + line);
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
  std::vector<std::string> cells;
  for (const std::string& name : columns) cells.push_back(csv_cell(name));
  std::string beginning_of = fmt::format("{}\n", fmt::join(cells, ","));
  mark_ = {0, digest(beginning_of)};
  if (kept) {
    Beginning b = beginning(file, kept->rows);
    if (b.digest != kept->digest) throw std::runtime_error(fmt::format("{}: is not what it was", file_));
    beginning_of = std::move(b.text);
    mark_ = *kept;
  }
  out_ = std::make_unique<GrowingFile>(file, beginning_of);
}

void History::write(std::span<const double> values) {
  if (values.size() != columns_)
    throw std::invalid_argument(fmt::format("{}: {} values for {} columns", file_, values.size(), columns_));
  const std::string line = fmt::format("{:.9g}\n", fmt::join(values, ","));
  out_->append(line);
  ++mark_.rows;
  mark_.digest = digest(mark_.digest + line);
}

}  // namespace hosel::post
