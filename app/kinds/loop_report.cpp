#include "hosel/app/kinds/loop_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace hosel::app {

void report_loop(Output& out, const loop::LoopResult& result, std::string_view rows) {
  out.write_json("report.json", loop::to_json(result));
  out.say(loop::sentence(result));
  for (const auto& c : result.channels)
    out.say(
        fmt::format("  {:<22} holdout rmse {:>10.4g} -> {:>10.4g}   bias {:>+10.4g} -> {:>+10.4g}   noise {:.4g} ({})",
                    c.name, c.before.holdout_rmse, c.after.holdout_rmse, c.before.holdout_bias, c.after.holdout_bias,
                    c.noise, c.noise_source));
  if (!result.flagged.empty()) out.say(fmt::format("  {} {} flagged", result.flagged.size(), rows));
  out.write_summary(
      {{"verdict", std::string(name(result.verdict))}, {"adopted", result.adopted}, {"ties", result.ties}});
}

}  // namespace hosel::app
