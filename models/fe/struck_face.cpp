#include "models/fe/struck_face.hpp"

#include <cmath>
#include <stdexcept>

#include "fem/face_surface.hpp"
#include "fem/yielding_face.hpp"

namespace hosel::models {
namespace {

class RigidFace final : public StruckFace {
 public:
  bool symmetric(Mirror, const Face&) const override { return true; }
  FaceInSystem add(fem::System&, const FaceBlow& struck) const override {
    return {.surface = std::make_unique<fem::FaceSurface>(struck.blow.club.head.face)};
  }
};

class LumpedFace final : public StruckFace {
 public:
  explicit LumpedFace(const FaceCompliance& face) : face_(face) {}
  bool symmetric(Mirror mirror, const Face&) const override {
    return mirror != Mirror::none && face_.ellipse()(0, 1) == 0;
  }

  FaceInSystem add(fem::System& system, const FaceBlow& struck) const override {
    const Head& head = struck.blow.club.head;
    if (!(face_.mass < head.mass))
      throw std::invalid_argument("fe impact: the face's effective mass is part of the head's and must be smaller");
    const bool everywhere = std::isinf(face_.half_width) && std::isinf(face_.half_height),
               centre = struck.place().isZero(0) && face_.half_width == face_.half_height;
    if (struck.axial && !everywhere && !centre)
      throw std::invalid_argument(
          "fe impact: harmonics = 0 is the axisymmetric ball: a yielding face must be as wide as high and struck at "
          "its centre");
    const fem::DofMap::Block travel = system.dof_map.add_vector(1);
    FaceInSystem out{.surface = std::make_unique<fem::YieldingFace>(head.face, face_, travel)};
    out.spring = std::make_unique<fem::FaceSpring>(fem::ReducedFace::lumped(face_), struck.carrier, travel);
    const double shape = face_.shape(struck.place().x(), struck.place().y()).value;
    out.compliance = shape * shape / face_.stiffness;
    return out;
  }

 private:
  FaceCompliance face_;
};

}  // namespace

std::shared_ptr<const StruckFace> own_face(const Head& head) {
  if (head.compliance) return std::make_shared<LumpedFace>(*head.compliance);
  return std::make_shared<RigidFace>();
}

}  // namespace hosel::models
