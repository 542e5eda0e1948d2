#include "app/run_page.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/command_help.hpp"
#include "app/job.hpp"
#include "app/shipped.hpp"
#include "app/version.hpp"
#include "golf/units.hpp"
#include "post/file.hpp"
#include "post/html.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
using post::escape_html;

void RunPage::answer(std::string_view what, std::string_view value, std::string_view note) {
  answers_ += fmt::format("<div><span>{}</span><b>{}</b><small style='display:block'>{}</small></div>",
                          escape_html(std::string(what)), escape_html(std::string(value)),
                          escape_html(std::string(note)));
}

void RunPage::sentence(std::string_view text) {
  sentences_ += "<p class='lead'><b>" + escape_html(std::string(text)) + "</b></p>";
}

void RunPage::answer(const post::TextTable& table) { tables_ += table.html(); }

void RunPage::close_figures() {
  if (!figures_.empty()) body_ += "<div class='figures'>" + figures_ + "</div>";
  figures_.clear();
}

void RunPage::section(std::string_view heading, std::string_view html) {
  close_figures();
  sections_ = true;
  if (!heading.empty()) body_ += fmt::format("<h2>{}</h2>", escape_html(std::string(heading)));
  body_ += html;
}

void RunPage::figure(std::string_view caption, std::string svg) {
  figures_ += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>", svg, escape_html(std::string(caption)));
}

bool RunPage::add_script(const std::string& name, std::string_view missing) {
  const fs::path folder = shipped("post/viewer", "viewer"), text = folder / (name + ".js");
  if (!fs::exists(text)) {
    doubt(fmt::format("{}: {} is not installed.", missing, text.string()));
    return false;
  }
  std::string checksum = post::read_file(folder / (name + ".sha256"));
  while (checksum.ends_with('\n')) checksum.pop_back();
  const auto same = [&](const post::PageScript& s) { return s.checksum == checksum; };
  if (std::ranges::none_of(scripts_, same)) scripts_.push_back({post::read_file(text), checksum});
  return true;
}

namespace {

/// Data between <script> tags, which no text in it can end.
std::string json_in_page(const nlohmann::json& data) {
  std::string text = data.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != text.npos;) text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace

void RunPage::sliders(std::string_view caption, const nlohmann::json& study) {
  if (study.is_null() || !add_script("sliders", "The sliders are missing")) return;
  close_figures();
  body_ += fmt::format(
      "<figure class='sliders' data-sliders='sliders-{0}' hidden><div "
      "data-part='parameters'></div><table><tr><th>answer"
      "<th>here<th class='l' data-part='along'></tr></table><figcaption>{1}</figcaption></figure><script "
      "type='application/json' id='sliders-{0}'>{2}</script>",
      ++moving_, escape_html(std::string(caption)), json_in_page(study));
}

void RunPage::moving(std::string_view caption, const std::string& blow) {
  if (blow.empty()) return;
  if (!add_script("viewer", "The moving picture is not drawn")) return;
  close_figures();
  const std::string said = escape_html(std::string(caption));
  body_ += fmt::format(
      "<figure class='moving wide' data-blow='blow-{0}' hidden><p><button data-view='side'>From the "
      "side</button><button "
      "data-view='face'>Through the face</button><button data-view='club'>Whole club</button><label>colours <select "
      "data-part='colour'><option value='stress'>stress<option value='pressure'>pressure</select></label><label><input "
      "type='checkbox' data-part='cut'> cut open</label></p><div data-part='view' role='img' aria-label='{1}'></div><p>"
      "<button data-part='play'>Play</button><input type='range' data-part='time' min='0' max='0' value='0' "
      "aria-label='time'><output data-part='said'></output></p><p data-part='legend'><b></b><span>0</span><i></i><span>"
      "</span></p><figcaption>{1} Drag to turn it; ctrl and the wheel zoom.</figcaption></figure><script "
      "type='application/json' id='blow-{0}'>{2}</script>",
      ++moving_, said, blow);
}

void RunPage::figure(const post::Figure& figure, const fs::path& stem) {
  close_figures();
  const auto panels = post::panel_files(figure, stem.string());
  if (!figure.title.empty()) body_ += "<p class='soft'>" + escape_html(figure.title) + "</p>";
  constexpr std::size_t kTold = 1500;  // places of a map at most that tell their values
  for (const post::PanelFile& p : panels) {
    const post::Panel& panel = figure.panels[p.panel];
    if (!panel.on_page) continue;
    const bool tells = p.map ? panel.map.size() <= kTold : post::tells_values(panel);
    std::string drawn = fmt::format("<img class='{}' alt='{}' src='{}'>", p.map ? "map" : "curves",
                                    escape_html(p.title), post::data_uri(p.picture));
    if (p.map && tells) {
      drawn = fmt::format("<div class='told'>{}{}</div>", drawn, post::map_values(panel, p));
    } else if (tells) {
      // In the page's own text: points tell their values nowhere else.
      drawn = post::read_file(p.picture);
      drawn.erase(0, drawn.find("<svg"));
      drawn.insert(4, fmt::format(" class='curves' role='img' aria-label='{}'", escape_html(p.title)));
    }
    figures_ += fmt::format("<figure{}>{}</figure>", panels.size() == 1 ? " class='alone'" : "", drawn);
  }
  close_figures();
}

void RunPage::link(std::string_view file) {
  links_ += fmt::format("<li><a href='{0}'>{0}</a>", escape_html(std::string(file)));
}

void RunPage::doubt(std::string_view text) { doubts_ += "<li>" + escape_html(std::string(text)); }

void RunPage::print(std::string_view line) { printed_ += std::string(line) + '\n'; }

void RunPage::suggest(std::string_view why, std::string_view command) { next_.emplace_back(why, command); }

namespace {

std::string value_text(const toml::node& node) {
  std::ostringstream out;
  if (const auto text = node.value<std::string>(); node.is_string()) out << *text;
  else if (node.is_array()) out << toml::toml_formatter(*node.as_array(), toml::format_flags::relaxed_float_precision);
  else if (const auto number = node.value<double>(); node.is_floating_point()) return fmt::format("{:.6g}", *number);
  else node.visit([&](const auto& n) { out << n; });
  return out.str();
}

/// The keys of a table that are no tables, as rows; then its tables, each under its own name.
void add_inputs(std::string& html, const std::string& name, const toml::table& table) {
  std::string rows;
  for (const auto& [key, node] : table) {
    if (node.is_table() || (node.is_array() && node.as_array()->is_homogeneous(toml::node_type::table))) continue;
    const post::SpokenKey said = post::spoken_key(key.str());
    rows += fmt::format("<tr><td>{}<td>{}{}</tr>", escape_html(said.words), escape_html(value_text(node)),
                        said.unit.empty() ? "" : " " + escape_html(said.unit));
  }
  if (!rows.empty())
    html += fmt::format("<table><tr><th colspan='2'>{}</tr>{}</table>",
                        escape_html(name.empty() ? "the case" : post::spoken(name)), rows);
  for (const auto& [key, node] : table) {
    const std::string inner = (name.empty() ? "" : name + ": ") + std::string(key.str());
    if (const toml::table* t = node.as_table()) add_inputs(html, inner, *t);
    const toml::array* list = node.as_array();
    if (!list || !list->is_homogeneous(toml::node_type::table)) continue;
    for (std::size_t i = 0; i < list->size(); ++i)
      add_inputs(html, fmt::format("{} {}", inner, i + 1), *list->get(i)->as_table());
  }
}

std::string now() {
  const std::time_t t = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&t, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc);
  return text;
}

std::string commands(const std::string& lines) { return "<pre class='command'>" + escape_html(lines) + "</pre>"; }

}  // namespace

std::string RunPage::html(const std::string& resolved, const std::string& command, const fs::path& directory) const {
  RunPage whole = *this;
  whole.close_figures();
  const toml::table table = toml::parse(resolved);
  const std::string title = table["title"].value_or(""), kind = table["kind"].value_or("impact");
  const auto known = std::ranges::find(kinds(), kind, &Kind::name);
  const std::string question(known == kinds().end() ? "" : known->question);
  std::string s = fmt::format("<h1>{}</h1>", escape_html(title.empty() ? question : title));
  s += sentences_;
  if (!title.empty()) s += "<p class='lead'>" + escape_html(question) + "</p>";
  if (!answers_.empty()) s += "<div class='answers'>" + answers_ + "</div>";
  s += tables_;
  const std::string printed = "<pre>" + escape_html(printed_) + "</pre>";
  const bool own = !answers_.empty() || !tables_.empty() || sections_;
  if (!own && !printed_.empty()) s += printed;
  if (!doubts_.empty()) s += "<div class='verdict open'><b>In doubt</b><ul>" + doubts_ + "</ul></div>";
  s += whole.body_;
  if (!links_.empty()) s += "<h2>More pictures</h2><ul>" + links_ + "</ul>";
  std::string inputs;
  add_inputs(inputs, "", table);
  s += "<h2>What to try next</h2><ul>";
  for (const auto& [why, how] : next_) s += "<li>" + escape_html(why) + commands(how);
  s += fmt::format("<li>Every key that such a case takes, with unit, range and default:{}</ul>",
                   commands("hosel keys " + kind));
  s += "<h2>Inputs</h2><div class='inputs'>" + inputs + "</div>";
  s += "<h2>The same again</h2>" +
       commands((command.empty() ? "" : command + "\n") + "hosel run " +
                shell_word((directory / "case.resolved.toml").string()) + " --out " + beside_out(directory, "again")) +
       fmt::format(
           "<p><small>hosel {}, {}. The last command needs no default of this version: the case beside this "
           "page names every one; summary.json there has the numbers.</small></p>",
           escape_html(program_version()), now());
  if (own && !printed_.empty()) s += "<h2>Printed by the run</h2>" + printed;
  return post::html_page(title.empty() ? question : title, s, scripts_);
}

}  // namespace hosel::app
