#include "app/kinds/impact.hpp"

#include <fmt/format.h>

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
    models_ = read_models(root);
    blow_ = read_blow(root, models_);
    options_ = read_options(root);
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
      const auto model = models::find(name)->make(options_);
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
  models::Options options_;
  post::Measured measured_;
};

}  // namespace

std::unique_ptr<Job> read_impact(CaseFile& file) { return std::make_unique<ImpactJob>(file); }

}  // namespace hosel::app
