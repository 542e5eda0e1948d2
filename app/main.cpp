// The hosel command. Exit status: 0 done, 2 bad input, 3 no convergence, 130 and 143 stopped, 1 anything else.
#include <fmt/format.h>

#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <sstream>
#include <string_view>

#include "app/cases.hpp"
#include "app/command_help.hpp"
#include "app/diff.hpp"
#include "app/import/import.hpp"
#include "app/job.hpp"
#include "app/keys.hpp"
#include "app/offer.hpp"
#include "app/paraview.hpp"
#include "app/reader.hpp"
#include "app/stop.hpp"
#include "app/sweep.hpp"
#include "app/terminal.hpp"
#include "app/version.hpp"
#include "solvers/errors.hpp"

namespace {

using namespace hosel;

struct Arguments {
  std::string command, case_dir, out, from, of, log, shard = "1/1", units;
  std::vector<std::string> sets;
  bool force = false, quiet = false, strict = false, markdown = false;
};

void run(const Arguments& a) {
  const auto where = app::find_case(a.case_dir);
  app::CaseFile file(where, a.sets);
  const auto job = app::read_job(file);
  const std::filesystem::path standard = std::filesystem::path("out") /
                                         std::filesystem::canonical(file.directory()).filename();
  const std::filesystem::path out = a.out.empty() ? standard : std::filesystem::path(a.out);
  // Whoever made the case may have made them.
  for (const std::filesystem::path& place : {standard.parent_path(), standard})
    if (a.out.empty() && std::filesystem::is_symlink(place))
      throw app::InputError(fmt::format("{}: a link; name the directory that you mean by --out", place.string()));
  app::Output output({.directory = out,
                      .force = a.force,
                      .quiet = a.quiet,
                      .log = a.log,
                      .command = a.command,
                      .units = a.units.empty()     ? std::nullopt
                               : a.units == "golf" ? std::optional(post::Units::golf)
                                                   : std::optional(post::Units::metric),
                      .strict = a.strict},
                     file);
  for (const std::string& doubt : file.inputs()->doubts()) output.warn(doubt);
  job->run(output);
}

void check(const Arguments& a) {
  app::CaseFile file(app::find_case(a.case_dir), a.sets);
  app::read_job(file);
  fmt::print("{}", file.resolved());
  // As comments, so that what is printed remains a case.
  for (const std::string& told : file.inputs()->told()) {
    std::istringstream lines(told);
    for (std::string line; std::getline(lines, line);) fmt::print("# {}\n", line);
  }
  for (const std::string& doubt : file.inputs()->doubts()) fmt::print("# in doubt: {}\n", doubt);
  for (const std::filesystem::path& data : file.inputs()->missing())
    fmt::print("# a run has SKIPPED what needs it: {}\n", app::not_there(data));
}

void keys(const Arguments& a) {
  const auto all = app::accepted_keys();
  fmt::print("{}", a.markdown ? app::keys_markdown(all) : app::keys_text(all, a.of));
}

void list() {
  for (const auto& section : app::everything()) {
    std::size_t width = 0;
    for (const auto& [name, what] : section.entries) width = std::max(width, name.size());
    fmt::print("{}\n", section.title);
    for (const auto& [name, what] : section.entries) fmt::print("  {:<{}}  {}\n", name, width, what);
  }
}

void adopt(const Arguments& a) {
  for (const std::filesystem::path& file : app::adopt(a.out, a.from, a.force)) {
    const std::string shelf = file.parent_path().filename().string();
    fmt::print("{} '{}': {}\n", shelf.substr(0, shelf.size() - 1), a.from, file.string());
  }
}

/// Before anything else of the process: OpenBLAS starts threads before main, and where they are refused memory it waits
/// for ever, or ends by a signal. No library is set up yet: the kernel's own calls alone.
void refuse_small_address_spaces() {
  constexpr rlim_t least = 250;  // MB
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur / 1'000'000 >= least)
    return;
  char number[24];
  std::size_t at = sizeof number;
  for (rlim_t n = limit.rlim_cur / 1'000'000; n || at == sizeof number; n /= 10) number[--at] = char('0' + n % 10);
  const std::string_view words[] = {"hosel: the address space is limited to ",
                                    {number + at, sizeof number - at},
                                    " MB (ulimit -v); 250 MB are the least\n"};
  for (const std::string_view w : words)
    if (::write(STDERR_FILENO, w.data(), w.size()) < 0) {}
  ::_exit(2);
}
[[gnu::section(".preinit_array"), gnu::used]] void (*before_libraries)() = refuse_small_address_spaces;

}  // namespace

int main(int argc, char** argv) {
  app::open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is an error of the write, said in words
  CLI::App cli{"hosel: what does the ball do after this blow, and how much of that is due to the shaft?"};
  cli.name("hosel");
  cli.set_version_flag("--version", [] { return "hosel " + app::program_version(); });  // not at every start
  cli.require_subcommand(1);
  Arguments a;
  a.command = app::typed(argc, argv);
  const auto add_case = [&](CLI::App* c) {
    c->add_option("CASE", a.case_dir, "case directory, case.toml, or the name of a shipped case")->required();
    c->add_option("--set", a.sets, "override a key: table.key=value (repeatable)")->expected(1)->take_all();
  };
  CLI::App* run_command = cli.add_subcommand("run", "run a case");
  add_case(run_command);
  run_command->add_option("--out", a.out, "output directory (default: out/<case>)");
  run_command->add_flag("--force", a.force, "overwrite a finished run");
  run_command->add_flag("--quiet", a.quiet, "no progress, no tables");
  run_command->add_flag("--strict", a.strict, "fail, instead of warning, where the numbers are in doubt");
  run_command
      ->add_option("--units", a.units,
                   "units of tables, of pages and of flown distances: metric (m/s, m) or golf (mph, yards)")
      ->check(CLI::IsMember({"metric", "golf"}));
  run_command->add_option("--log", a.log, "a second log file besides OUT/log.txt");
  run_command->callback([&] { run(a); });
  CLI::App* check_command = cli.add_subcommand("check", "read and validate a case, print it resolved, run nothing");
  add_case(check_command);
  check_command->callback([&] { check(a); });
  cli.add_subcommand("list", "list kinds, models, materials, balls, shafts, effects and cases")->callback(list);
  CLI::App* keys_command = cli.add_subcommand("keys", "print the keys of a case: unit, range, default, meaning");
  keys_command->add_option("OF", a.of, "a kind of case, or a table such as ball or delivery; all where absent");
  keys_command->add_flag("--markdown", a.markdown, "all of them as a page: docs/reference.md");
  keys_command->callback([&] { keys(a); });
  CLI::App* new_command = cli.add_subcommand("new", "start a case directory from another: its case.toml and data");
  new_command->add_option("DIR", a.case_dir, "the new directory")->required();
  new_command->add_option("--from", a.from, "case directory or the name of a shipped case")->required();
  new_command->callback([&] { app::copy_case(a.from, a.case_dir); });

  app::ImportOptions import;
  CLI::App* import_command =
      cli.add_subcommand("import", "make a case of the loop from the export of a launch monitor");
  import_command->add_option("FILE", import.files, "CSV or JSON as exported; several make one bag")->required();
  import_command->add_option("--out", import.out, "the new case directory")->required();
  import_command->add_option("--units", import.units, "imperial or metric, where the file states no units");
  import_command->add_option("--club", import.club,
                             "read only the shots with this club; or state the club, where the file names none");
  import_command
      ->add_option("--column", import.columns,
                   "'header=quantity_unit', by hand; '=-quantity_unit' turns its sign (repeatable)")
      ->take_all();
  import_command->add_option("--keep", import.keep, "keep this unknown column as a possible explanation (repeatable)")
      ->take_all();
  import_command->add_flag("--left-handed", import.left_handed, "the player is left-handed: mirror every shot");
  import_command->add_flag("--modelled", import.modelled, "take spin that the instrument modelled as measured");
  import_command->add_option("--dictionary", import.dictionary, "header names of your own, beside the shipped ones");
  import_command->callback([&] { app::import_shots(import); });

  CLI::App* sweep =
      cli.add_subcommand("sweep", "compute the points of a sweep or a face map in shards, on several machines");
  sweep->require_subcommand(1);
  const auto add_directory = [&](CLI::App* c) {
    c->add_option("OUT", a.out, "directory of the plan")->required();
    c->add_flag("--quiet", a.quiet, "no progress, no tables");
  };
  CLI::App* plan = sweep->add_subcommand("plan", "read the case, count its points, write OUT/plan.json");
  add_case(plan);
  plan->add_option("--out", a.out, "directory for the plan and its points")->required();
  plan->add_flag("--force", a.force, "discard an older plan and its points");
  plan->callback(
      [&] { app::sweep_plan(a.case_dir, a.sets, {.directory = a.out, .force = a.force, .quiet = a.quiet}); });
  CLI::App* shard = sweep->add_subcommand("run", "compute the missing points of one shard");
  add_directory(shard);
  shard->add_option("--shard", a.shard, "k/n: the k-th of n shares (default 1/1)");
  shard->callback([&] { app::sweep_run(a.out, app::parse_shard(a.shard), a.quiet); });
  CLI::App* merge = sweep->add_subcommand("merge", "write tables and figures from all shards");
  add_directory(merge);
  merge->add_flag("--force", a.force, "overwrite a finished merge");
  merge->callback([&] { app::sweep_merge(a.out, a.force, a.quiet); });
  CLI::App* status = sweep->add_subcommand("status", "print how many points are finished");
  add_directory(status);
  status->callback([&] { app::sweep_status(a.out); });

  CLI::App* adopt_command =
      cli.add_subcommand("adopt", "copy the result of a finished calibration or loop into your library");
  adopt_command->add_option("OUT", a.out, "directory of a run")->required();
  adopt_command->add_option("--as", a.from, "name of the entries, for cases")->required();
  adopt_command->add_flag("--force", a.force, "replace entries of this name");
  adopt_command->callback([&] { adopt(a); });
  CLI::App* diff_command =
      cli.add_subcommand("diff", "compare two finished runs: inputs, files of data and launches that differ");
  diff_command->add_option("A", a.from, "directory of a run")->required();
  diff_command->add_option("B", a.out, "directory of another")->required();
  diff_command->callback([&] { fmt::print("{}", app::difference(a.from, a.out)); });
  CLI::App* open_command = cli.add_subcommand("open", "open the series of a run in ParaView");
  open_command->add_option("OUT", a.out, "directory of a run")->required();
  open_command->callback([&] { app::open_in_paraview(a.out); });
  CLI::App* film_command = cli.add_subcommand("film", "a film of a blow, by ParaView and ffmpeg");
  film_command->add_option("OUT", a.out, "directory of a run, or of one of its models")->required();
  film_command->add_option("--to", a.from, "the film, NAME.mp4 or NAME.gif (default: OUT/film.mp4)");
  film_command->callback([&] { fmt::print("{}\n", app::film(a.out, a.from).string()); });
  cli.add_subcommand("completion",
                     "print a bash script that completes commands, options and cases: source <(hosel completion)")
      ->callback([&] { fmt::print("{}", app::bash_completion(cli)); });
  cli.add_subcommand("man", "print the manual page, as roff: hosel man | man -l -")->callback([&] {
    fmt::print("{}", app::man_page(cli));
  });

  const auto no_command = [&](const std::string& typed) -> std::string {
    std::vector<std::string> known;
    for (const CLI::App* command : cli.get_subcommands([](CLI::App*) { return true; }))
      known.push_back(command->get_name());
    return std::ranges::count(known, typed) ? ""
                                            : fmt::format("no command '{}'{}", typed, app::or_nearest(typed, known));
  };
  // `hosel help` and `hosel help COMMAND` are what people type first.
  CLI::App* help = cli.add_subcommand("help", "print this text, or that of a command");
  help->add_option("COMMAND", a.from, "a command");
  help->callback([&] {
    CLI::App* of = a.from.empty() ? &cli : nullptr;
    for (CLI::App* command : cli.get_subcommands([](CLI::App*) { return true; }))
      if (command->get_name() == a.from) of = command;
    if (!of) throw app::InputError("help: " + no_command(a.from));
    // Of itself: App::help() speaks of the command that was parsed, which is this one.
    fmt::print(
        "{}", of->get_formatter()->make_help(of, of == &cli ? "hosel" : "hosel " + a.from, CLI::AppFormatMode::Normal));
  });

  const auto ends = [](int status, std::string_view why) {
    std::fputs(("hosel: " + app::one_line(why) + '\n').c_str(), stderr);
    return status;
  };
  try {
    try {
      cli.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
      // Help and version are printed; of a mistake the sentence is ours: it may hold what was typed.
      const std::string first = argc > 1 ? argv[1] : "-", strange = first.starts_with('-') ? "" : no_command(first);
      if (e.get_exit_code() != 0) return ends(2, (strange.empty() ? std::string(e.what()) : strange) + " (hosel help)");
      cli.exit(e);
    }
    app::flush_output();
    return 0;
  } catch (const app::Stopped& e) { return ends(128 + e.signal(), e.what()); } catch (const std::bad_alloc&) {
    return ends(1, "out of memory: a coarser mesh, fewer harmonics or fewer rows need less");
  } catch (const app::InputError& e) { return ends(2, e.what()); } catch (const solvers::NonConvergence& e) {
    return ends(3, fmt::format("no convergence: {}", e.what()));
  } catch (const app::Doubted& e) { return ends(3, e.what()); } catch (const std::invalid_argument& e) {
    return ends(2, e.what());
  } catch (const std::filesystem::filesystem_error& e) {
    // A name that no disk stores is a mistake of whoever typed it.
    const bool typed = e.code() == std::errc::filename_too_long || e.code() == std::errc::too_many_symbolic_link_levels;
    return ends(typed ? 2 : 1, e.what());
  } catch (const std::exception& e) { return ends(1, e.what()); }
}
