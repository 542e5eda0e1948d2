/// Watches a finite-element impact: history.csv at every step, VTK series at every few.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "golf/blow.hpp"
#include "models/fe/impact.hpp"
#include "post/ball_section.hpp"
#include "post/moving_blow.hpp"

namespace hosel::post {

struct RecorderOptions {
  bool vtk = true;
  int steps_per_frame = 4;   ///< accepted steps between VTK frames
  bool checkpoints = true;   ///< leave some on the way, and go on from one
  int angles = 32;           ///< of the revolved ball
  double face_width = 0.08;  ///< of the drawn face, heel to toe [m]
  double face_height = 0.05;
};

class ImpactRecorder {
 public:
  /// Writes DIRECTORY/history.csv and DIRECTORY/vtk/{ball,patch,face,head,shaft,hands}.pvd, and with every eighth frame
  /// DIRECTORY/checkpoint.cbor. `run` names what is computed and by which build: where a checkpoint of the same run
  /// lies there, whole, and beside it all that had been written, the run goes on with it to the same bytes; where
  /// anything is missing or changed, it begins afresh.
  ImpactRecorder(std::filesystem::path directory, const Blow& blow, RecorderOptions options, std::string run);
  ~ImpactRecorder();
  void operator()(const models::ImpactView& view);
  /// The ball when the force was largest; nothing where there was none.
  const std::optional<BallSection>& at_largest_force() const;
  /// The blow in three dimensions; kept with the checkpoints.
  const MovingBlow& moving() const;
  /// Where the impact goes on from; null: from the start.
  const models::ImpactCheckpoint* resume() const;
  /// The series written, for a person to open.
  std::vector<std::filesystem::path> files() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hosel::post
