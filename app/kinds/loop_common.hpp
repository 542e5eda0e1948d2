/// What every loop reads and leaves behind, whatever its data are.
#pragma once

#include <functional>
#include <map>
#include <string_view>

#include "app/output.hpp"
#include "app/reader.hpp"
#include "golf/data_error.hpp"
#include "loop/case.hpp"
#include "loop/report.hpp"

namespace hosel::app {

/// `title`, `[model] base` and `effects` (those that `acts` is true of), `[split]` but for its clusters.
void read_loop_case(Table root, loop::Case& into, bool (*acts)(const loop::EffectEntry&));

/// The column of `shots`, which may not be there, whose values `[split]` keeps together; empty: none.
std::string read_split_by(Table split, const loop::Shots* shots);

/// A standard deviation for each column that `table` names: one of `shots` with that role, `what` in words; any where
/// the shots are not there.
std::map<std::string, double> read_noise(Table table, const loop::Shots* shots, loop::Role role, std::string_view what);

/// Tells the person what the loop is doing, each kind of work as a progress of its own, until it is destroyed.
loop::Told progress_of(const Output& out);

/// What the loop says of a ShotCase, FlightCase or HistoryCase. Throws InputError where its data cannot be used at all.
template <class Case>
loop::LoopResult run_loop(const Output& out, Case& of) {
  of.told = progress_of(out);
  try {
    loop::LoopResult result = run(of);
    of.told = {};
    return result;
  } catch (const DataError& e) { throw InputError(e.what()); }
}

/// Writes report.json, report.html, residuals.csv and the summary, and tells the person what came out. `table`: what
/// the result's rows count; `rows`: what a flagged one is called.
void report_loop(Output& out, const loop::LoopResult& result, const loop::Shots& table, std::string_view rows,
                 const std::function<void()>& beside = {});

}  // namespace hosel::app
