#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>

#include "designs.hpp"
#include "files.hpp"
#include "units.hpp"

namespace examination {
namespace fs = std::filesystem;
namespace {

using Names = std::set<std::string>;

Json load(const fs::path& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return Json::parse(in);
}

/// 95 % interval of a proportion (Wilson 1927).
std::pair<double, double> interval(int k, int n) {
  if (n == 0) return {0, 1};
  const double z = 1.959964, p = static_cast<double>(k) / n;
  const double centre = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4.0 * n * n));
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

struct Line {
  std::string stratum, what;
  int hits, of;
  double goal;
  bool at_most;
};

/// A column's name with or without its unit, as a report may call it.
bool same_column(const std::string& reported, const std::string& header) {
  if (reported == header) return true;
  const auto cut = header.rfind('_');
  return cut != std::string::npos && reported == header.substr(0, cut);
}

Names names_of(const Json& list) {
  Names names;
  if (list.is_array())
    for (const auto& v : list)
      if (v.is_string()) names.insert(v.get<std::string>());
  return names;
}

struct Outcome {
  Json key, report;
  bool ran = false;
  std::string trouble;
  Names truth, adopted, tied;
  std::string verdict;
};

/// residuals.csv as header -> cells.
std::map<std::string, std::vector<std::string>> read_csv(const fs::path& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells;
    std::string c;
    for (const char ch : line)
      if (ch == ',') cells.push_back(std::exchange(c, ""));
      else if (ch != '\r') c += ch;
    cells.push_back(c);
    return cells;
  };
  std::string line;
  std::getline(in, line);
  const auto header = split(line);
  std::map<std::string, std::vector<std::string>> table;
  while (std::getline(in, line)) {
    const auto cells = split(line);
    for (std::size_t k = 0; k < header.size() && k < cells.size(); ++k) table[header[k]].push_back(cells[k]);
  }
  return table;
}

/// Held-out error after adoption over the oracle's: the true forms refitted on the same training rows. Root mean
/// square over all channels, each in units of its noise.
double oracle_ratio(const Set& set, const Json& report, const fs::path& residuals) {
  const auto table = read_csv(residuals);
  const auto& shot = table.at("shot");
  const auto& part = table.at("set");
  std::vector<int> train;
  for (std::size_t k = 0; k < shot.size(); ++k)
    if (part[k] == "train") train.push_back(std::stoi(shot[k]) - 1);
  const Session& s = set.session;
  const auto swings = recorded_swings(s);
  const auto w = whitening(s, swings);
  std::vector<const Form*> forms;
  for (const Form& f : set.hidden) forms.push_back(&f);
  const Fit oracle = fit(s, swings, forms, s.recorded_outputs, w, train, false);
  double loop = 0, best = 0;
  for (std::size_t c = 0; c < s.channels.size(); ++c) {
    const Channel& ch = s.channels[c];
    int n = 0;
    for (std::size_t k = 0; k < shot.size(); ++k) {
      if (part[k] == "train") continue;
      const int row = std::stoi(shot[k]) - 1;
      const double d = oracle.outputs(row, static_cast<int>(c)) - s.recorded_outputs(row, static_cast<int>(c));
      if (!std::isfinite(d)) continue;
      best += std::pow(d / ch.noise_sd, 2);
      ++n;
    }
    for (const auto& reported : report.at("channels"))
      if (reported.at("name") == ch.header)
        loop += n * std::pow(reported.at("after").at("holdout_rmse").get<double>() / ch.noise_sd, 2);
  }
  return std::sqrt(loop / best);
}

/// The true value of a reported parameter, where the report's form is the true one: by effect, name and unit.
std::optional<double> true_value(const Set& set, const std::string& name, const std::string& unit) {
  const std::string& effect = set.hidden[0].effect;
  const auto& x = set.value[0];
  const Session& s = set.session;
  const std::string id = effect + "/" + name + "/" + unit;
  if (id == "ball-tangential-compliance/tangential_restitution/1") return x[0];
  if (id == "friction-limit/friction_coefficient/1") return 1 / x[0];
  if (id == "restitution-law/level/1") return x[0];
  if (id == "restitution-law/slope/s/m") return x[1];
  if (id == "restitution-falloff/falloff/1/m^2") return x[0] / (0.02 * 0.02);
  if (id == "head-mass/added_mass/g" && !s.mass_column) return 1e3 * x[0] * s.head.mass_kg;
  if (id == "head-inertia/log_factor/1") return std::log1p(x[0]);
  if (id == "cg-shift/shift_up/mm") return 1e3 * x[1];
  if (id == "cg-shift/shift_heel/mm") return 1e3 * x[0];
  if (id == "head-closure/rate_z/rad/s") return x[0];
  if (id == "ball-inertia/change_of_inertia_factor/1") return s.ball.inertia_factor * x[0];
  if (id == "loft-bias/offset/deg") return x[0] / deg;
  if (id == "monitor-misalignment/pitch/deg") return x[0] / deg;
  if (id == "monitor-misalignment/yaw/deg") return x[1] / deg;
  if (effect == "session-drift")
    for (const Channel& c : s.channels)
      if (name == c.header.substr(0, c.header.rfind('_')) + "_per_session" &&
          unit == c.header.substr(c.header.rfind('_') + 1))
        return x[static_cast<std::size_t>(c.slot)] * c.noise_sd;
  return std::nullopt;
}

/// Reported parameters of the adopted effect that can be compared, and how many of their 95 % intervals hold
/// the truth; nothing where a true parameter that is not zero has no counterpart.
std::optional<std::pair<int, int>> coverage(const Set& set, const Json& report) {
  if (set.hidden.size() != 1) return std::nullopt;
  for (const auto& candidate : report.at("candidates")) {
    if (names_of(candidate["effects"]) != names_of(report["adopted"])) continue;
    int compared = 0, held = 0;
    for (const auto& p : candidate["parameters"]) {
      const auto truth = true_value(set, p.at("name"), p.at("unit"));
      if (!truth) return std::nullopt;
      ++compared;
      held += p.at("sd").is_null() ||  // the data do not show it
              std::abs(p.at("value").get<double>() - *truth) <= 1.959964 * p.at("sd").get<double>();
    }
    const auto active = std::count_if(set.value[0].begin(), set.value[0].end(), [](double v) { return v != 0; });
    if (compared < active) return std::nullopt;
    return std::pair{compared, held};
  }
  return std::nullopt;
}

double percentile(std::vector<double> v, double p) {
  if (v.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(v.begin(), v.end());
  return v[static_cast<std::size_t>(std::ceil(p * static_cast<double>(v.size()))) - 1];
}

std::string join(const Names& names) {
  std::string text;
  for (const auto& n : names) text += (text.empty() ? "" : "+") + n;
  return text.empty() ? "-" : text;
}

}  // namespace

Json score_sets(const fs::path& dir) {
  std::vector<Outcome> outcomes;
  std::vector<fs::path> keys;
  for (const auto& entry : fs::directory_iterator(dir / "keys")) keys.push_back(entry.path());
  std::sort(keys.begin(), keys.end());
  bool development = false, examination_seeds = false;
  const Json runs = fs::exists(dir / "runs.json") ? load(dir / "runs.json") : Json::object();
  for (const auto& path : keys) {
    Outcome o;
    o.key = load(path);
    (o.key["seed"].get<std::uint64_t>() < first_examination_seed ? development : examination_seeds) = true;
    for (const auto& h : o.key["hidden"]) o.truth.insert(h["effect"]);
    const std::string name = o.key["set"];
    try {
      o.report = load(dir / "out" / name / "report.json");
      o.verdict = o.report.at("verdict").get<std::string>();
      o.adopted = names_of(o.report.at("adopted"));
      for (const auto& tie : o.report.at("ties")) o.tied.merge(names_of(tie));
      o.ran = true;
    } catch (const std::exception& e) { o.trouble = e.what(); }
    outcomes.push_back(std::move(o));
  }
  if (development && examination_seeds)
    throw std::runtime_error("development and examination seeds are mixed in " + dir.string());

  std::vector<Line> lines;
  const auto count = [&](const std::string& stratum, const std::string& what, double goal, bool at_most,
                         const auto& counted, const auto& hit) {
    int n = 0, k = 0;
    for (const Outcome& o : outcomes)
      if (o.key["stratum"] == stratum && counted(o)) {
        ++n;
        k += hit(o);
      }
    if (n) lines.push_back({stratum, what, k, n, goal, at_most});
  };
  const auto any = [](const Outcome&) { return true; };
  const auto adopts = [](const Outcome& o) { return !o.adopted.empty(); };
  const auto names_other = [](const Outcome& o) {
    return std::any_of(o.adopted.begin(), o.adopted.end(), [&](const auto& n) { return !o.truth.contains(n); });
  };
  const auto covers = [](const Outcome& o) {
    return std::all_of(o.truth.begin(), o.truth.end(), [&](const auto& n) { return o.adopted.contains(n); });
  };
  for (const auto& [stratum, sets] : strata())
    count(stratum, "no report", 0.0, true, any, [](const Outcome& o) { return !o.ran; });
  for (const auto& [stratum, sets] : strata())
    if (stratum.starts_with("null")) count(stratum, "adoptions", stratum == "null" ? 0.01 : 0.03, true, any, adopts);
  const auto alone = [&](const Outcome& o) { return o.ran && o.adopted == o.truth && o.tied.empty(); };
  count("one-effect", "named alone, a >= 4.8", 0.93, false, any, alone);
  count(
      "one-effect", "named alone, a >= 5.5", 0.97, false, [](const Outcome& o) { return o.key["a"] >= 5.5; }, alone);
  count("one-effect", "a wrong name", 0.01, true, any, names_other);
  count("one-effect", "in a tie", 1, true, any, [](const Outcome& o) { return o.tied.contains(*o.truth.begin()); });
  count("other-form", "mechanism named", 0.85, false, any, [&](const Outcome& o) { return o.ran && covers(o); });
  count("other-form", "a wrong name", 1, true, any, names_other);
  count("two-effects", "both named", 0.90, false, any, [&](const Outcome& o) { return o.ran && covers(o); });
  count("two-effects", "a third", 0.02, true, any, names_other);
  count("confounded", "truth in the tie, or named", 0.99, false, any,
        [](const Outcome& o) { return o.tied.contains(*o.truth.begin()) || o.adopted.contains(*o.truth.begin()); });
  count("confounded", "truth in the tie", 0, false, any,
        [](const Outcome& o) { return o.tied.contains(*o.truth.begin()); });
  count("confounded", "a wrong name", 0.01, true, any, names_other);
  const auto located = [](const Outcome& o, bool with_column) {
    if (!o.ran || o.verdict != "unexplained" || !o.report.contains("unexplained")) return false;
    for (const auto& u : o.report["unexplained"]) {
      if (u.value("channel", "") != o.key["channel"].get<std::string>()) continue;
      if (!with_column || o.key["columns"].empty()) return true;
      const auto regressor = u.contains("regressor") && u["regressor"].is_string() ? u["regressor"].get<std::string>()
                                                                                   : std::string();
      for (const auto& c : o.key["columns"])
        if (same_column(regressor, c.get<std::string>())) return true;
    }
    return false;
  };
  count("outside", "unexplained", 0, false, any, [](const Outcome& o) { return o.verdict == "unexplained"; });
  count("outside", "and the channel", 0, false, any, [&](const Outcome& o) { return located(o, false); });
  count("outside", "and the column", 0.90, false, any, [&](const Outcome& o) { return located(o, true); });
  count("outside", "adoptions", 1, true, any, adopts);

  // Rows: counted by row, not by set.
  for (const std::string stratum : {"bad-rows", "null-bad-rows"}) {
    int bad = 0, found = 0, good = 0, accused = 0, clubs = 0, whole = 0;
    for (const Outcome& o : outcomes) {
      if (o.key["stratum"] != stratum) continue;
      std::set<int> truth;
      for (const auto& r : o.key["bad_rows"]) truth.insert(r["shot"].get<int>());
      std::map<int, std::string> flagged;
      if (o.ran && o.report.contains("flagged_rows"))
        for (const auto& r : o.report["flagged_rows"]) {
          const int shot = r["shot"].is_string() ? std::stoi(r["shot"].get<std::string>()) : r["shot"].get<int>();
          flagged[shot] = r.contains("finding") ? r["finding"].dump() : "";
        }
      bad += static_cast<int>(truth.size());
      good += o.key["shots"].get<int>() - static_cast<int>(truth.size());
      for (const auto& [row, finding] : flagged) (truth.contains(row) ? found : accused) += 1;
      if (o.key.contains("bad_cluster")) {
        ++clubs;
        std::set<std::string> findings;
        int of_club = 0;
        for (const int row : truth)
          if (flagged.contains(row)) {
            ++of_club;
            findings.insert(flagged[row]);
          }
        whole += of_club == static_cast<int>(truth.size()) && findings.size() == 1;
      }
    }
    if (bad) lines.push_back({stratum, "bad rows found", found, bad, 0.95, false});
    if (good) lines.push_back({stratum, "good rows flagged", accused, good, 0.01, true});
    if (clubs) lines.push_back({stratum, "a whole club as one finding", whole, clubs, 1, false});
  }
  count("bad-rows", "adoptions", 1, true, any, adopts);

  // Derived columns: found where the entry's columns are those of the relation, whichever is called derived.
  int false_derived = 0, ran = 0;
  for (const Outcome& o : outcomes) {
    if (!o.ran) continue;
    ++ran;
    Names relation;
    if (o.key.contains("derived")) {
      relation = names_of(o.key["derived"]["from"]);
      relation.insert(o.key["derived"]["column"].get<std::string>());
    }
    bool wrong = false;
    if (o.report.contains("derived_columns"))
      for (const auto& d : o.report["derived_columns"]) {
        Names columns = names_of(d["from"]);
        columns.insert(d["column"].get<std::string>());
        if (!std::includes(relation.begin(), relation.end(), columns.begin(), columns.end())) wrong = true;
      }
    false_derived += wrong;
  }
  const auto derived_found = [](const Outcome& o) {
    if (!o.ran || !o.report.contains("derived_columns")) return false;
    Names relation = names_of(o.key["derived"]["from"]);
    relation.insert(o.key["derived"]["column"].get<std::string>());
    for (const auto& d : o.report["derived_columns"]) {
      Names columns = names_of(d["from"]);
      columns.insert(d["column"].get<std::string>());
      if (std::includes(relation.begin(), relation.end(), columns.begin(), columns.end())) return true;
    }
    return false;
  };
  count("derived", "found", 1, false, any, derived_found);
  count("mostly-computed", "found", 0.9, false, any, derived_found);

  // Whole columns: the slip by its word, in a column that has it.
  const auto silent = [](const Outcome& o) { return o.verdict == "no-residual" || o.verdict == "explained"; };
  const auto slipped = [](const Outcome& o, bool with_kind) {
    if (!o.ran || !o.report.contains("columns")) return false;
    for (const auto& c : o.report["columns"])
      if (names_of(o.key["slip"]["columns"]).contains(c.value("column", "")) &&
          (!with_kind || c.value("finding", "") == o.key["slip"].value("slip", "")))
        return true;
    return false;
  };
  count("wrong-column", "no-residual or explained", 0, true, any, silent);
  count("wrong-column", "column named", 0, false, any, [&](const Outcome& o) { return slipped(o, false); });
  count("wrong-column", "column and slip named", 0.95, false, any, [&](const Outcome& o) { return slipped(o, true); });
  int false_column = 0, other_sets = 0;
  for (const Outcome& o : outcomes)
    if (o.ran && o.key["stratum"] != "wrong-column") {
      ++other_sets;
      false_column += o.report.contains("columns") && !o.report["columns"].empty();
    }
  if (other_sets) lines.push_back({"all others", "a column falsely called wrong", false_column, other_sets, 1, true});

  // Two populations.
  const auto said_mixture = [](const Outcome& o) {
    if (!o.ran || o.verdict != "unexplained") return false;
    for (const auto& u : o.report["unexplained"])
      if (u.value("detail", "").find("mixture") != std::string::npos) return true;
    return false;
  };
  count("mixture", "said as such", 0.9, false, any, said_mixture);
  count("mixture", "adoptions", 1, true, any, adopts);
  int false_mixture = 0;
  for (const Outcome& o : outcomes)
    if (o.key["stratum"] != "mixture" && o.key.value("invention", "") != "two kinds of ball, not recorded")
      false_mixture += said_mixture(o);
  if (other_sets) lines.push_back({"all others", "falsely called a mixture", false_mixture, ran, 1, true});

  count("two-and-outside", "what is adopted is right", 0.95, false, any,
        [&](const Outcome& o) { return o.ran && !names_other(o); });
  count("two-and-outside", "adoptions", 0, false, any, adopts);
  count("two-and-outside", "the rest located", 0.8, false, any, [&](const Outcome& o) { return located(o, true); });
  lines.push_back({"all", "a column falsely called derived", false_derived, ran, 0, true});

  // Held-out error against the oracle, and the listing of what went wrong.
  std::vector<double> ratios;
  int separable = 0, good_designs = 0, inseparable = 0, good_sensors = 0, compared = 0, held = 0;
  Json sets = Json::array();
  std::vector<double> seconds;
  for (const Outcome& o : outcomes) {
    const std::string name = o.key["set"], stratum = o.key["stratum"];
    Json entry = {{"set", name},
                  {"stratum", stratum},
                  {"base", o.key["base"]},
                  {"shots", o.key["shots"]},
                  {"truth", join(o.truth)},
                  {"adopted", join(o.adopted)},
                  {"tied", join(o.tied)},
                  {"verdict", o.ran ? o.verdict : o.trouble}};
    for (const char* field :
         {"s", "a", "rival", "invention", "channel", "columns", "slip", "derived", "population", "arrangement"})
      if (o.key.contains(field)) entry[field] = o.key[field];
    if (o.ran && o.report.contains("columns") && !o.report["columns"].empty())
      entry["wrong_columns"] = o.report["columns"];
    if (o.ran && o.report.contains("unexplained") && !o.report["unexplained"].empty())
      entry["unexplained"] = o.report["unexplained"];
    if (runs.contains(name)) {
      entry["seconds"] = runs[name]["seconds"];
      entry["status"] = runs[name]["status"];
      seconds.push_back(runs[name]["seconds"]);
    }
    if (o.ran && !o.truth.empty() && !o.adopted.empty() && o.key["shots"] >= 100) {
      try {
        const Set set = make_set(o.key["seed"], stratum, o.key["shots"], o.key["index"]);
        const double ratio = oracle_ratio(set, o.report, dir / "out" / name / "residuals.csv");
        entry["oracle_ratio"] = ratio;
        ratios.push_back(ratio);
      } catch (const std::exception& e) { entry["oracle_trouble"] = e.what(); }
    }
    if (o.ran && stratum == "one-effect" && o.adopted == o.truth) {
      try {
        if (const auto c = coverage(make_set(o.key["seed"], stratum, o.key["shots"], o.key["index"]), o.report)) {
          compared += c->first;
          held += c->second;
          entry["coverage"] = {{"parameters", c->first}, {"held", c->second}};
        }
      } catch (const std::exception& e) { entry["coverage_trouble"] = e.what(); }
    }
    if (o.ran && stratum == "confounded" && o.report.contains("next_experiment")) {
      // The pair to part: the truth and the other member of its tie, the nearest where that is among them.
      std::string rival;
      for (const auto& tie : o.report["ties"]) {
        const Names members = names_of(tie);
        if (!members.contains(*o.truth.begin())) continue;
        for (const auto& m : members)
          if (m != *o.truth.begin() && (rival.empty() || m == o.key.value("rival", ""))) rival = m;
      }
      if (!rival.empty()) {
        try {
          const Answer a = judge_answer(make_set(o.key["seed"], stratum, o.key["shots"], o.key["index"]), rival,
                                        o.report["next_experiment"]);
          entry["next_experiment"] = {{"rival", rival},
                                      {"separable", a.separable},
                                      {"ordinary", a.ordinary},
                                      {"designed", a.designed},
                                      {"sensor", a.sensor}};
          (a.separable ? separable : inseparable) += 1;
          if (a.separable) good_designs += a.designed <= a.ordinary / 3;
          else good_sensors += a.sensor;
        } catch (const std::exception& e) { entry["next_experiment_trouble"] = e.what(); }
      }
    }
    sets.push_back(entry);
  }
  if (compared) lines.push_back({"one-effect", "95 % interval holds the truth", held, compared, 0.92, false});
  if (separable)
    lines.push_back({"confounded", "separable: a third of the shots", good_designs, separable, 0.8, false});
  if (inseparable) lines.push_back({"confounded", "inseparable: quantity named", good_sensors, inseparable, 1, false});

  fmt::print("{:<20} {:<34} {:>11} {:>8}  {:<16} {}\n", "stratum", "what", "sets", "share", "95 % interval", "goal");
  Json table = Json::array();
  for (const Line& l : lines) {
    const double share = l.of ? static_cast<double>(l.hits) / l.of : 0;
    const auto [low, high] = interval(l.hits, l.of);
    const bool informative = (l.at_most && l.goal >= 1) || (!l.at_most && l.goal <= 0);
    const bool met = l.at_most ? share <= l.goal + 1e-12 : share >= l.goal - 1e-12;
    if (l.what == "no report" && l.hits == 0) continue;
    const std::string goal =
        informative ? ""
                    : fmt::format("{} {:.0f} %  {}", l.at_most ? "<=" : ">=", 100 * l.goal, met ? "met" : "MISSED");
    fmt::print("{:<20} {:<34} {:>5}/{:<5} {:>6.1f} %  {:>5.1f} .. {:<5.1f}   {}\n", l.stratum, l.what, l.hits, l.of,
               100 * share, 100 * low, 100 * high, goal);
    table.push_back({{"stratum", l.stratum},
                     {"what", l.what},
                     {"hits", l.hits},
                     {"of", l.of},
                     {"interval", {low, high}},
                     {"goal", informative ? Json() : Json(l.goal)},
                     {"met", informative ? Json() : Json(met)}});
  }
  Json result = {{"table", table}, {"sets", sets}};
  if (!ratios.empty()) {
    result["oracle_ratio"] = {
        {"sets", ratios.size()}, {"median", percentile(ratios, 0.5)}, {"p95", percentile(ratios, 0.95)}};
    fmt::print(
        "held-out error over the oracle's, {} sets of 100 shots and more: median {:.3f}, 95th percentile {:.3f} (goal "
        "1.05)\n",
        ratios.size(), percentile(ratios, 0.5), percentile(ratios, 0.95));
  }
  if (!seconds.empty()) {
    result["seconds"] = {{"median", percentile(seconds, 0.5)}, {"p95", percentile(seconds, 0.95)}};
    fmt::print("wall time per set: median {:.1f} s, 95th percentile {:.1f} s\n", percentile(seconds, 0.5),
               percentile(seconds, 0.95));
  }
  std::ofstream(dir / "score.json") << result.dump(1) << "\n";
  return result;
}

}  // namespace examination
