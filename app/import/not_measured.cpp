#include "app/import/not_measured.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "app/import/cells.hpp"

namespace hosel::app {
namespace {

bool says_modelled(const std::string& text) {
  return std::ranges::any_of(std::array{"estimated", "calculated", "modelled", "modeled"},
                             [&](const char* word) { return text.find(word) != text.npos; });
}

/// The line of the file that explains the mark behind a header: `Spin Rate (rpm)*`, `* estimated from launch data`.
std::string foot_note(const Reading& r, const std::string& header) {
  for (const std::string mark : {"***", "**", "*", "\xE2\x80\xA0", "\xC2\xB9", "\xC2\xB2"}) {
    if (!header.ends_with(mark)) continue;
    std::vector<std::string> lines = r.session.sheet.notes;
    for (const Row& row : r.session.sheet.before) lines.push_back(trimmed(fmt::format("{}", fmt::join(row, " "))));
    for (const std::string& line : lines)
      if (line.starts_with(mark)) return lower(line);
    break;
  }
  return "";
}

/// Face minus path under the name of a place on the face, as one connector writes it: nine cells in ten agree.
bool is_face_to_path(const Understood& u, const Understood* face, const Understood* path) {
  if (!face || !path || !face->filled || !path->filled) return false;
  std::size_t same = 0, seen = 0;
  const double of_face = split_unit(face->name).unit->si / si_of("deg"),
               of_path = split_unit(path->name).unit->si / si_of("deg");
  for (std::size_t i = 0; i < u.cells.size(); ++i) {
    const auto a = plain_number(u.cells[i]), f = plain_number(face->cells[i]), p = plain_number(path->cells[i]);
    if (!a || !f || !p) continue;
    ++seen;
    same += std::abs(*a - (of_face * *f - of_path * *p)) < 0.15;
  }
  return seen > 2 && 10 * same >= 9 * seen;
}

}  // namespace

bool modelled_by_its_header(const Reading& r, const std::string& header) {
  return says_modelled(lower(trimmed(header))) || says_modelled(foot_note(r, header));
}

void leave_out_static_loft(Reading& r) {
  Understood* loft = r.session.find("dynamic_loft");
  if (!loft || !r.dictionary.says("may_be_static", loft->header) || r.by_hand.of(loft->header, r.session.sheet.names))
    return;
  const Understood* clubs = r.session.find("club");
  std::map<std::string, std::pair<std::string, std::size_t>> of;  // club -> loft, shots
  std::size_t most = 0;
  for (std::size_t i = 0; i < r.session.shots; ++i) {
    if (loft->cells[i].empty()) continue;
    auto& [first, n] = of.try_emplace(clubs ? clubs->cells[i] : "", loft->cells[i], 0).first->second;
    if (first != loft->cells[i]) return;
    most = std::max(most, ++n);
  }
  if (most < 5) return;
  loft->name.clear();
  loft->note = fmt::format(
      "the same in every shot: the club's own loft, not that at impact; --column "
      "'{}=dynamic_loft_deg' takes it",
      loft->header);
}

void leave_out_modelled(Reading& r) {
  for (std::size_t c = 0; c < r.roles.size(); ++c) {
    if (r.roles[c] != "accuracy" || r.options.modelled) continue;
    const std::string& header = r.session.sheet.names[c];
    // A header that the dictionary has for it is about spin in any language.
    const bool of_spin = says_any(header, {"spin"}) ||
                         (r.dictionary.bookkeeping_of(header) == "accuracy" && !says_any(header, {"accuracy"})),
               asks = says_any(header, {"measured"}), of_axis = says_any(header, {"axis"});
    const auto estimated = [&](const std::string& cell) {
      return r.dictionary.begins_or_ends("estimated", cell) || (asks && yes_or_no(cell) == false) ||
             says_any(cell, {"estim", "calc", "model", "simul", "predict"});
    };
    const auto measured = [&](const std::string& cell) {
      return r.dictionary.begins_or_ends("measured", cell) || (asks && yes_or_no(cell) == true);
    };
    // A word that is neither leaves the spin out too, where others are known; a column of other words says nothing.
    const bool speaks = of_spin && std::ranges::any_of(r.session.sheet.rows, [&](const Row& row) {
                          return estimated(row[c]) || measured(row[c]);
                        });
    std::vector<bool> rate, axis;
    for (const Row& row : r.session.sheet.rows) {
      const bool open = speaks && !missing(row[c]) && !measured(row[c]);
      rate.push_back((open && !of_axis) || says_any(row[c], {"spinrate", "spin rate"}));
      axis.push_back(open || says_any(row[c], {"spinaxis", "spin axis"}));
    }
    for (const char* q : {"spin_rate", "backspin", "sidespin"})
      if (Understood* u = r.session.find(q)) r.session.modelled = std::max(r.session.modelled, blank(*u, rate));
    if (Understood* u = r.session.find("spin_axis")) blank(*u, axis);
  }
}

void leave_out_false_place(Reading& r) {
  if (Understood* u = r.session.find("impact_toe");
      u && is_face_to_path(*u, r.session.find("face_angle"), r.session.find("club_path")))
    u->name.clear(), u->note = "holds face angle minus path";
}

void derive_face(Reading& r) {
  if (Understood* across = r.session.find("face_to_path")) {
    const Understood* path = r.session.find("club_path");
    if (path && across->filled && path->filled && !r.session.find("face_angle")) {
      Understood face;
      face.header = across->header + " + " + path->header;
      face.name = "face_angle_deg";
      const double a = split_unit(across->name).unit->si, p = split_unit(path->name).unit->si;
      for (std::size_t i = 0; i < r.session.shots; ++i) {
        const auto x = plain_number(across->cells[i]), y = plain_number(path->cells[i]);
        face.cells.push_back(x && y ? fmt::format("{:.6g}", (a * *x + p * *y) / si_of("deg")) : "");
      }
      count_again(face);
      r.session.columns.push_back(std::move(face));
    }
    across = r.session.find("face_to_path");
    across->name.clear(), across->note = "face minus path";
  }
}

void leave_out_copies(Reading& r) {
  // Spin stands twice in most exports: rate and tilt are what is measured, back and side follow from them.
  // Where a row has the one and not the other, nothing follows.
  Understood *rate = r.session.find("spin_rate"), *axis = r.session.find("spin_axis"),
             *back = r.session.find("backspin"), *side = r.session.find("sidespin");
  if (rate && rate->filled && axis && axis->filled) {
    const auto has = [](const Understood* u, std::size_t row) { return u && !u->cells[row].empty(); };
    bool follows = true;
    for (std::size_t row = 0; row < rate->cells.size(); ++row)
      follows = follows && (has(rate, row) && has(axis, row) ? true : !has(back, row) && !has(side, row));
    for (Understood* u : {back, side})
      if (u && follows) u->name.clear(), u->note = "follows from rate and axis";
  }
  for (Understood& u : r.session.columns)
    if (!u.name.empty() && u.filled == 0) {
      u.name.clear();
      if (u.note.empty()) u.note = "empty";
    }
}

}  // namespace hosel::app
