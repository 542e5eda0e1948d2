#include "app/kinds/impact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "models/registry.hpp"
#include "post/launch_table.hpp"

namespace hosel::app {
namespace {

class ImpactJob final : public Job {
 public:
  explicit ImpactJob(CaseFile& file) {
    Table root = file.root();
    std::vector<std::string> names;
    for (const auto& m : models::registry()) names.emplace_back(m.name);
    models_ = root.texts("models");
    if (models_.empty()) root.fail("models", "name at least one model");
    for (const std::string& m : models_)
      if (!models::find(m)) {
        const std::string near = nearest(m, names);
        root.fail("models", near.empty() ? fmt::format("no model '{}'; `hosel list` shows them", m)
                                         : fmt::format("no model '{}'; did you mean '{}'?", m, near));
      }
    blow_.ball = root.has("ball") ? read_ball(root.table("ball")) : Ball{};
    const bool whole = std::ranges::any_of(models_, [](const std::string& m) { return m != "rigid-planar"; });
    blow_.club.head = read_head(root.table("head"), whole);
    blow_.delivery = read_delivery(root.table("delivery"));
    if (auto contact = root.optional_table("contact")) blow_.contact = read_contact_law(*contact);
    if (auto measured = root.optional_table("measured"))
      for (const std::string& key : measured->keys()) {
        const SplitName split = split_unit(key);
        const post::Channel* channel = post::find_channel(split.stem);
        if (!channel) measured->fail(key, fmt::format("no launch quantity of this name (known: {})", post::channel_names()));
        measured_.emplace_back(channel, measured->quantity(split.stem, std::string(channel->unit)));
      }
  }

  void run(Output& out) override {
    nlohmann::json summary;
    std::vector<post::LaunchColumn> columns;
    for (const std::string& name : models_) {
      const auto model = models::find(name)->make(models::Options{});
      const Launch launch = model->launch(blow_);
      columns.push_back({name, launch});
      summary["models"][name] = post::to_json(launch);
    }
    for (const auto& [channel, value] : measured_)
      summary["measured"][fmt::format("{}_{}", channel->name, channel->unit)] = value / channel->si;
    out.say(post::launch_table(columns, measured_));
    out.write_summary(summary);
  }

 private:
  std::vector<std::string> models_;
  Blow blow_;
  post::Measured measured_;
};

}  // namespace

std::unique_ptr<Job> read_impact(CaseFile& file) { return std::make_unique<ImpactJob>(file); }

}  // namespace hosel::app
