#include "app/import/session.hpp"

#include "app/import/checks.hpp"
#include "app/import/columns.hpp"
#include "app/import/hands.hpp"
#include "app/import/no_readings.hpp"
#include "app/import/nominal.hpp"
#include "app/import/not_measured.hpp"
#include "app/import/reading.hpp"
#include "app/import/roles.hpp"
#include "loop/deviation.hpp"

namespace hosel::app {

Understood* Session::find(std::string_view stem) {
  for (Understood& u : columns)
    if (!u.name.empty() && split_unit(u.name).stem == stem) return &u;
  return nullptr;
}

void count_again(Understood& u) {
  std::vector<double> values;
  for (const std::string& cell : u.cells)
    if (const auto x = plain_number(cell)) values.push_back(*x * split_unit(u.name).unit->si);
  u.filled = values.size();
  u.median = loop::median(values);
}

Session understand(const std::filesystem::path& from, Sheet sheet, const std::string& club,
                   const ImportOptions& options, const Dictionary& dictionary, const ByHand& by_hand) {
  Reading r{options, dictionary, by_hand, {.file = from, .sheet = std::move(sheet)}, club};
  find_roles(r);
  leave_out_unused(r);
  keep_one_club(r);
  read_columns(r);
  leave_out_placeholders(r);
  one_name_a_club(r);
  leave_out_static_loft(r);
  leave_out_modelled(r);
  leave_out_false_place(r);
  compare_with_landing(r);
  mirror_left_hand(r);
  leave_out_zeros(r);
  derive_face(r);
  leave_out_copies(r);
  check_speeds(r);
  add_nominal(r);
  return std::move(r.session);
}

}  // namespace hosel::app
