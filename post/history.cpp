#include "post/history.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace hosel::post {

History::History(const std::filesystem::path& file, const std::vector<std::string>& columns)
    : out_(file), file_(file.string()), columns_(columns.size()) {
  out_ << fmt::format("{}", fmt::join(columns, ",")) << std::endl;
  if (!out_) throw std::runtime_error(fmt::format("{}: cannot be written", file_));
}

void History::write(std::span<const double> values) {
  if (values.size() != columns_)
    throw std::invalid_argument(fmt::format("{}: {} values for {} columns", file_, values.size(), columns_));
  out_ << fmt::format("{:.9g}", fmt::join(values, ",")) << std::endl;  // flushed: a killed run keeps it
  if (!out_) throw std::runtime_error(fmt::format("{}: cannot be written", file_));
}

}  // namespace hosel::post
