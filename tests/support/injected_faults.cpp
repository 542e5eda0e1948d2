// Faults of disk and clock. Loaded before the command by LD_PRELOAD, chosen by its environment:
//   FAULT_QUOTA=N    bytes that regular files get from this process; what is more is refused as by a disk quota
//   FAULT_FSYNC=skip fsync succeeds and writes nothing to the disk
//   FAULT_CLOCK=S    every reading of the clock is S seconds before the one before
//   FAULT_LOG=FILE   gets a letter for every fault that happened: Q, F, C
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <ctime>

namespace {

void happened(char what) {
  static const char* file = std::getenv("FAULT_LOG");
  if (!file) return;
  const int to = open(file, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
  if (to < 0) return;
  syscall(SYS_write, to, &what, std::size_t(1));
  close(to);
}

/// Seconds by which the clock is set back now.
long set_back() {
  static const char* each = std::getenv("FAULT_CLOCK");
  static std::atomic<long> readings = 0;
  if (!each) return 0;
  if (readings++ == 1) happened('C');
  return readings * std::atol(each);
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, std::size_t count) {
  static const char* quota = std::getenv("FAULT_QUOTA");
  static std::atomic<long> left = quota ? std::atol(quota) : 0;
  struct stat is {};
  if (quota && fstat(file, &is) == 0 && S_ISREG(is.st_mode)) {
    // As much as there is room for, and then nothing.
    const long room = left.load();
    if (room <= 0) {
      happened('Q');
      errno = EDQUOT;
      return -1;
    }
    if (long(count) > room) count = std::size_t(room);
    left -= long(count);
  }
  return syscall(SYS_write, file, bytes, count);
}

int fsync(int file) {
  static const char* how = std::getenv("FAULT_FSYNC");
  if (!how) return int(syscall(SYS_fsync, file));
  happened('F');
  return 0;
}

int clock_gettime(clockid_t clock, timespec* to) noexcept {
  const int status = int(syscall(SYS_clock_gettime, clock, to));
  if (status == 0 && clock == CLOCK_REALTIME) to->tv_sec -= set_back();
  return status;
}

time_t time(time_t* to) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (to) *to = now.tv_sec;
  return now.tv_sec;
}

}  // extern "C"
