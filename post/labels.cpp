#include "post/labels.hpp"

#include "golf/units.hpp"

namespace hosel::post {

std::string spoken(std::string_view name) {
  std::string text(name);
  // An index of a symbol stays one: e_t.
  for (std::size_t i = 2; i < text.size(); ++i)
    if (text[i] == '_') text[i] = ' ';
  return text;
}

std::string counted(std::size_t n, std::string_view what) {
  return std::to_string(n) + " " + std::string(what) + (n == 1 ? "" : "s");
}

std::string symbol(std::string_view unit) {
  if (unit == "mps") return "m/s";
  if (unit == "kmh") return "km/h";
  if (unit == "pct") return "%";
  if (unit == "um") return "µm";
  if (unit == "us") return "µs";
  // The rest say themselves: factors by `_`, what is divided by behind `per`.
  std::string out;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit.substr(i).starts_with("_per_")) {
      out += '/';
      i += 4;
    } else if (unit[i] == '_') {
      out += ' ';
    } else if (unit[i] == '^') {  // "1/m^2": the power is raised below
    } else if (unit[i] == '2' || unit[i] == '3') {
      out += unit[i] == '2' ? "²" : "³";
    } else {
      out += unit[i];
    }
  }
  return out;
}

SpokenKey spoken_key(std::string_view key) {
  constexpr std::string_view celsius = "_degC";
  if (key.ends_with(celsius)) return {spoken(key.substr(0, key.size() - celsius.size())), "°C"};
  for (const std::string_view impulse : {"_N_m_s", "_N_s"})  // no units of a key
    if (key.ends_with(impulse)) return {spoken(key.substr(0, key.size() - impulse.size())), symbol(impulse.substr(1))};
  const SplitName split = split_unit(key);
  if (!split.unit) return {spoken(key), ""};
  const std::string unit = symbol(split.unit->suffix);
  std::string_view words = split.stem;
  if (!words.ends_with("_per")) return {spoken(words), unit};
  words.remove_suffix(4);
  // "slope_deg_per_mm": a unit in another.
  const SplitName over = split_unit(words);
  return {spoken(over.stem), (over.unit ? symbol(over.unit->suffix) : "1") + "/" + unit};
}

std::string label(std::string_view key) {
  std::string which, which_of;
  // One number of a list: "ball_speed_mps.4" in a summary, "cg_mm[2]" in a case.
  if (const auto dot = key.rfind('.');
      dot != key.npos && dot > 0 && dot + 1 < key.size() && key.find_first_not_of("0123456789", dot + 1) == key.npos) {
    which = " " + std::string(key.substr(dot + 1));
    key = key.substr(0, dot);
  }
  if (const auto dot = key.rfind('.'); dot != key.npos) {
    // Whose speed, what is towards: the name alone does not say.
    const std::string_view own = key.substr(dot + 1), table = key.substr(0, dot);
    if (own.starts_with("speed") || own.starts_with("towards"))
      which_of = std::string(table.substr(table.rfind('.') + 1)) + " ";
    key = own;
  }
  if (const auto open = key.find('['); open != key.npos && key.ends_with(']')) {
    which = " " + std::string(key.substr(open + 1, key.size() - open - 2));
    if (const auto next = which.find("]["); next != which.npos) which.replace(next, 2, ",");
    key = key.substr(0, open);
  }
  const SpokenKey said = spoken_key(key);
  return which_of + said.words + which + (said.unit.empty() ? "" : " [" + said.unit + "]");
}

}  // namespace hosel::post
