#include "app/kinds/restitution_face.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "app/read_face.hpp"
#include "app/read_plate.hpp"
#include "models/fe/plate_strike.hpp"
#include "models/reduced/face_strike.hpp"
#include "post/figure.hpp"

namespace hosel::app {
namespace {

class RestitutionFaceJob final : public Job {
 public:
  explicit RestitutionFaceJob(CaseFile& file) {
    Table root = file.root();
    ball_ = read_ball(root.table("ball"));
    head_ = read_head(root.table("head"));
    plate_ = read_optional_plate(root);
    if (!plate_) face_ = read_yielding_face(root);
    if (face_.mass >= head_.mass) root.fail("face", "the face's effective mass is part of the head's");
    Table grid = root.table("grid");
    speed_ = grid.quantity({"speed", "of the ball against the head at rest"}, "mps", {1, 100}, 48.77);
    toe_ = grid.quantities({"toe", "points of the grid, towards the toe"}, "mm", 0, {-0.1, 0.1});
    high_ = grid.quantities({"high", "points of the grid, up the face"}, "mm", 0, {-0.1, 0.1});
  }

  void run(Output& out) override {
    const models::Striker ball = models::golf_ball(ball_);
    std::string csv = "toe_mm,high_mm,mass_kg,restitution,restitution_rigid,ball_speed_ratio,ball_speed_ratio_rigid\n";
    std::optional<models::PlateStrike> plate;
    if (plate_) plate.emplace(std::make_shared<const models::PlateFace>(*plate_, head_.face), head_);
    const auto restitution_at = [&](double toe, double high, double mass) {
      if (plate)
        return plate->strike(ball, plate->at(Eigen::Vector2d(-toe, high), models::kBallPatch), speed_).restitution;
      return models::strike(ball, mass, face_, face_.shape(-toe, high).value, speed_).restitution;
    };
    std::vector<double> e_map, gain_map;
    nlohmann::json summary;
    for (const double high : high_)
      for (const double toe : toe_) {
        const double mass = models::mass_at(head_, -toe, high);
        const double e = restitution_at(toe, high, mass), rigid = models::strike(ball, mass, {}, 0, speed_).restitution;
        const auto ratio = [&](double restitution) { return (1 + restitution) * mass / (mass + ball_.mass); };
        csv += fmt::format("{:g},{:g},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f}\n", 1e3 * toe, 1e3 * high, mass, e, rigid,
                           ratio(e), ratio(rigid));
        e_map.push_back(e);
        gain_map.push_back(ratio(e));
        if (toe == 0 && high == 0) {
          out.say(
              fmt::format("centre: restitution {:.4f} (rigid {:.4f}), ball speed {:.4f} of the head's (rigid {:.4f})",
                          e, rigid, ratio(e), ratio(rigid)));
          out.page().answer("restitution at the centre", fmt::format("{:.4f}", e), fmt::format("rigid {:.4f}", rigid));
          out.page().answer("ball speed over head speed", fmt::format("{:.4f}", ratio(e)),
                            fmt::format("rigid {:.4f}", ratio(rigid)));
          summary = {{"restitution", e},
                     {"restitution_rigid", rigid},
                     {"ball_speed_ratio", ratio(e)},
                     {"ball_speed_ratio_rigid", ratio(rigid)}};
        }
      }
    out.write("map.csv", csv);
    const auto panel = [&](std::string title, std::vector<double> values, std::string label) {
      post::Panel p{.title = std::move(title), .x_label = "towards the toe [mm]", .y_label = "up the face [mm]"};
      for (const double x : toe_) p.map_x.push_back(1e3 * x);
      for (const double y : high_) p.map_y.push_back(1e3 * y);
      p.map = std::move(values);
      p.map_label = std::move(label);
      p.map_equal_axes = true;
      return p;
    };
    post::Figure figure{
        .panels = {panel("restitution", e_map, "[-]"), panel("ball speed over head speed", gain_map, "[-]")},
        .columns = 2};
    out.draw(figure, "restitution-face");
    const auto [least, largest] = std::ranges::minmax(e_map);
    out.page().answer("over the face", fmt::format("{:.4f} to {:.4f}", least, largest), "restitution");
    summary["largest_restitution"] = largest;
    summary["least_restitution"] = least;
    out.write_summary(summary);
  }

 private:
  Ball ball_;
  Head head_;
  FaceCompliance face_;  // where there is no plate
  std::optional<models::PlateDesign> plate_;
  double speed_ = 0;
  std::vector<double> toe_, high_;
};

}  // namespace

std::unique_ptr<Job> read_restitution_face(CaseFile& file) { return std::make_unique<RestitutionFaceJob>(file); }

}  // namespace hosel::app
