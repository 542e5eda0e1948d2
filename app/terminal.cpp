#include "app/terminal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <utf8.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <stdexcept>

namespace hosel::app {

std::string printable(std::string_view text) {
  std::string valid, out;
  utf8::replace_invalid(text.begin(), text.end(), std::back_inserter(valid), '?');
  for (auto at = valid.begin(); at != valid.end();) {
    const auto begin = at;
    const char32_t c = utf8::next(at, valid.end());
    const bool control = (c < 0x20 && c != '\n') || (c >= 0x7f && c < 0xa0);
    // Line and paragraph separators, and what reverses the direction of a line.
    const bool moves = c == 0x2028 || c == 0x2029 || (c >= 0x202a && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
    if (control || moves) out += ' ';
    else out.append(begin, at);
  }
  return out;
}

std::string one_line(std::string_view text) {
  std::string line = printable(text);
  for (char& c : line)
    if (c == '\n') c = ' ';
  constexpr std::size_t most = 1000, end = 200;
  if (line.size() <= most) return line;
  const auto boundary = [&](std::size_t at) {  // not inside a character
    while (at > 0 && (static_cast<unsigned char>(line[at]) & 0xc0) == 0x80) --at;
    return at;
  };
  return line.substr(0, boundary(most - end)) + " [...] " + line.substr(boundary(line.size() - end));
}

namespace {

/// Characters, not their bytes.
std::size_t characters(std::string_view text) {
  return std::size_t(std::ranges::count_if(text, [](unsigned char c) { return (c & 0xc0) != 0x80; }));
}

std::size_t widest_line(std::string_view text) {
  std::size_t most = 0;
  for (std::size_t at = 0; at <= text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    most = std::max(most, characters(text.substr(at, end - at)));
    at = end + 1;
  }
  return most;
}

/// The heading in several rows, as far as its words are what makes a column wide.
post::TextTable with_broken_heading(const post::TextTable& table) {
  std::vector<std::vector<std::string>> heads;  // of each column, the lines
  std::size_t most = 1;
  for (std::size_t c = 0; c < table.rows.front().size(); ++c) {
    std::size_t width = table.least_width > 2 ? table.least_width - 2 : 0;
    for (std::size_t r = 1; r < table.rows.size(); ++r)
      if (c < table.rows[r].size()) width = std::max(width, characters(table.rows[r][c]));
    std::vector<std::string> lines = {""};
    std::string_view left = table.rows.front()[c];
    while (c > 0 && !left.empty()) {
      const auto end = std::min(left.find(' '), left.size());
      const std::string_view word = left.substr(0, end);
      if (!lines.back().empty() && characters(lines.back()) + 1 + characters(word) > width) lines.emplace_back();
      lines.back().append(lines.back().empty() ? "" : " ").append(word);
      left.remove_prefix(std::min(end + 1, left.size()));
    }
    if (c == 0) lines.back() = left;
    most = std::max(most, lines.size());
    heads.push_back(std::move(lines));
  }
  post::TextTable out = table;
  out.rows.front().assign(heads.size(), "");
  out.rows.insert(out.rows.begin(), most - 1, out.rows.front());
  for (std::size_t c = 0; c < heads.size(); ++c)  // the last line stands above the numbers
    for (std::size_t k = 0; k < heads[c].size(); ++k) out.rows[most - heads[c].size() + k][c] = heads[c][k];
  return out;
}

}  // namespace

std::string folded(const post::TextTable& table, std::size_t width) {
  const auto columns = [](const post::TextTable& of, std::size_t from, std::size_t to) {
    post::TextTable part = of;
    for (auto& row : part.rows) {
      row.erase(row.begin() + long(std::min(to, row.size())), row.end());
      if (!row.empty()) row.erase(row.begin() + 1, row.begin() + long(std::clamp(from, std::size_t(1), row.size())));
    }
    const auto says_nothing = [](const auto& row) { return std::ranges::all_of(row, &std::string::empty); };
    while (!part.rows.empty() && says_nothing(part.rows.front()))
      part.rows.erase(part.rows.begin());  // of longer heads
    return part.text();
  };
  std::string whole = table.text();
  if (width == 0 || widest_line(whole) <= width || widest_line(columns(table, 1, 1)) > width / 2) return whole;
  const post::TextTable broken = with_broken_heading(table);
  std::size_t all = 0;
  for (const auto& row : broken.rows) all = std::max(all, row.size());
  std::string out;
  for (std::size_t from = 1; from < all;) {
    std::size_t to = from + 1;
    while (to < all && widest_line(columns(broken, from, to + 1)) <= width) ++to;
    out += (out.empty() ? "" : "\n\n") + columns(broken, from, to);
    from = to;
  }
  return out;
}

std::size_t terminal_width() {
  winsize size{};
  const bool known = ::isatty(STDOUT_FILENO) && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0;
  return known ? size.ws_col : 0;
}

void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
      if (const int opened = ::open("/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY);
          opened >= 0 && opened != stream) {
        ::dup2(opened, stream);
        ::close(opened);
      }
}

void flush_output() {
  const bool failed = std::fflush(stdout) != 0;
  if (failed || std::ferror(stdout))
    throw std::runtime_error(fmt::format("what was printed could not be written{}",
                                         failed ? fmt::format(": {}", std::strerror(errno)) : std::string()));
}

}  // namespace hosel::app
