#include "app/study/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "post/digits.hpp"
#include "post/labels.hpp"

namespace hosel::app {

std::size_t number_of(const Table& t, std::string_view key, std::string_view what, const std::string& name,
                      const std::vector<std::string>& names) {
  if (const auto at = std::ranges::find(names, name); at != names.end()) return std::size_t(at - names.begin());
  t.fail(key, fmt::format("no {} '{}' in this study{}", what, name, or_nearest(name, names)));
}

std::optional<StudyReference> read_compare(Table root, const StudyTable& table) {
  bool measured = !table.measured.empty();
  std::vector<std::string> variants;
  for (const DesignFactor& f : table.design.factors())
    for (const DesignLevel& l : f.levels) {
      measured = measured || !l.measured.empty();
      if (f.kind == DesignFactor::Kind::variants) variants.push_back(l.cells.front());
    }
  auto t = root.optional_table("compare");
  if (!t) return measured ? std::optional(StudyReference{.name = "measured"}) : std::nullopt;
  std::optional<std::size_t> by;
  if (t->has("by"))
    by = number_of(*t, "by", "by",
                   t->text({"by", "column of the design; the points of each of its values are compared apart"}),
                   table.design.columns());
  const std::string with = t->choice({"with", "what the answers are compared with"}, {"model", "variant", "measured"});
  if (with == "model") {
    const std::string name = t->text({"model", "with which the other models are compared"});
    if (table.models.size() < 2) t->fail("model", "a comparison of models needs at least two");
    return StudyReference{.model = number_of(*t, "model", "model", name, table.models), .name = name, .by = by};
  }
  if (with == "variant") {
    const std::string name = t->text({"variant", "with which the other variants are compared"});
    return StudyReference{.variant = number_of(*t, "variant", "variant", name, variants), .name = name, .by = by};
  }
  if (!measured) t->fail("with", "nothing measured stands in [measured], a variant's `measured` or the rows");
  return StudyReference{.name = "measured", .by = by};
}

std::size_t counterpart(const StudyTable& table, const StudyReference& reference, std::size_t point) {
  if (!reference.variant) return point;
  const std::size_t block = table.design.size() / table.design.factors().front().levels.size();  // of one variant
  return point % block + *reference.variant * block;
}

std::vector<StudySeries> references(const StudyTable& table, const StudyReference& reference) {
  std::vector<StudySeries> out = table.series;
  for (StudySeries& s : out)
    for (std::size_t d = 0; d < s.y.size(); ++d) {
      const double own = s.y[d];
      if (reference.model) {
        s.y[d] = s.model == *reference.model ? NAN : table.at(*reference.model, s.output).y[d];
      } else if (reference.variant) {
        const std::size_t other = counterpart(table, reference, d);
        s.y[d] = other == d ? NAN : table.at(s.model, s.output).y[other];
      } else {
        const auto seen = table.seen(d, s.output);
        s.y[d] = seen && std::isfinite(own) ? std::clamp(own, seen->low, seen->high) : NAN;
      }
    }
  return out;
}

nlohmann::json compare(Output& out, const StudyTable& table, const StudyReference& reference,
                       const std::vector<StudySeries>& against, const std::vector<bool>& causes) {
  nlohmann::json json = {{"with", reference.name}, {"differences", nlohmann::json::array()}};
  const auto columns = table.design.columns();
  const auto groups = reference.by ? table.design.levels(*reference.by) : std::vector<std::string>{""};
  post::Table differences{{{"model"}}};
  if (reference.by) differences.in_files({"of"});
  differences.in_files({"output", "points"}).in_files({"mean", "rms", "largest"}, "{:.6g}").in_files(columns);
  for (std::size_t o = 0; o < table.outputs.size(); ++o)
    if (causes[o]) differences.in_files({fmt::format("{} difference there [%]", table.outputs[o])}, "{:.4g}");
  const bool any_cause = std::ranges::find(causes, true) != causes.end();
  for (std::size_t k = 0; k < table.models.size() * groups.size(); ++k) {
    const std::size_t m = k / groups.size();
    const std::string& group = groups[k % groups.size()];
    if (reference.model == m) continue;
    post::TextTable shown{
        .rows = {{"output", "mean", "rms", "largest", "where"}}, .margin = 1, .least_width = 9, .even = false};
    if (any_cause) shown.rows[0].push_back("differs most there");
    for (std::size_t o = 0; o < table.outputs.size(); ++o) {
      const StudySeries &mine = table.at(m, o), &theirs = against[m * table.outputs.size() + o];
      double mean = 0, square = 0, largest = 0, scale = 0;
      std::size_t where = 0, count = 0;
      for (std::size_t d = 0; d < mine.y.size(); ++d) {
        const double difference = table.difference(o, mine.y[d], theirs.y[d]);
        if (!std::isfinite(difference) || (reference.by && table.design.cells(d)[*reference.by] != group)) continue;
        if (count++ == 0 || std::abs(difference) > std::abs(largest)) largest = difference, where = d;
        scale = std::max({scale, std::abs(mine.y[d]), std::abs(theirs.y[d])});
        mean += difference;
        square += difference * difference;
      }
      if (count == 0) continue;
      mean /= double(count);
      const double rms = std::sqrt(square / double(count));
      differences.add(table.one_model(m) ? table.models[m] : "");
      if (reference.by) differences.more(group);
      differences.more(table.outputs[o], count, mean, rms, largest, table.design.cells(where));
      std::string cause = "-";
      double most = 0;
      nlohmann::json shares = nlohmann::json::object();
      for (std::size_t q = 0; q < table.outputs.size(); ++q) {
        if (!causes[q]) continue;
        const double a = table.at(m, q).y[where], b = against[m * table.outputs.size() + q].y[where];
        const double share = 100 * (a - b) / b;
        differences.more(post::if_finite(share));
        if (!std::isfinite(share)) continue;
        shares[table.outputs[q]] = share;
        if (std::abs(share) <= std::abs(most) || std::abs(largest) <= 1e-9) continue;
        most = share;
        cause = fmt::format("{} {:+.1f} % ({:.3g} against {:.3g})", post::label(table.outputs[q]), share, a, b);
      }
      auto& row = shown.rows.emplace_back();
      row = {post::label(table.outputs[o]), post::beside(mean, scale, true), post::beside(rms, scale),
             post::beside(largest, scale, true), largest == 0 ? "-" : table.design.said(where)};
      if (any_cause) row.push_back(cause);
      nlohmann::json j = {
          {"output", table.outputs[o]},       {"points", count}, {"mean", mean}, {"rms", rms}, {"largest", largest},
          {"where", table.design.said(where)}};
      if (!table.models[m].empty()) j["model"] = table.models[m];
      if (reference.by) j["of"] = group;
      if (!shares.empty()) j["differs_most"] = cause, j["quantities_pct"] = shares;
      json["differences"].push_back(std::move(j));
    }
    if (shown.rows.size() < 2) continue;
    const std::string& model = table.models[m];
    const std::string what = reference.variant ? (model.empty() ? "" : model + ": ") + "each variant"
                             : model.empty()   ? "computed"
                                               : model;
    const std::string title = fmt::format("{} minus {}{}", what, reference.name,
                                          reference.by ? ", " + said_cell(columns[*reference.by], group) : "");
    out.tell(title);
    out.show(shown, title);
  }
  out.write("differences.csv", differences.csv());
  return json;
}

}  // namespace hosel::app
