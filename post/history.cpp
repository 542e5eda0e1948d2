#include "hosel/post/history.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

namespace hosel::post {

namespace {

/// Whole lines of an earlier run whose first value does not exceed `end`.
std::string lines_until(const std::filesystem::path& file, double end) {
  std::ifstream in(file);
  std::string kept, line;
  std::getline(in, line);  // the header
  while (std::getline(in, line) && !in.eof() && std::strtod(line.c_str(), nullptr) <= end) kept += line + "\n";
  return kept;
}

}  // namespace

History::History(const std::filesystem::path& file, const std::vector<std::string>& columns, double resume_after)
    : file_(file.string()), columns_(columns.size()) {
  const std::string kept = resume_after >= 0 ? lines_until(file, resume_after * (1 + 1e-8)) : "";
  out_.open(file);
  out_ << fmt::format("{}\n", fmt::join(columns, ",")) << kept << std::flush;
  if (!out_) throw std::runtime_error(fmt::format("{}: cannot be written", file_));
}

void History::write(std::span<const double> values) {
  if (values.size() != columns_)
    throw std::invalid_argument(fmt::format("{}: {} values for {} columns", file_, values.size(), columns_));
  out_ << fmt::format("{:.9g}", fmt::join(values, ",")) << std::endl;  // flushed: a killed run keeps it
  if (!out_) throw std::runtime_error(fmt::format("{}: cannot be written", file_));
}

}  // namespace hosel::post
