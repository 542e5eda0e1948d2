/// Files that are whole or not there, whatever is killed and whatever disk is full.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>

namespace hosel::post {

/// Replaces FILE: written new beside it, renamed when complete. What stood in FILE is never opened: another name of it
/// (a hard link) keeps what it had, a pipe is waited for by nobody. `durable` waits for the disk before the rename, so
/// that not even a loss of power leaves half a file. Throws std::runtime_error with the system's reason; what stood in
/// FILE is then untouched.
void write_file(const std::filesystem::path& file, std::string_view bytes, bool durable = true);

/// A file that grows while it is written: begun as write_file does, then kept open.
class GrowingFile {
 public:
  explicit GrowingFile(const std::filesystem::path& file, std::string_view beginning = {}, bool durable = false);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;
  /// At once on disk, so that a killed run keeps it. Throws as write_file; then nothing of `bytes` is in the file.
  void append(std::string_view bytes);
  int descriptor() const { return descriptor_; }

 private:
  std::filesystem::path file_;
  int descriptor_;
};

/// The whole of FILE. Throws std::runtime_error where it cannot be read or is no regular file: a pipe may never end.
std::string read_file(const std::filesystem::path& file);

/// The absolute path of a program in the folders that PATH names absolutely, none of them in OUTSIDE: a program that
/// lies among the files of a run is somebody's data. Empty where there is none.
std::filesystem::path find_program(std::string_view name, const std::filesystem::path& outside = {});

/// Watches the files that write_file and GrowingFile leave below DIRECTORY, in this process, as long as it lives. Where
/// one watch lies in another's directory, the inner one misses a file that is gone. Both list it, unless the inner one
/// has no list: its files are thrown away.
class WrittenFiles {
 public:
  /// `list`: the names of the files are kept in DIRECTORY/list from then on, a name a line, after those that are there.
  explicit WrittenFiles(const std::filesystem::path& directory, const std::string& list = {});
  ~WrittenFiles();
  WrittenFiles(const WrittenFiles&) = delete;
  WrittenFiles& operator=(const WrittenFiles&) = delete;
  /// The first that is gone, though nobody here removed it; empty where all are there.
  std::filesystem::path missing() const;
  /// The list once more, sorted and without what is not there now: a run that was killed ends with the list of one that
  /// was not.
  void close_list();

 private:
  std::string directory_;
  std::filesystem::path list_;
};

/// Removes the files that DIRECTORY/list names below DIRECTORY, folders that are empty then, and the list. Files and
/// folders of DIRECTORY that are named in `stay` stay, in the list too.
void remove_listed(const std::filesystem::path& directory, const std::string& list,
                   const std::set<std::filesystem::path>& stay = {});

/// Puts a file that another program has made in the place of TO, as write_file does with its own.
void move_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// Removes a file that this process has written, and is not to miss.
void remove_file(const std::filesystem::path& file);

/// What a killed process left of files it was writing in DIRECTORY. To be called by whoever holds it alone.
void remove_unfinished(const std::filesystem::path& directory);

/// A new folder in DIRECTORY, gone with its content when this dies; after a kill, by remove_unfinished.
class WorkFolder {
 public:
  explicit WorkFolder(const std::filesystem::path& directory);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Name-based UUID (SHA-1) of a text: tells damage and change, keeps no secret.
std::string digest(std::string_view text);

}  // namespace hosel::post
