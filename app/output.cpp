#include "hosel/app/output.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>

#include "hosel/app/lock.hpp"
#include "hosel/app/reader.hpp"
#include "hosel/post/file.hpp"
#include "hosel/solvers/errors.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Progress::State {
  std::string what;
  bool quiet, terminal;
  Clock::time_point start = Clock::now(), shown = start;
  double shown_done = 0;
  bool open = true;
  std::mutex mutex;
};

Progress::Progress(std::string what, bool quiet) : state_(std::make_unique<State>()) {
  state_->what = std::move(what);
  state_->quiet = quiet;
  state_->terminal = isatty(STDERR_FILENO);
}

Progress::~Progress() {
  if (state_ && state_->open && state_->terminal && !state_->quiet) std::fputs("\n", stderr);
}

namespace {
std::string clock_text(double seconds) {
  const long s = std::lround(seconds);
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}
}  // namespace

void Progress::update(double done, std::string_view note) {
  State& s = *state_;
  const std::lock_guard lock(s.mutex);
  if (s.quiet || !s.open) return;
  const auto now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - s.start).count();
  const double since = std::chrono::duration<double>(now - s.shown).count();
  const std::string left = done > 1e-3 ? clock_text(elapsed * (1 - done) / done) + " to go" : "";
  if (s.terminal) {
    if (since < 0.1) return;
    constexpr int width = 30;
    const int filled = std::clamp(int(done * width), 0, width);
    fmt::print(stderr, "\r{:<24} [{}{}] {:3.0f} %  {:<14} {:<24}", s.what, std::string(std::size_t(filled), '='),
               std::string(std::size_t(width - filled), ' '), 100 * done, left, note);
  } else {
    // Plain lines: at most one every ten seconds, so that a log stays readable.
    if (since < 10) return;
    fmt::print(stderr, "{}: {:.0f} %, {} {}\n", s.what, 100 * done, left, note);
  }
  std::fflush(stderr);
  s.shown = now;
  s.shown_done = done;
}

void Progress::finish(std::string_view note) {
  State& s = *state_;
  const std::lock_guard lock(s.mutex);
  if (!s.open) return;
  s.open = false;
  if (s.quiet) return;
  const double elapsed = std::chrono::duration<double>(Clock::now() - s.start).count();
  fmt::print(stderr, "{}{:<24} done in {:.1f} s {:<52}\n", s.terminal ? "\r" : "", s.what, elapsed, note);
  std::fflush(stderr);
}

struct Output::State {
  OutputOptions options;
  std::unique_ptr<DirectoryLock> lock;
  std::vector<std::string> doubts;
  std::string resolved;
  RunPage page;
  std::shared_ptr<spdlog::logger> logger;
};

Output::Output(OutputOptions options, std::string_view resolved) : state_(std::make_unique<State>()) {
  state_->options = std::move(options);
  const fs::path& out = directory();
  if (fs::exists(out / "summary.json") && !state_->options.force)
    throw InputError(
        fmt::format("{}: a finished run lies here; name another --out or overwrite it with --force", out.string()));
  std::error_code error;
  fs::create_directories(out, error);
  if (error) throw InputError(fmt::format("{}: cannot be made: {}", out.string(), error.message()));
  state_->lock = std::make_unique<DirectoryLock>(out);
  post::remove_unfinished(out);
  // What told of the run that lay here would stand beside this one's unfinished files.
  for (const char* told : {"summary.json", "report.json", "report.html"}) fs::remove(out / told, error);
  const auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>((out / "log.txt").string(), true);
  std::vector<spdlog::sink_ptr> sinks{sink};
  if (!state_->options.log.empty())
    sinks.push_back(std::make_shared<spdlog::sinks::basic_file_sink_mt>(state_->options.log.string(), true));
  state_->logger = std::make_shared<spdlog::logger>("hosel", sinks.begin(), sinks.end());
  state_->logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
  state_->logger->flush_on(spdlog::level::info);
  state_->resolved = resolved;
  write("case.resolved.toml", resolved);
}

Output::~Output() = default;
const fs::path& Output::directory() const { return state_->options.directory; }

fs::path Output::path(std::string_view name) const {
  const fs::path p = directory() / name;
  fs::create_directories(p.parent_path());
  return p;
}

const std::string& Output::resolved_case() const { return state_->resolved; }

bool Output::quiet() const { return state_->options.quiet; }
std::optional<post::Units> Output::asked_units() const { return state_->options.units; }
post::Units Output::units() const { return state_->options.units.value_or(post::Units::metric); }
post::Units Output::page_units() const {
  const bool golf = resolved_case().find("_mph") != std::string::npos;
  return state_->options.units.value_or(golf ? post::Units::golf : post::Units::metric);
}
bool Output::force() const { return state_->options.force; }

void Output::tell(std::string_view line) {
  if (!quiet()) fmt::print("{}\n", line);
  std::fflush(stdout);
  log(line);
}

void Output::say(std::string_view line) {
  tell(line);
  state_->page.print(line);
}

void Output::show(const post::TextTable& table, std::string_view heading) {
  tell(table.text());
  if (heading.empty()) state_->page.answer(table);
  else state_->page.section(heading, table.html());
}

void Output::draw(const post::Figure& figure, std::string_view name, bool on_page) {
  if (const std::string why = post::draw(figure, path(name), on_page); !why.empty()) say(why);
  else if (on_page) state_->page.figure(figure, path(name));
  else state_->page.link(fmt::format("{}.png", name));
}

RunPage& Output::page() { return state_->page; }

void Output::warn(std::string_view doubt) {
  if (state_->options.strict) throw solvers::NonConvergence(fmt::format("--strict: {}", doubt));
  state_->doubts.emplace_back(doubt);
  state_->page.doubt(doubt);
  if (!quiet()) fmt::print(stderr, "warning: {}\n", doubt);
  log(fmt::format("warning: {}", doubt));
}

void Output::log(std::string_view line) { state_->logger->info("{}", line); }

Progress Output::progress(std::string what) const { return Progress(std::move(what), quiet()); }

void Output::write(std::string_view name, std::string_view content) const {
  post::write_file(path(name), content, state_->options.durable);
}

void Output::write_json(std::string_view name, const nlohmann::json& content) const {
  write(name, content.dump(1) + "\n");
}

namespace {

/// Where a number is not finite: JSON would silently hold null. Empty where all are.
std::string not_finite(const nlohmann::json& j, const std::string& name) {
  if (j.is_number_float() && !std::isfinite(j.get<double>())) return name;
  if (!j.is_structured()) return {};
  for (const auto& [key, value] : j.items())
    if (std::string found = not_finite(value, name.empty() ? key : name + "." + key); !found.empty()) return found;
  return {};
}

}  // namespace

void Output::write_summary(const nlohmann::json& summary) const {
  if (const std::string name = not_finite(summary, ""); !name.empty())
    throw solvers::NonConvergence(fmt::format("'{}' of the result is not finite: no summary.json is written", name));
  nlohmann::json all = summary;
  if (!state_->doubts.empty()) all["doubts"] = state_->doubts;
  if (state_->options.durable)
    write("report.html", state_->page.html(resolved_case(), state_->options.command, directory()));
  write_json("summary.json", all);
}

void Output::skip(const fs::path& missing) {
  say(fmt::format("SKIPPED: {} is not there; HOSEL_DATA names the folder of measured files", missing.string()));
  write_summary({{"skipped", missing.string()}});
}

}  // namespace hosel::app
