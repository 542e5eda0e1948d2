#include "app/command_help.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/job.hpp"
#include "build_info.hpp"

namespace hosel::app {
namespace {

std::vector<const CLI::App*> commands(const CLI::App& of) {
  return of.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::Option*> options(const CLI::App& of) {
  return of.get_options([](const CLI::Option* o) { return o->get_name() != "--help"; });
}

bool takes_value(const CLI::Option& o) { return o.get_expected_max() > 0; }

/// Text that roff takes as it is.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\' || c == '-') out += '\\';
    out += c;
  }
  return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

void describe(std::string& page, const CLI::App& command, const std::string& name) {
  std::string usage = name;
  for (const CLI::Option* o : options(command))
    if (o->get_positional()) usage += " " + (o->get_required() ? o->get_name(true) : "[" + o->get_name(true) + "]");
  page += fmt::format(".SS {}\n{}\n", roff(usage), roff(command.get_description()));
  for (const CLI::Option* o : options(command))
    page +=
        fmt::format(".TP\n.B {}\n{}\n",
                    roff(o->get_name(o->get_positional()) + (o->get_positional() || !takes_value(*o) ? "" : " VALUE")),
                    roff(o->get_description()));
  for (const CLI::App* sub : commands(command)) describe(page, *sub, name + " " + sub->get_name());
}

}  // namespace

std::string shell_word(std::string_view word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                          "0123456789_-+=./,:%@") == word.npos;
  if (plain) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + '\'';
}

std::string beside_out(const std::filesystem::path& out, std::string_view word) {
  std::filesystem::path own = out.lexically_normal();
  if (!own.has_filename()) own = own.parent_path();  // a name with a slash behind it
  // The working directory and those above it have their names in the absolute path alone.
  if (own.empty() || own == "." || own.filename() == "..") own = std::filesystem::weakly_canonical(out);
  return shell_word(fmt::format("{}-{}", own.string(), word));
}

std::string typed(int argc, char** argv) {
  std::string line = "hosel";
  for (int i = 1; i < argc; ++i) line += ' ' + shell_word(argv[i]);
  return line;
}

std::string man_page(const CLI::App& command) {
  std::string page = fmt::format(R"(.TH HOSEL 1 "" "hosel {}" "hosel"
.SH NAME
hosel \- finite elements for the golf impact
.SH SYNOPSIS
.B hosel
.I COMMAND
[...]
.SH DESCRIPTION
{}
A case is a directory with a case.toml, or the name of a shipped case.
.SH COMMANDS
)",
                                 HOSEL_VERSION, roff(command.get_description()));
  for (const CLI::App* c : commands(command)) describe(page, *c, "hosel " + c->get_name());
  return page + R"(.SH EXIT STATUS
.TP
.B 0
done
.TP
.B 1
a file that cannot be written, no memory left, or an error of the program
.TP
.B 2
bad input; the message says what, where and what is allowed
.TP
.B 3
no convergence, or an impossible answer
.TP
.B 130, 143
stopped by a signal; the same command continues where it was
.SH ENVIRONMENT
.TP
.B HOSEL_DATA
the folder of large measured files
.SH FILES
.TP
.B OUT/case.resolved.toml
the case with every default filled in; runs again as it is
.TP
.B OUT/summary.json
the result; there when the run has finished
.TP
.B OUT/vtk/*.pvd
series for ParaView
)";
}

std::string bash_completion(const CLI::App& command) {
  std::string names, kinds_, branches;
  for (const Kind& kind : kinds()) kinds_ += fmt::format(" {}", kind.name);
  const auto words = [&](const CLI::App& of) {
    std::string all;
    for (const CLI::App* sub : commands(of)) all += " " + sub->get_name();
    for (const CLI::Option* o : options(of)) {
      if (!o->get_positional()) all += " " + o->get_name();
      if (o->get_name(true) == "CASE" || o->get_name() == "--from") all += " $cases";
      if (o->get_name(true) == "OF") all += kinds_;
    }
    return all.substr(std::min<std::size_t>(1, all.size()));
  };
  for (const CLI::App* c : commands(command)) {
    names += (names.empty() ? "" : " ") + c->get_name();
    branches += fmt::format("    {}) words=\"{}\" ;;\n", c->get_name(), words(*c));
    for (const CLI::App* sub : commands(*c))
      branches += fmt::format("    '{} {}') words=\"{}\" ;;\n", c->get_name(), sub->get_name(), words(*sub));
  }
  return fmt::format(R"(# hosel: completion for bash. In ~/.bashrc: source <(hosel completion)
_hosel() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} words='{}' command=${{COMP_WORDS[1]}} home cases=
  for home in {} {}; do
    [ -d "$home" ] || continue
    cases=$(cd -- "$home" >/dev/null && printf '%s ' */case.toml)
    cases=${{cases//\/case.toml/}}
    break
  done
  ((COMP_CWORD > 2)) && [ "$command" = sweep ] && command="sweep ${{COMP_WORDS[2]}}"
  ((COMP_CWORD > 1)) && case $command in
{}    *) words= ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word"; ((COMP_CWORD > 1)) && compgen -f -- "$word")
}}
complete -o filenames -F _hosel hosel
)",
                     names, shell_word(HOSEL_SOURCE_DIR "/cases"), shell_word(HOSEL_INSTALLED_CASES), branches);
}

}  // namespace hosel::app
