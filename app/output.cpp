#include "app/output.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>

#include "app/lock.hpp"
#include "app/terminal.hpp"
#include "golf/data_error.hpp"
#include "post/csv.hpp"
#include "post/file.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Progress::State {
  std::string what;
  bool quiet, terminal;
  Clock::time_point start = Clock::now(), shown = start;
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

namespace {

/// A log in a file that is written new: whatever had this name is untouched.
class LogSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit LogSink(const fs::path& file) : file_(file) {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    file_.append({line.data(), line.size()});
  }
  void flush_() override {}
  post::GrowingFile file_;
};

constexpr const char* kLogPattern = "%Y-%m-%d %H:%M:%S.%e %l %v";

/// `--log FILE` may replace an earlier log, or an empty file, and nothing else that a person has.
void refuse_other_than_log(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(file, error);
  if (!fs::exists(status)) return;
  if (!fs::is_regular_file(status))
    throw InputError(fmt::format("--log {}: there already, and no regular file", file.string()));
  const std::string text = post::read_file(file);
  // As kLogPattern writes it: "2024-05-06 07:08:09.012 info ...".
  constexpr std::string_view form = "dddd-dd-dd dd:dd:dd.ddd ";
  bool log = text.size() > form.size();
  for (std::size_t i = 0; log && i < form.size(); ++i)
    log = form[i] == 'd' ? std::isdigit(static_cast<unsigned char>(text[i])) != 0 : text[i] == form[i];
  if (!log && !text.empty())
    throw InputError(fmt::format("--log {}: there already, and no log of a run: it stays as it is", file.string()));
}

/// Names of what a run has written, for the run that overwrites it.
constexpr const char* kWritten = ".written";

/// What a run reads must not lie where it writes.
void refuse_inputs_below(const fs::path& out, const Inputs& inputs) {
  std::error_code error;
  const fs::path home = fs::weakly_canonical(out, error);
  for (const fs::path& file : inputs.files()) {
    const fs::path inside = fs::weakly_canonical(file, error).lexically_relative(home);
    if (!error && !inside.empty() && *inside.begin() != "..")
      throw InputError(fmt::format("{}: this run would write over what it reads ({}); name another --out", out.string(),
                                   file.string()));
  }
}

}  // namespace

struct Output::State {
  OutputOptions options;
  std::shared_ptr<const Inputs> inputs;
  std::unique_ptr<DirectoryLock> lock;
  std::unique_ptr<post::WrittenFiles> written;
  std::vector<std::string> doubts, lacks;
  bool units_matter = false;                                   // something was shown in those that were asked for
  std::map<std::string, std::string, std::less<>> file_names;  // by what they are made of
  std::string resolved, fingerprint;
  RunPage page;
  std::shared_ptr<spdlog::logger> logger;
};

Output::Output(OutputOptions options, const CaseFile& file) : state_(std::make_unique<State>()) {
  state_->options = std::move(options);
  state_->inputs = file.inputs();
  begin(file.resolved());
}

Output::Output(OutputOptions options, std::string_view resolved) : state_(std::make_unique<State>()) {
  state_->options = std::move(options);
  const auto inputs = std::make_shared<Inputs>();
  inputs->resolved(resolved);
  state_->inputs = inputs;
  begin(resolved);
}

void Output::begin(std::string_view resolved) {
  const fs::path& out = directory();
  state_->fingerprint = state_->inputs->fingerprint();
  refuse_inputs_below(out, *state_->inputs);
  if (!state_->options.log.empty()) refuse_other_than_log(state_->options.log);
  if (fs::exists(out / "summary.json") && !state_->options.force)
    throw InputError(
        fmt::format("{}: a finished run lies here; name another --out or overwrite it with --force", out.string()));
  std::error_code error;
  fs::create_directories(out, error);
  if (error) throw InputError(fmt::format("{}: cannot be made: {}", out.string(), error.message()));
  state_->lock = std::make_unique<DirectoryLock>(out);
  std::vector<spdlog::sink_ptr> sinks;
  if (!state_->options.log.empty()) sinks.push_back(std::make_shared<LogSink>(state_->options.log));
  // What tells of the run that lay here goes first: without it the rest is no finished run.
  for (const char* told : {"summary.json", "report.json", "report.html"}) fs::remove(out / told, error);
  std::set<fs::path> stay = {".lock"};
  if (state_->options.merge) stay.insert({"plan.json", "shards"});
  if (state_->options.force) post::remove_listed(out, kWritten, stay);
  state_->written = std::make_unique<post::WrittenFiles>(out, state_->options.durable ? kWritten : "");
  post::remove_unfinished(out);
  for (const auto& entry : fs::directory_iterator(out))  // pictures are drawn in folders too; shards may be at work
    if (entry.is_directory() && !entry.is_symlink() && entry.path().filename() != "shards")
      post::remove_unfinished(entry.path());
  sinks.insert(sinks.begin(), std::make_shared<LogSink>(out / "log.txt"));
  state_->logger = std::make_shared<spdlog::logger>("hosel", sinks.begin(), sinks.end());
  state_->logger->set_pattern(kLogPattern);
  state_->logger->set_error_handler([](const std::string&) {});  // a full disk is said where a result is written
  state_->resolved = resolved;
  write("case.resolved.toml", resolved);
  if (state_->options.durable)
    for (const auto& [copy, file] : state_->inputs->copies())
      post::write_file(path(copy.string()), post::read_file(file), state_->options.durable);
}

Output::~Output() = default;
const fs::path& Output::directory() const { return state_->options.directory; }

fs::path Output::path(std::string_view name) const {
  const fs::path p = directory() / name;
  fs::create_directories(p.parent_path());
  return p;
}

const std::string& Output::resolved_case() const { return state_->resolved; }

const std::string& Output::fingerprint() const { return state_->fingerprint; }

bool Output::quiet() const { return state_->options.quiet; }
std::optional<post::Units> Output::asked_units() const {
  state_->units_matter = true;
  return state_->options.units;
}
post::Units Output::units() const { return asked_units().value_or(post::Units::metric); }
post::Units Output::page_units() const {
  const bool golf = resolved_case().find("_mph") != std::string::npos;
  return asked_units().value_or(golf ? post::Units::golf : post::Units::metric);
}
bool Output::force() const { return state_->options.force; }

void Output::tell(std::string_view line) const {
  if (!quiet()) std::fputs((printable(line) + '\n').c_str(), stdout);
  std::fflush(stdout);
  log(line);
}

void Output::say(std::string_view line) {
  tell(line);
  state_->page.print(line);
}

void Output::show(const post::TextTable& table, std::string_view heading) {
  if (!quiet()) std::fputs((printable(folded(table, terminal_width())) + '\n').c_str(), stdout);
  std::fflush(stdout);
  log(table.text());
  if (heading.empty()) state_->page.answer(table);
  else state_->page.section(heading, table.html());
}

void Output::draw(const post::Figure& figure, std::string_view name, bool on_page) {
  if (!post::shows(figure)) {
    say(fmt::format("no picture: there is nothing to show in {}", path(name).string()));
    return;
  }
  if (const std::string why = post::draw(figure, path(name), on_page, directory()); !why.empty()) {
    lack(why);
    return;
  }
  if (on_page) state_->page.figure(figure, path(name));
  // Of a figure that the page does not show, or not whole, all panels are a click away.
  if (!on_page || !std::ranges::all_of(figure.panels, &post::Panel::on_page))
    state_->page.link(fmt::format("{}.png", name));
}

RunPage& Output::page() { return state_->page; }

void Output::warn(std::string_view doubt) {
  if (state_->options.strict) throw Doubted(fmt::format("--strict: {}", doubt));
  state_->doubts.emplace_back(doubt);
  state_->page.doubt(doubt);
  if (!state_->options.inner) std::fputs(("warning: " + one_line(doubt) + '\n').c_str(), stderr);
  log(fmt::format("warning: {}", doubt));
}

void Output::lack(std::string_view sentence) const {
  state_->lacks.emplace_back(sentence);
  state_->page.print(sentence);
  std::fputs(("warning: " + one_line(sentence) + '\n').c_str(), stderr);
  log(fmt::format("warning: {}", sentence));
}

void Output::log(std::string_view line) const { state_->logger->info("{}", printable(line)); }

Progress Output::progress(std::string what) const { return Progress(std::move(what), quiet()); }

void Output::write(std::string_view name, std::string_view content) const {
  if (name.ends_with(".csv")) {
    try {
      post::parse_csv(std::string(content), std::string(name));
    } catch (const DataError& e) { throw std::logic_error(fmt::format("a broken table: {}", e.what())); }
  }
  post::write_file(path(name), content, state_->options.durable);
}

std::string Output::file_name(std::string_view name) {
  if (const auto known = state_->file_names.find(name); known != state_->file_names.end()) return known->second;
  constexpr std::size_t most = 80;  // with a folder's, a suffix's and a number's room below the 255 bytes of a disk
  std::string plain;
  for (const char c : name.substr(0, most)) plain += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
  const auto taken = [&](const std::string& file) {
    return std::ranges::any_of(state_->file_names, [&](const auto& entry) { return entry.second == file; });
  };
  std::string file = plain;
  for (int k = 2; file.empty() || taken(file); ++k) file = fmt::format("{}_{}", plain, k);
  return state_->file_names.emplace(name, file).first->second;
}

void Output::write_json(std::string_view name, const nlohmann::json& content) const {
  // A path need not be UTF-8.
  write(name, content.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
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
  state_->inputs->verify();
  if (state_->options.units && !state_->units_matter)
    lack("--units changes nothing here: this kind of case shows every number in the unit of its name");
  nlohmann::json all = summary;
  if (!state_->doubts.empty()) all["doubts"] = state_->doubts;
  if (!state_->lacks.empty()) all["lacks"] = state_->lacks;
  if (state_->options.durable)
    write("report.html", state_->page.html(resolved_case(), state_->options.command, directory()));
  const auto whole = [&] {
    if (const fs::path gone = state_->written->missing(); !gone.empty())
      throw std::runtime_error(fmt::format(
          "{}: was written by this run and is gone: something else is at work in its directory", gone.string()));
    state_->lock->verify();
  };
  whole();
  if (state_->options.durable) state_->written->close_list();
  write_json("summary.json", all);
  whole();
}

void Output::skip(const fs::path& missing) {
  say(fmt::format("SKIPPED: {}", not_there(missing)));
  state_->units_matter = true;  // nothing is shown, in whatever units
  write_summary({{"skipped", missing.string()}});
}

}  // namespace hosel::app
