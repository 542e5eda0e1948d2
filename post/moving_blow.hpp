/// A blow in three dimensions, frame by frame: what a page shows that moves.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/fe/impact.hpp"
#include "post/vtk_series.hpp"

namespace hosel::post {

/// Places are global [m], stresses in Pa, single precision. Bodies: `ball`, its surface; `section`, the ball cut in the
/// plane of the mesh's axis and the direction of slip; `face`; `head`; `shaft` of a full club.
struct MovingBlow {
  struct Body {
    std::string name;
    int points = 0;
    /// Of the surface: rows of points from the contact pole to the other, and points around in each. The first half of
    /// each row, and the first of the other, stay when the half that lies nearer the toe is cut away.
    std::array<int, 2> grid{};
    /// Of the section eight points an element (mesh::Meridian::elements), of face and head three a triangle.
    std::vector<int> cells;
    std::vector<double> radius;  ///< of the shaft at its points [m]
  };
  struct Instant {
    std::vector<float> place;             ///< x, y, z of each point
    std::vector<float> stress, pressure;  ///< von Mises stress and contact pressure at each point; empty: none
  };
  struct Frame {
    double time = 0;              ///< [s]
    double force = 0;             ///< normal, of the face on the ball [N]
    Vec3 centre = Vec3::Zero();   ///< of the ball's mass [m]
    std::vector<Instant> bodies;  ///< in the order of MovingBlow::bodies
  };
  double radius = 0;                  ///< of the ball at rest [m]
  Mat3 face_axes = Mat3::Identity();  ///< at the start: columns, global
  std::vector<Body> bodies;
  std::vector<Frame> frames;
  long stride = 1;  ///< steps from one frame to the next

  static constexpr std::size_t most = 48;  ///< frames; where one more comes, every second is dropped

  /// Whether a frame of this step of the run is wanted.
  bool wants(long step) const { return step % stride == 0; }
  /// Adds a frame of a step that is wanted: the ball as ball_mesh makes it with `angles`, face and head as `placed`
  /// does, the shaft or null.
  void add(const models::ImpactView& view, const VtkMesh& ball, int angles, const VtkMesh& face, const VtkMesh& head,
           const VtkMesh* shaft);
  /// Whether every frame has all points of every body, and cells name points.
  bool whole() const;
};

/// JSON for post/viewer/viewer.mjs that may stand in an HTML page as it is: places and stresses rounded to 16 bits over
/// their ranges, in base64. At most 4 MB: of more, every second frame is left out. Empty where there is no frame, or
/// where the cells of a body count more points than 16 bits do.
std::string json_for_viewer(const MovingBlow& blow);

}  // namespace hosel::post
