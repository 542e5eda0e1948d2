#include "app/asked_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "app/cases.hpp"
#include "app/job.hpp"
#include "app/library.hpp"
#include "app/of_file.hpp"
#include "app/read_blow.hpp"
#include "app/read_options.hpp"
#include "golf/parallel.hpp"
#include "models/checked_launch.hpp"
#include "models/registry.hpp"

namespace hosel::app {
namespace {

/// Inputs by which a case chooses its ball's parameters, and by which its head may be refused.
constexpr std::array kChoosing = {Input::head_mass, Input::attack_angle, Input::club_path, Input::face_angle,
                                  Input::dynamic_loft};

/// As `--set` takes it.
std::string setting(Input input, double value) {
  return input == Input::head_mass ? fmt::format("head.mass_kg={}", value)
                                   : fmt::format("delivery.{}_rad={}", stem(input), value);
}

std::string set_name(Table root) {
  const std::optional<NamedContact> contact = named_contact(std::move(root));
  return contact ? contact->name : "";
}

bool has_several_sets(Table root) {
  auto ball = root.optional_table("ball");
  const auto model = ball ? named_entry(*ball, "model", Shelf::balls) : std::nullopt;
  return model && library_ball(*model).reduced.size() > 1;
}

}  // namespace

/// What a model is made of for the blows of one set of parameters.
struct AskedModel::Set {
  ContactLaw contact;
  std::unique_ptr<models::ImpactModel> model;
};

AskedModel::AskedModel(const std::string& where, const std::string& name, const std::vector<std::string>& overrides)
    : file_(find_case(where), overrides), name_(name) {
  Table root = file_.root();
  if (root.has("motion"))
    root.fail("motion",
              "a swing delivers the club here, and a model is asked about stated deliveries: hosel.run answers this "
              "case, hosel.Study varies its keys");
  if (root.has("matched_launch") && root.flag({"matched_launch"}, false))
    root.fail("matched_launch",
              "the loft of each blow would be sought, and a model is asked about stated deliveries: hosel.run answers "
              "this case");
  CaseFile whole(file_, overrides);
  read_job(whole);
  if (name_.empty()) name_ = read_models(root).front();
  const models::ModelEntry* entry = models::find(name_);
  if (!entry) throw InputError(fmt::format("no model '{}'; `hosel list` shows them", name_));
  blow_ = read_blow(root, {name_});
  const models::Options options = read_options(root, {name_}, blow_);
  plate_ = options.plate;
  several_ = has_several_sets(root);
  sets_[set_name(root)] = std::make_unique<const Set>(blow_.contact, entry->make(options));
}

AskedModel::~AskedModel() = default;

/// The case with what chooses its parameters taken from a blow.
CaseFile AskedModel::with(const Blow& blow) const {
  std::vector<std::string> overrides = file_.overrides();
  for (const Input input : kChoosing)
    if (const double value = get(blow, input); value != get(blow_, input)) overrides.push_back(setting(input, value));
  return CaseFile(file_, overrides);
}

const AskedModel::Set& AskedModel::set_for(const Blow& blow) const {
  CaseFile file = with(blow);
  Table root = file.root();
  read_head(root.table("head"), name_ != "rigid-planar");
  const std::string called = set_name(root);
  const std::lock_guard lock(mutex_);
  if (const auto it = sets_.find(called); it != sets_.end()) return *it->second;
  Blow made = blow_;
  made.contact = read_contact(root, {name_});
  const models::Options options = read_options(root, {name_}, made);
  return *(sets_[called] = std::make_unique<const Set>(made.contact, models::find(name_)->make(options)));
}

std::string AskedModel::doubt(std::size_t count, std::span<const Input> inputs, std::span<const double> values) const {
  Blow blow = blow_;
  std::size_t off = 0, first = 0;
  std::string sentence;
  for (std::size_t i = 0; i < count && std::isfinite(blow.club.head.mass); ++i) {
    for (std::size_t c = 0; c < inputs.size(); ++c) set(blow, inputs[c], values[i * inputs.size() + c]);
    std::string found = off_the_face(blow, plate_ ? &plate_->design().outline : nullptr);
    if (!found.empty() && off++ == 0) first = i, sentence = std::move(found);
  }
  return off == 0 ? "" : fmt::format("{} of {} blows; the first is blow {}: {}", off, count, first, sentence);
}

std::vector<models::Answer> AskedModel::launches(std::size_t count, std::span<const Input> inputs,
                                                 std::span<const double> values) const {
  const auto take = [&](std::size_t i, Blow& b) -> const Blow& {
    for (std::size_t c = 0; c < inputs.size(); ++c) set(b, inputs[c], values[i * inputs.size() + c]);
    return b;
  };
  const auto blow = [&](std::size_t i) {
    Blow b = blow_;
    take(i, b);
    return b;
  };
  Blow one = blow_;        // a shaft is large: it is not copied for every blow
  const StudyFiles files;  // the library is looked at once for all blows
  std::size_t first = count;
  std::string why;
  const auto refuse = [&](std::size_t i, const std::string& sentence) {
    if (i < first) first = i, why = sentence;
  };

  // Blows that the case tells apart by nothing have one set.
  struct Choice {
    std::size_t first;  // of these blows
    const Set* set = nullptr;
    std::string refusal = {};
  };
  std::map<std::array<double, kChoosing.size()>, Choice> choices;
  std::vector<const Choice*> chosen(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Blow& b = take(i, one);
    std::array<double, kChoosing.size()> by{};
    for (std::size_t k = 0; k < by.size(); ++k)
      if (several_ || kChoosing[k] == Input::head_mass) by[k] = get(b, kChoosing[k]);
    chosen[i] = &choices.try_emplace(by, i).first->second;
  }
  std::vector<Choice*> different;
  for (auto& [by, choice] : choices) different.push_back(&choice);
  for_all(std::size_t{0}, different.size(), [&](std::size_t k) {
    try {
      different[k]->set = &set_for(blow(different[k]->first));
    } catch (const InputError& e) { different[k]->refusal = e.what(); }
  });
  std::map<const Set*, std::vector<std::size_t>> of_set;
  for (std::size_t i = 0; i < count; ++i)
    if (chosen[i]->set) of_set[chosen[i]->set].push_back(i);
    else refuse(i, chosen[i]->refusal);

  // Within what was seen are all blows of a set where the hull of their uses is; else each is looked at.
  const auto beyond = [&](std::size_t i, const Use& use) {
    try {
      check_use(with(blow(i)).root(), use, {name_});
    } catch (const InputError& e) { return std::string(e.what()); }
    return std::string();
  };
  for (const auto& [set, members] : of_set) {
    Use hull = use_of(take(members.front(), one));
    for (const std::size_t i : members) hull = both(hull, use_of(take(i, one)));
    if (beyond(members.front(), hull).empty()) continue;
    for (const std::size_t i : members)
      if (const std::string sentence = beyond(i, use_of(take(i, one))); !sentence.empty()) {
        refuse(i, sentence);
        break;
      }
  }
  if (first < count) throw InputError(fmt::format("blow {}: {}", first, why));

  std::vector<models::Answer> answers(count);
  for (const auto& [set, members] : of_set)
    for_all(tbb::blocked_range<std::size_t>(0, members.size()), [&](const tbb::blocked_range<std::size_t>& range) {
      constexpr std::size_t most = 64;  // at a time
      Blow own = blow_;
      own.contact = set->contact;
      std::vector<Blow> blows(std::min(most, range.size()), own);
      for (std::size_t from = range.begin(); from < range.end(); from += most) {
        const std::size_t n = std::min(most, range.end() - from);
        for (std::size_t k = 0; k < n; ++k) take(members[from + k], blows[k]);
        std::vector<models::Answer> found = models::checked_launches(*set->model, std::span(blows).first(n));
        for (std::size_t k = 0; k < n; ++k) answers[members[from + k]] = std::move(found[k]);
      }
    });
  return answers;
}

}  // namespace hosel::app
