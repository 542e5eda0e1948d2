#include "app/diff.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <utility>

#include "app/parse_toml.hpp"
#include "app/reader.hpp"
#include "app/resolved.hpp"
#include "app/terminal.hpp"
#include "post/file.hpp"
#include "post/launch_table.hpp"
#include "post/parse_json.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

using Leaves = std::map<std::string, std::string>;

/// As a case states it: the shortest digits that are the number.
std::string said(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* list = node.as_array()) {
    std::vector<std::string> all;
    for (const toml::node& entry : *list) all.push_back(said(entry));
    return fmt::format("[{}]", fmt::join(all, ", "));
  }
  std::ostringstream text;
  text << toml::node_view<const toml::node>(node);
  return text.str();
}

void leaves(const toml::node& node, const std::string& name, Leaves& out) {
  if (const auto* table = node.as_table()) {
    for (auto&& [key, value] : *table)
      leaves(value, name.empty() ? std::string(key) : name + "." + std::string(key), out);
    return;
  }
  if (const auto* list = node.as_array(); list && !list->empty() && list->get(0)->is_table()) {
    for (std::size_t i = 0; i < list->size(); ++i) leaves(*list->get(i), fmt::format("{}[{}]", name, i + 1), out);
    return;
  }
  out[name] = said(node);
}

struct Run {
  json summary;
  Leaves inputs;
  std::map<std::string, std::string> files;  ///< below OUT, as the case names them: name, content
};

/// What stands below a folder; nothing where there is none.
std::map<std::string, std::string> files_below(const fs::path& run, const char* folder) {
  std::map<std::string, std::string> out;
  try {
    if (!fs::exists(run / folder)) return out;
    for (const auto& entry : fs::recursive_directory_iterator(run / folder))
      if (!entry.is_directory())
        out[entry.path().lexically_relative(run).generic_string()] = post::read_file(entry.path());
  } catch (const std::runtime_error& e) { throw InputError(e.what()); }
  return out;
}

Run read(const fs::path& directory) {
  if (!fs::exists(directory / "summary.json") || !fs::exists(directory / kResolvedCase))
    throw InputError(fmt::format("{}: no finished run (no summary.json)", directory.string()));
  Run run;
  try {
    run.summary = post::parse_json(post::read_file(directory / "summary.json"));
  } catch (const std::exception& e) {
    throw InputError(fmt::format("{}: summary.json: {}", directory.string(), e.what()));
  }
  const fs::path resolved = directory / kResolvedCase;
  std::string text;
  try {
    text = post::read_file(resolved);
  } catch (const std::runtime_error& e) { throw InputError(e.what()); }
  toml::table inputs = parse_toml(text, resolved.string());
  inputs.erase(kDefaultsTable);  // they stand above
  leaves(inputs, "", run.inputs);
  run.files = files_below(directory, kInputsFolder);
  return run;
}

/// A model's own error, relative: of ball speed, of the launch angle, of the spin rate. Of finite elements as the table
/// in docs/command.md has it, rounded up for other drivers, at the coarser of the two levels; of models that integrate
/// in time their tolerance.
struct NumericalError {
  double speed, angle, spin;
};

NumericalError numerical_error(const std::string& model, const Run& run) {
  if (model.starts_with("fe-")) {
    const auto at_least = [&](const char* key, double level) {
      const auto it = run.inputs.find(key);
      return it != run.inputs.end() && std::strtod(it->second.c_str(), nullptr) >= level;
    };
    const bool fine = at_least("mesh.sector", 3) && at_least("mesh.harmonics", 4) &&
                      at_least("time.steps_per_contact", 60);
    return fine ? NumericalError{0.001, 0.003, 0.007} : NumericalError{0.0015, 0.006, 0.04};
  }
  const bool in_time = model == "volumetric" || model == "hertz-maw" || model == "shaft-coupled";
  return in_time ? NumericalError{1e-3, 1e-3, 1e-3} : NumericalError{1e-9, 1e-9, 1e-9};
}

/// Of one channel, in its own unit: angles by that of the launch angle, components of the spin by that of its rate.
double error_of(const post::Channel& c, const json& launch, const NumericalError& e) {
  const auto size = [&](const char* key) { return std::abs(launch.value(key, 0.0)); };
  if (c.unit == "mps") return e.speed * size("ball_speed_mps");
  if (c.unit == "rpm") return e.spin * size("spin_rate_rpm");
  if (c.name == "spin_axis") return degrees(e.spin);
  return e.angle * std::max(size("launch_angle_deg"), 1.0);
}

/// Whether a finite-element model had the same mesh and steps in time in both runs.
bool same_mesh(const std::string& model, const Run& a, const Run& b) {
  const auto mesh = [](const Run& run) {
    Leaves out;
    for (const auto& [key, value] : run.inputs)
      if (key == "accuracy" || key.starts_with("mesh.") || key.starts_with("time.") ||
          key.find(".mesh.") != std::string::npos)
        out[key] = value;
    return out;
  };
  return model.starts_with("fe-") && mesh(a) == mesh(b);
}

/// Digits of arithmetic are no answer: below this a speed, an angle or a spin is zero, in any unit of the tables.
constexpr double kNothing = 1e-9;
/// Of a quotient that is zero: of other numbers, whose units are not known here.
constexpr double kRoundOff = 1e-13;
double tidy(double x) { return std::abs(x) < kNothing ? 0 : x; }

/// Two digits of an error, never with an exponent above one.
std::string two_digits(double error) {
  if (!(error >= 99.5)) return fmt::format("{:.2g}", tidy(error));
  const double step = std::pow(10, std::floor(std::log10(error)) - 1);
  return fmt::format("{:.0f}", step * std::round(error / step));
}

/// Everything in a summary that is a launch, by its place there; of `models` by the model's name. Means over a study's
/// points are none.
void launches_in(const json& j, const std::string& name, std::map<std::string, json>& out) {
  if (name == "mean") return;
  if (j.is_object() && j.contains("ball_speed_mps") && j["ball_speed_mps"].is_number()) {
    out[name.starts_with("models.") ? name.substr(7) : name] = j;
    return;
  }
  if (!j.is_structured()) return;
  std::size_t index = 0;
  for (const auto& [key, value] : j.items()) {
    const std::string own = j.is_array() ? fmt::format("{}", index++) : key;
    launches_in(value, name.empty() ? own : name + "." + own, out);
  }
}

/// Below this a number is round-off: what has a unit of the tables is not as small as that of an inertia.
double nothing(const std::string& key) {
  return split_unit(key.substr(key.rfind('.') + 1)).unit ? kNothing : kRoundOff;
}

/// Everything in a summary, by its place there.
struct Flat {
  std::map<std::string, double> numbers;
  std::map<std::string, std::string> words;  ///< texts, flags, and null where a number is missing
  std::map<std::string, std::size_t> lists;  ///< their lengths
};

void flatten(const json& j, const std::string& name, Flat& out) {
  if (j.is_number()) out.numbers[name] = j.get<double>();
  if (j.is_string()) out.words[name] = j.get<std::string>();
  if (j.is_boolean() || j.is_null()) out.words[name] = j.dump();
  if (!j.is_structured()) return;
  if (j.is_array()) out.lists[name] = j.size();
  for (const auto& [key, value] : j.items()) flatten(value, name.empty() ? key : name + "." + key, out);
}

/// What stands in lists of different lengths cannot be compared place by place: a line for each, and both forget it.
std::string lists_of_other_length(Flat& a, Flat& b) {
  std::string out, told;  // what stands in a list that is told is told with it: names come in their order
  for (const auto& [name, length] : a.lists) {
    const auto other = b.lists.find(name);
    if (other == b.lists.end() || other->second == length || (!told.empty() && name.starts_with(told))) continue;
    told = name + ".";
    out += fmt::format("  {}: {} entries in A, {} in B\n", name, length, other->second);
    for (Flat* of : {&a, &b}) {
      const auto inside = [&](const auto& entry) { return entry.first.starts_with(name + "."); };
      std::erase_if(of->numbers, inside);
      std::erase_if(of->words, inside);
    }
  }
  return out;
}

/// A line for each file whose content differs or that one run alone has.
std::string different_files(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
  std::map<std::string, std::string> all = a;
  all.insert(b.begin(), b.end());
  std::string out;
  for (const auto& [name, ignored] : all) {
    const char* what = !b.contains(name) ? "in A only" : !a.contains(name) ? "in B only" : "its content differs";
    if (!a.contains(name) || !b.contains(name) || a.at(name) != b.at(name))
      out += fmt::format("  {}: {}\n", one_line(name), what);
  }
  return out;
}

/// A line of the points of two studies, which are rows of a table and no launches; empty of other runs.
std::string points_said(const fs::path& a, const fs::path& b) {
  const fs::path one = a / "points.csv", other = b / "points.csv";
  if (!fs::exists(one) || !fs::exists(other)) return {};
  try {
    return fmt::format("points\n  points.csv: {}\n", post::read_file(one) == post::read_file(other)
                                                         ? "the same"
                                                         : "its content differs; it has the launches, point by point");
  } catch (const std::runtime_error& e) { throw InputError(e.what()); }
}

/// A number or a list of numbers as a case states it, in SI; nothing of anything else.
std::optional<std::vector<double>> in_si(std::string text, double si) {
  std::vector<double> out;
  std::erase_if(text, [](char c) { return c == '[' || c == ']' || c == ' '; });
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string one = text.substr(at, end - at);
    char* stop = nullptr;
    out.push_back(si * std::strtod(one.c_str(), &stop));
    if (one.empty() || *stop != '\0') return {};
    at = end + 1;
  }
  return out;
}

/// Whether an input that the other run has not is there in another unit, with the same value.
bool in_another_unit(const std::string& key, const std::string& value, const Leaves& other) {
  const SplitName own = split_unit(key);
  if (!own.unit) return false;
  const auto x = in_si(value, own.unit->si);
  return x && std::ranges::any_of(other, [&](const auto& entry) {
           const SplitName there = split_unit(entry.first);
           if (!there.unit || there.stem != own.stem || there.unit->dimension != own.unit->dimension) return false;
           const auto y = in_si(entry.second, there.unit->si);
           return y && std::ranges::equal(*x, *y, [](double a, double b) {
                    return a == b || std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b));
                  });
         });
}

}  // namespace

std::string difference(const fs::path& a_dir, const fs::path& b_dir) {
  const Run a = read(a_dir), b = read(b_dir);
  std::string out = "inputs\n";
  std::string rows, band;
  Leaves all = a.inputs;
  all.insert(b.inputs.begin(), b.inputs.end());
  const auto said = [](const Run& run, const std::string& key) {
    const auto it = run.inputs.find(key);
    return it == run.inputs.end() ? std::string("-") : it->second;
  };
  for (const auto& [key, value] : all) {
    const bool alone = !a.inputs.contains(key) || !b.inputs.contains(key);
    if (alone && in_another_unit(key, value, a.inputs.contains(key) ? b.inputs : a.inputs)) continue;
    if (said(a, key) != said(b, key)) rows += fmt::format("  {:<36} {:>20} {:>20}\n", key, said(a, key), said(b, key));
  }
  const std::string files = different_files(a.files, b.files);
  if (rows.empty() && files.empty()) out += "  the same\n";
  if (!rows.empty()) out += fmt::format("  {:<36} {:>20} {:>20}\n", "", "A", "B") + rows;
  out += files;

  Flat flat_a, flat_b;
  flatten(a.summary, "", flat_a);
  flatten(b.summary, "", flat_b);
  const std::string lengths = lists_of_other_length(flat_a, flat_b);
  std::map<std::string, double>&x = flat_a.numbers, &y = flat_b.numbers;
  rows.clear();
  std::map<std::string, json> left, right;
  launches_in(a.summary, "", left);
  launches_in(b.summary, "", right);
  constexpr std::size_t most_launches = 12;  // a study's points are a table of their own
  if (std::max(left.size(), right.size()) > most_launches) left.clear(), right.clear();
  int launches = 0;
  bool compared = false, estimated_by_none = false;  // compared: a row has numbers
  std::set<std::string> in_rows;
  for (const auto& [model, launch] : left) {
    if (!right.contains(model)) {
      rows += fmt::format("  {}: in A only\n", model);
      continue;
    }
    ++launches;
    const bool known = a.summary.contains("models") && a.summary["models"].contains(model);
    const json& other = right.at(model);
    const NumericalError ea = numerical_error(model, a), eb = numerical_error(model, b);
    const NumericalError e{std::max(ea.speed, eb.speed), std::max(ea.angle, eb.angle), std::max(ea.spin, eb.spin)};
    for (const post::Channel& c : post::channels()) {
      const std::string key = fmt::format("{}_{}", c.name, c.unit);
      if (!launch.contains(key) || !other.contains(key)) continue;
      const double p = tidy(launch[key]), q = tidy(other[key]);
      const auto estimated = [&](const json& l) {
        return l.contains("numerical_error") ? l["numerical_error"].value(key, 0.0) : error_of(c, l, e);
      };
      const double of_a = estimated(launch), of_b = estimated(other), error = std::max(of_a, of_b);
      const std::string place = (known ? "models." : "") + model + "." + key;
      x.erase(place);
      in_rows.insert(place);
      const double off = post::difference(c, q, p);
      if (std::abs(off) <= kNothing * std::max({std::abs(p), std::abs(q), 1.0})) continue;
      compared = true;
      if (!known && !launch.contains("numerical_error")) {
        estimated_by_none = true;
        rows += fmt::format("  {:<36} {:>12.6g} {:>12.6g} {:>+12.4g} {:>12}\n", model + " " + key, p, q, off, "-");
        continue;
      }
      if (band.empty()) {
        const json& larger = of_a >= of_b ? launch : other;
        const bool own = larger.contains("numerical_error") && larger["numerical_error"].contains(key);
        band = fmt::format(
            "  numerical: the larger error of the two runs, each by itself; {} {}: {:.2g} {}, of {}, {}{}\n", model,
            c.name, error, c.unit, of_a >= of_b ? "A" : "B",
            own ? "by its second, coarser run"
                : "by the table of docs/command.md, rounded up, or the model's tolerance",
            same_mesh(model, a, b)
                ? ". Both runs have the same mesh, and most of that error is common to both. Run both at another "
                  "`accuracy` to see how far B - A moves"
                : "");
      }
      rows += fmt::format("  {:<36} {:>12.6g} {:>12.6g} {:>+12.4g} {:>12}  {}\n", model + " " + key, p, q, off,
                          two_digits(error), std::abs(off) > error ? "beyond" : "within");
    }
  }
  for (const auto& [model, launch] : right)
    if (!left.contains(model)) rows += fmt::format("  {}: in B only\n", model);
  if (launches > 0 || !rows.empty()) out += "launches\n";
  if (rows.empty() && launches > 0) out += "  the same\n";
  if (compared) out += fmt::format("  {:<36} {:>12} {:>12} {:>12} {:>12}\n", "", "A", "B", "B - A", "numerical");
  out += rows + band;
  if (estimated_by_none) out += "  numerical -: runs of this kind tell no error of a launch\n";
  out += points_said(a_dir, b_dir);
  // Everything else that both runs say.
  struct Moved {
    std::string key;
    double a, b, relative;
  };
  std::vector<Moved> moved;
  std::size_t others = 0;
  std::vector<std::string> in_a, in_b;
  // A model that one run alone has is told above.
  const auto of_one = [&](const std::string& key, const auto& here, const auto& there) {
    return std::ranges::none_of(here, [&](const auto& l) {
      return !there.contains(l.first) && (key.starts_with(l.first + ".") || key.starts_with("models." + l.first + "."));
    });
  };
  for (const auto& [key, q] : y)
    if (!x.contains(key) && !in_rows.contains(key) && !flat_a.words.contains(key) && of_one(key, right, left))
      in_b.push_back(key);
  for (const auto& [key, p] : x) {
    const auto it = y.find(key);
    if (it == y.end()) {
      if (!flat_b.words.contains(key) && of_one(key, left, right)) in_a.push_back(key);
      continue;
    }
    ++others;
    const double size = std::max(std::abs(p), std::abs(it->second));
    if (size <= nothing(key) || std::abs(it->second - p) <= 1e-9 * size) continue;
    moved.push_back({key, p, it->second, std::abs(it->second - p) / size});
  }
  out += fmt::format("other numbers of summary.json\n  {} of {} differ\n", moved.size(), others);
  constexpr std::size_t most = 25;
  if (moved.size() > most) {
    std::ranges::stable_sort(moved, std::greater(), &Moved::relative);
    moved.resize(most);
    out += fmt::format("  the {} that differ most, relative to their size:\n", most);
  }
  for (const Moved& m : moved)
    out += fmt::format("  {:<48} {:>12.6g} {:>12.6g} {:>+12.4g}\n", m.key, m.a, m.b, m.b - m.a);
  out += lengths;
  for (const auto& [run, alone] : {std::pair{"A", &in_a}, {"B", &in_b}}) {
    if (alone->empty()) continue;
    const std::span told(alone->data(), std::min(most, alone->size()));
    out += fmt::format("  {} in {} only{}:\n    {}\n", alone->size(), run,
                       alone->size() > most ? fmt::format(", the first {}", most) : "", fmt::join(told, "\n    "));
  }
  std::string words;
  std::map<std::string, std::string> every = flat_a.words;
  every.insert(flat_b.words.begin(), flat_b.words.end());
  const auto word = [](const Flat& of, const std::string& key) {
    if (const auto number = of.numbers.find(key); number != of.numbers.end())
      return fmt::format("{:g}", number->second);
    const auto it = of.words.find(key);
    return it == of.words.end() ? std::string("-") : one_line(it->second);
  };
  for (const auto& [key, ignored] : every)
    if (word(flat_a, key) != word(flat_b, key))
      words += fmt::format("  {}\n    A: {}\n    B: {}\n", key, word(flat_a, key), word(flat_b, key));
  if (!words.empty()) out += "texts and flags of summary.json\n" + words;
  return out;
}

}  // namespace hosel::app
