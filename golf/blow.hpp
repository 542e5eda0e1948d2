/// One blow: everything that an impact model is asked about.
#pragma once

#include <optional>

#include "golf/ball.hpp"
#include "golf/contact_law.hpp"
#include "golf/delivery.hpp"
#include "golf/head.hpp"
#include "golf/shaft.hpp"

namespace hosel {

/// How the head hangs on the shaft.
struct ClubGeometry {
  Vec3 hosel = Vec3(-0.01, 0.05, 0.0);  ///< shaft tip in the face frame, from the face centre [m]
  Vec3 shaft_axis = Vec3(0, 0.5, 0.866025403784438647).normalized();  ///< tip to butt, face frame
};

struct Club {
  Head head;
  std::optional<Shaft> shaft;  ///< absent: the head alone
  ClubGeometry geometry;
};

struct Blow {
  Delivery delivery;
  Club club;
  Ball ball;
  ContactLaw contact;
};

}  // namespace hosel
