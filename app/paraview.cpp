#include "app/paraview.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "app/command_help.hpp"
#include "app/parse_toml.hpp"
#include "app/reader.hpp"
#include "app/resolved.hpp"
#include "app/shipped.hpp"
#include "app/stop.hpp"
#include "post/file.hpp"

namespace hosel::app {

namespace fs = std::filesystem;

namespace {

/// Runs a program in a folder to its end, or until this one is asked to stop; what it prints goes to a file there.
void run_program(const fs::path& program, std::vector<std::string> words, const fs::path& folder,
                 const StopSignals& stop) {
  const fs::path printed = folder / "printed";
  words.insert(words.begin(), program.string());
  std::vector<char*> argv;
  for (std::string& w : words) argv.push_back(w.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "printed", O_WRONLY | O_CREAT | O_APPEND, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  // It and what it begins are a group of processes, which can be asked to stop as one.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t child = 0, ended = 0;
  const int refused = posix_spawn(&child, program.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  int status = 0;
  while (!refused && (ended = waitpid(child, &status, WNOHANG)) == 0) {
    try {
      stop.check();
    } catch (const Stopped& s) {
      kill(-child, SIGTERM);
      waitpid(child, &status, 0);
      throw Stopped(s.signal(), "no film was made");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (!refused && ended == child && WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  std::string said = fs::exists(printed) ? post::read_file(printed) : "";
  while (said.ends_with('\n')) said.pop_back();
  throw std::runtime_error(fmt::format("the film could not be made: {} ended with an error: {}", program.string(),
                                       said.substr(said.rfind('\n') + 1)));
}

fs::path needed(const char* name, const char* package, const fs::path& outside) {
  const fs::path program = post::find_program(name, outside);
  if (program.empty())
    throw InputError(fmt::format("film: {} is not installed (Debian: apt-get install {})", name, package));
  return program;
}

/// Of the folders of several models that of the last which the case names: it answers the case.
fs::path answering(const fs::path& out, const std::vector<fs::path>& folders) {
  const fs::path file = out / kResolvedCase;
  if (folders.size() > 1 && fs::is_regular_file(file)) {
    const toml::table resolved = parse_toml(post::read_file(file), file.string());
    const toml::array* models = resolved["models"].as_array();
    for (std::size_t k = models ? models->size() : 0; k-- > 0;)
      for (const fs::path& folder : folders)
        if (folder.parent_path().filename() == (*models)[k].value_or(std::string())) return folder;
  }
  return folders.back();
}

}  // namespace

void open_in_paraview(const fs::path& out) {
  if (!fs::is_directory(out)) throw InputError(fmt::format("{}: no such directory", out.string()));
  std::vector<std::string> folders;
  for (const auto& entry : fs::recursive_directory_iterator(out))
    if (entry.path().extension() == ".pvd" &&
        std::ranges::find(folders, entry.path().parent_path().string()) == folders.end())
      folders.push_back(entry.path().parent_path().string());
  std::ranges::sort(folders);
  if (folders.empty())
    throw InputError(fmt::format("{}: no series for ParaView (vtk/*.pvd) in this run", out.string()));
  const fs::path program = post::find_program("paraview", out);
  if (program.empty()) throw InputError("ParaView is not installed (Debian: apt-get install paraview)");
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) {
    // Each kind of run has a script that draws without a screen, by the series that it is about.
    struct Script {
      const char *series, *name;
    };
    constexpr Script scripts[] = {{"ball.pvd", "impact"}, {"face.pvd", "face"}, {"shaft.pvd", "swing"}};
    for (const Script& script : scripts) {
      const auto found =
          std::ranges::find_if(folders, [&](const auto& f) { return fs::exists(fs::path(f) / script.series); });
      if (found != folders.end())
        throw InputError(
            fmt::format("there is no screen here; without one: scripts/pvbatch post/paraview/{0}.py {1} {0}.png",
                        script.name, shell_word(*found)));
    }
    throw InputError("there is no screen here; the figures beside report.html need none");
  }
  fmt::print("{}\n", fmt::join(folders, "\n"));
  std::fflush(stdout);
  setenv("HOSEL_VTK", fmt::format("{}", fmt::join(folders, "\n")).c_str(), 1);
  const std::string argument = "--script=" + shipped("post/paraview/open.py", "paraview/open.py").string();
  execl(program.c_str(), program.c_str(), argument.c_str(), static_cast<char*>(nullptr));
  throw std::runtime_error("ParaView could not be started");
}

fs::path film(const fs::path& out, const fs::path& file) {
  if (!fs::is_directory(out)) throw InputError(fmt::format("{}: no such directory", out.string()));
  const fs::path to = file.empty() ? out / "film.mp4" : file;
  const bool gif = to.extension() == ".gif";
  if (!gif && to.extension() != ".mp4") throw InputError(fmt::format("{}: a film is an .mp4 or a .gif", to.string()));
  if (fs::exists(fs::symlink_status(to))) throw InputError(fmt::format("{}: exists; name another film", to.string()));
  const fs::path place = to.parent_path().empty() ? fs::path(".") : to.parent_path();
  if (!fs::is_directory(place)) throw InputError(fmt::format("{}: no such directory", place.string()));
  std::vector<fs::path> folders;
  for (const auto& entry : fs::recursive_directory_iterator(out))
    if (entry.path().filename() == "ball.pvd") folders.push_back(entry.path().parent_path());
  if (folders.empty())
    throw InputError(fmt::format("{}: no series of a blow (vtk/ball.pvd) in this run", out.string()));
  std::ranges::sort(folders);
  const fs::path filmed = answering(out, folders);
  needed("pvbatch", "paraview", out);
  needed("xvfb-run", "xvfb xauth", out);
  const fs::path ffmpeg = needed("ffmpeg", "ffmpeg", out);

  const StopSignals stop;
  const post::WorkFolder work(place);
  run_program(shipped("scripts/pvbatch", "scripts/pvbatch"),
              {shipped("post/paraview/film.py", "paraview/film.py").string(), fs::absolute(filmed).string(), "."},
              work.path(), stop);
  const std::string made = gif ? "film.gif" : "film.mp4";
  std::vector<std::string> words = {"-nostdin",        "-loglevel", "error",   "-framerate",
                                    gif ? "12" : "15", "-i",        "%04d.png"};
  const std::vector<std::string> form =
      gif ? std::vector<std::string>{"-vf", "scale=640:-1,split[a][b];[a]palettegen[p];[b][p]paletteuse"}
          : std::vector<std::string>{"-c:v", "libx264", "-pix_fmt", "yuv420p", "-movflags", "+faststart"};
  words.insert(words.end(), form.begin(), form.end());
  words.push_back(made);
  run_program(ffmpeg, words, work.path(), stop);
  post::move_file(work.path() / made, to);
  return to;
}

}  // namespace hosel::app
