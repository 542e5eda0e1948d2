#include "loop/shots/way.hpp"

namespace hosel::loop {

std::vector<Way> ways(const ShotModel& model, const Shots& shots) {
  std::vector<Way> all;
  const auto add = [&](std::string acts, std::string column, Way::Kind kind, double scale) -> Parametrisation& {
    Parametrisation form{.effect = "", .what = acts, .parameters = {{"size", "1", 1, -1e9, 1e9, scale}}};
    all.push_back({std::move(acts), std::move(column), std::move(form), kind});
    return all.back().form;
  };
  add("the normal restitution", "", Way::Kind::normal, 0.01).before = [](Sizes p, Shot& s) {
    s.blow.contact.restitution += p[0];
  };
  add("the tangential restitution", "", Way::Kind::tangential, 0.02).before = [](Sizes p, Shot& s) {
    s.blow.contact.tangential_restitution += p[0];
  };
  for (int k = 0; k < kInputs; ++k)
    if (const Column* c = shots.find_stem(stem(Input(k))); c && c->role == Role::input)
      add("an error of " + c->name, c->name, Way::Kind::input, quantity(Input(k)).step).before = [k](Sizes p, Shot& s) {
        set(s.blow, Input(k), get(s.blow, Input(k)) + p[0]);
      };
  for (int c = 0; c < model.width(); ++c) {
    const ShotChannel& ch = model.channel(c);
    add("an error of the reading " + ch.name, ch.name, Way::Kind::reading, ch.noise * ch.si).reading =
        [o = ch.output](Sizes p, const Shot&, Output of, double value) { return of == o ? value + p[0] : value; };
  }
  return all;
}

}  // namespace hosel::loop
