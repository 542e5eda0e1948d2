#include "app/terminal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <utf8.h>

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
