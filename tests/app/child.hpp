/// A command that runs beside the test: waited for until something is there, ended by a signal.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <string>
#include <thread>

namespace hosel::test {

class Child {
 public:
  /// Starts a line of the shell; what it prints goes nowhere. `first` is done in the child before.
  explicit Child(const std::string& line, const std::function<void()>& first = {}) : id_(fork()) {
    if (id_ != 0) return;
    if (first) first();
    execl("/bin/sh", "sh", "-c", ("exec " + line + " >/dev/null 2>&1").c_str(), nullptr);
    _exit(127);
  }
  ~Child() {
    if (!ended_) end(SIGKILL);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t id() const { return id_; }
  bool ended() { return ended_ = ended_ || waitpid(id_, &status_, WNOHANG) == id_; }
  /// Waits for what the child does; false where it ended without.
  bool until(const std::function<bool()>& there) {
    while (!there()) {
      if (ended()) return there();
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return true;
  }
  /// Sent to a child that has not ended; returns how it ended, as waitpid tells it.
  int end(int number) {
    if (!ended()) kill(id_, number);
    return wait();
  }
  int wait() {
    if (!ended_) waitpid(id_, &status_, 0);
    ended_ = true;
    return status_;
  }
  /// Stops it where it is; false where it had ended. A signal that is sent then is its next act, after `go_on`.
  bool hold() {
    if (ended() || kill(id_, SIGSTOP) != 0) return false;
    int how = 0;
    if (waitpid(id_, &how, WUNTRACED) == id_ && WIFSTOPPED(how)) return true;
    status_ = how;
    ended_ = true;
    return false;
  }
  void go_on() { kill(id_, SIGCONT); }

 private:
  pid_t id_;
  int status_ = 0;
  bool ended_ = false;
};

}  // namespace hosel::test
