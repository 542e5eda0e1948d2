/// Watches a swing: VTK series of shaft, head and hands, and what the shaft's sections carry.
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "models/club/swing.hpp"
#include "post/bodies.hpp"
#include "post/shaft_loads.hpp"
#include "post/vtk_series.hpp"

namespace hosel::post {

struct SwingRecorderOptions {
  bool vtk = true;
  int steps_per_frame = 10;  ///< accepted steps between frames
};

class SwingRecorder {
 public:
  /// Writes DIRECTORY/vtk/{shaft,head,hands,trail}.pvd and DIRECTORY/shaft.csv: a row for every node of the shaft in
  /// every frame. Without `vtk` the table alone. `club` and `swing` must outlive this.
  SwingRecorder(std::filesystem::path directory, const Club& club, const models::Swing& swing,
                SwingRecorderOptions options);
  /// At every step.
  void operator()(const models::SwingSample& sample, const fem::State& state);
  /// Writes the table. Throws std::runtime_error where the disk refuses.
  void finish() const;

  /// What the shaft's sections carry along it, at five instants of the last `span` [s].
  Figure figure(double span) const;
  /// The series in a run's directory, for a person to open.
  static std::vector<std::filesystem::path> files(const std::filesystem::path& directory);

 private:
  void write(const char* body, double time, const VtkMesh& mesh);

  std::filesystem::path directory_;
  const Club& club_;
  const models::Swing& swing_;
  SwingRecorderOptions options_;
  VtkMesh head_;  // face frame
  std::map<std::string, VtkSeries> series_;
  ShaftLoads loads_;
  std::vector<Vec3> trail_;  // of the head's centre of gravity, by frame
  long steps_ = 0;
};

}  // namespace hosel::post
