/// Progress messages of a running loop.
#pragma once

#include <atomic>
#include <functional>
#include <string_view>

#include "golf/parallel.hpp"

namespace hosel::loop {

/// `done` of 1 of what is being done; from any thread.
using Told = std::function<void(std::string_view what, double done)>;

/// `body(0)` to `body(n - 1)` on all cores, told as they end.
template <class Body>
void told_for(const Told& told, std::string_view what, std::size_t n, const Body& body) {
  if (told && n) told(what, 0);
  std::atomic<std::size_t> ended = 0;
  for_all(std::size_t(0), n, [&](std::size_t k) {
    body(k);
    if (const std::size_t e = ++ended; told) told(what, double(e) / double(n));
  });
}

}  // namespace hosel::loop
