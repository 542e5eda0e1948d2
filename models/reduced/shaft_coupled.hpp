/// The volumetric ball against a head with a shaft.
#pragma once

#include "models/club/mounted_shaft.hpp"
#include "models/reduced/volumetric.hpp"

namespace hosel::models {

/// The shaft is at rest in a frame that moves as the head does before the blow (as if the whole club
/// were in steady flight): what the hands and the swing do in half a millisecond is left out, and the
/// butt is held in that frame. A loaded shaft (ShaftMount::loaded or load; nothing else of it is used) lets
/// that frame accelerate as the club does before the blow. Without stiffness and mass the shaft leaves the volumetric
/// model. Throws std::invalid_argument where the club has no shaft.
class ShaftCoupled final : public ImpactModel {
 public:
  explicit ShaftCoupled(VolumetricLaw law = {}, VolumetricOptions options = {}, ShaftImpedanceOptions beam = {},
                        ShaftMount mount = {})
      : law_(law), options_(options), beam_(beam), mount_(std::move(mount)) {}
  Launch launch(const Blow& blow) const override;
  /// Neighbours of one club go side by side. Where the swing loads the shaft one after the other: each blow then has a
  /// shaft of its own.
  std::vector<Answer> launches(std::span<const Blow> blows) const override;
  /// Whether the swing has loaded the shaft, whose energy then goes into the blow.
  bool loaded() const { return mount_.loaded || mount_.load; }

 private:
  VolumetricLaw law_;
  VolumetricOptions options_;
  ShaftImpedanceOptions beam_;
  ShaftMount mount_;
};

}  // namespace hosel::models
