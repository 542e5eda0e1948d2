#include "app/stop.hpp"

#include <atomic>
#include <csignal>
#include <mutex>
#include <string>

namespace hosel::app {
namespace {

std::atomic<int> delivered = 0;                        // the signal that has come; read by every thread
static_assert(std::atomic<int>::is_always_lock_free);  // what a handler may write
std::atomic<bool> obeyed = false;                      // it has stopped a run
std::mutex guard;
int watching = 0;  // StopSignals alive: points of a sweep may have one each
struct sigaction before_int, before_term;

extern "C" void note(int number) { delivered = number; }

}  // namespace

Stopped::Stopped(int number, std::string_view then)
    : std::runtime_error(std::string("stopped by ") + (number == SIGINT ? "SIGINT; " : "SIGTERM; ") +
                         std::string(then)),
      signal_(number) {}

StopSignals::StopSignals() {
  const std::lock_guard lock(guard);
  if (watching++) return;
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &before_int);
  sigaction(SIGTERM, &action, &before_term);
}

StopSignals::~StopSignals() {
  const std::lock_guard lock(guard);
  if (--watching) return;
  sigaction(SIGINT, &before_int, nullptr);
  sigaction(SIGTERM, &before_term, nullptr);
  if (obeyed.exchange(false)) delivered = 0;  // the next run of this process is not asked to stop
}

void StopSignals::check() const {
  if (!delivered) return;
  obeyed = true;
  throw Stopped(delivered);
}

int StopSignals::too_late() {
  const std::lock_guard lock(guard);
  return watching ? 0 : delivered.exchange(0);
}

}  // namespace hosel::app
