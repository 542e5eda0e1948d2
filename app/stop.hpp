/// A run that is asked to stop (SIGINT, SIGTERM) ends between two steps, with its checkpoint on disk.
#pragma once

#include <stdexcept>
#include <string_view>

namespace hosel::app {

/// Thrown where a run stops because it was asked to; the program ends with 128 + signal.
class Stopped : public std::runtime_error {
 public:
  explicit Stopped(int number, std::string_view then = "the same command goes on from where it was");
  int signal() const { return signal_; }

 private:
  int signal_;
};

/// While one of these lives, the signals are noted and not obeyed at once; a second one ends the program on the spot.
/// Work that leaves nothing to go on from needs none: it is ended by the signal itself.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  /// Throws Stopped where a signal has come. From any thread.
  void check() const;
  /// After a run: the signal that came after its last check, forgotten by this; 0 where none did, or a run is at work.
  static int too_late();
};

}  // namespace hosel::app
