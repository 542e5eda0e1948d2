#include "app/kinds/loop_common.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

#include "post/digits.hpp"
#include "post/labels.hpp"

namespace hosel::app {

loop::Told progress_of(const Output& out) {
  struct Work {
    std::mutex mutex;
    std::string what;
    std::unique_ptr<Progress> progress;
  };
  return [&out, work = std::make_shared<Work>()](std::string_view what, double done) {
    const std::scoped_lock lock(work->mutex);
    if (work->what != what || done == 0) {
      work->progress.reset();  // its line ends before the next begins
      work->what = what;
      work->progress.reset(new Progress(out.progress(work->what)));  // cannot be moved
    }
    work->progress->update(done);
  };
}

void read_loop_case(Table root, loop::Case& into, bool (*acts)(const loop::EffectEntry&)) {
  into.title = root.text({"title", "of tables, pages and figures"}, "");
  Table model = root.table("model");
  into.base = model.text({"base", "the model whose missing effect is sought"});
  into.effects =
      model.texts({"effects", "that the base has before any is sought (`hosel list`), with sizes from the data"},
                  std::vector<std::string>{});
  std::vector<std::string> known;
  for (const auto& e : loop::effects())
    if (acts(e)) known.emplace_back(e.name);
  for (const std::string& e : into.effects)
    if (!std::ranges::count(known, e)) model.fail("effects", fmt::format("no effect '{}'{}", e, or_nearest(e, known)));
  if (auto split = root.optional_table("split")) {
    into.split.holdout_fraction =
        split->number({"holdout_fraction", "share of the data that no fit sees"}, {0, 0.9}, 1.0 / 3.0);
    into.split.seed = static_cast<unsigned long>(split->integer({"seed", "of the split"}, 0, 1L << 53, 1));
  }
}

std::string read_split_by(Table split, const loop::Shots* shots) {
  const std::string by = split.text({"by", "column whose values stay together in training or holdout"}, "");
  if (!by.empty() && shots && !shots->find(by)) split.fail("by", fmt::format("no column '{}' in the shots", by));
  return by;
}

std::map<std::string, double> read_noise(Table table, const loop::Shots* shots, loop::Role role,
                                         std::string_view what) {
  std::map<std::string, double> noise;
  for (const std::string& key : table.keys()) {
    const loop::Column* column = shots ? shots->find(key) : nullptr;
    if (shots && (!column || column->role != role)) {
      std::vector<std::string> known;
      for (const auto& c : shots->columns)
        if (c.role == role) known.push_back(c.name);
      table.fail(key, fmt::format("no {} column of this name{}", what, or_nearest(key, known)));
    }
    noise[key] = table.number({key, "standard deviation of the column", "<column>"}, Range::non_negative());
  }
  return noise;
}

void report_loop(Output& out, const loop::LoopResult& result, const loop::Shots& table, std::string_view rows,
                 const std::function<void()>& beside) {
  out.write("residuals.csv", loop::residuals_csv(result, table));
  out.page().section("", loop::page(result, table));
  if (beside) beside();
  const nlohmann::json report = loop::to_json(result);
  out.write_json("report.json", report);
  out.say(loop::sentence(result));
  for (const loop::AdoptedSize& s : loop::adopted_sizes(result)) {
    const std::string unit = s.unit == "1" ? "" : " " + post::symbol(s.unit);
    const post::Digits digits = post::digits(s.value, s.sd);
    const std::string bound = s.at_bound ? " (at its bound)" : "";
    out.page().answer(fmt::format("{}: {}", s.effect, post::spoken(s.parameter)), digits.value + unit,
                      "± " + digits.deviation + bound);
    out.say(fmt::format("  {}: {} {} ± {}{}{}", s.effect, post::spoken(s.parameter), digits.value, digits.deviation,
                        unit, bound));
  }
  if (const std::vector<std::string> tied = loop::tied_in_after(result); !tied.empty())
    out.say(fmt::format("  after: with {}{}, which {} tied", result.adopted.empty() ? "" : "what was adopted and ",
                        fmt::join(tied, " and "), tied.size() > 1 ? "are" : "is"));
  const bool remainder = result.remainder && !result.remainder->places.empty();
  for (const auto& c : result.channels) {
    constexpr double seen = 1.01;  // less is no other number to a reader
    out.say(fmt::format(
        "  {:<22} holdout rmse {:>10.4g} -> {:>10.4g}{}   bias {:>+10.4g} -> {:>+10.4g}   noise {:.4g} ({}){}", c.name,
        c.before.holdout_rmse, c.after.holdout_rmse,
        remainder ? fmt::format(" ({:.4g} with the remainder)", c.with_remainder.holdout_rmse) : "",
        c.before.holdout_bias, c.after.holdout_bias, c.noise, c.noise_source,
        c.expected > seen * c.noise ? fmt::format(", {:.4g} with that of the inputs", c.expected) : ""));
  }
  if (const std::size_t n = result.flagged.size(); n > 0)
    out.say(fmt::format("  {} {} flagged", n, n == 1 ? rows.substr(0, rows.size() - 1) : rows));
  nlohmann::json summary;
  for (const char* key : {"verdict", "sentence", "adopted", "ties", "chosen", "channels"})
    if (report.contains(key)) summary[key] = report[key];
  out.write_summary(summary);
}

}  // namespace hosel::app
