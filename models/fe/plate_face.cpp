#include "models/fe/plate_face.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "fem/plate_surface.hpp"
#include "golf/dense.hpp"
#include "golf/units.hpp"
#include "solvers/errors.hpp"
#include "solvers/linear.hpp"
#include "solvers/modes.hpp"

namespace hosel::models {
namespace {

using Eigen::Vector2d;
using Sparse = Eigen::SparseMatrix<double>;
using Unknown = fem::Plate::Unknown;

constexpr std::array kPatches = {4e-3, 9e-3};  // radii about a blow's place: a ball's patch as it grows [m]
constexpr double kMargin = 12e-3;              // beyond the rim, where a ball may touch as well [m]
constexpr int kPendulumModes = 4;              // times as many as a blow keeps

Sparse assembled(const fem::System& system, const fem::Weights& weights) {
  solvers::SparseTangent t(system);
  t.assemble(system, system.dof_map.rest(), weights);
  return Eigen::Map<const Sparse>(t.size(), t.size(), Eigen::Index(t.values().size()), t.column_starts().data(),
                                  t.row_indices().data(), t.values().data());
}

/// Deflection at places as a matrix on the plate's equations. A place outside takes the rim's on the way to the centre.
Sparse deflections(const fem::Plate& plate, Eigen::Index size, const mesh::PlateOutline& outline,
                   const std::vector<Vector2d>& places) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Vector2d place = places[i];
    if (const double share = outline.share(place); share > 1) place *= (1 - 1e-9) / share;
    mesh::PlatePlace at = mesh::locate(plate.mesh(), place);
    // Straight pieces between the outline's points leave slivers.
    for (double back = 1e-4; at.element < 0 && back < 0.1; back *= 2)
      at = mesh::locate(plate.mesh(), (1 - back) * place);
    if (at.element < 0) continue;
    const mesh::Q9 q = mesh::Q9::at(at.xi, at.eta);
    plate.deflections(at.element,
                      [&](int k, Eigen::Index dof) { entries.emplace_back(Eigen::Index(i), dof, q.value[k]); });
  }
  Sparse out(Eigen::Index(places.size()), size);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace

struct PlateFace::Factors {
  Eigen::SimplicialLDLT<Sparse> of;
};

std::vector<std::string> PlateDesign::faults() const {
  std::vector<std::string> out;
  for (const auto& faults : {outline.faults(), thickness.faults(), material.faults(), rim.faults(), mesh.faults()})
    out.insert(out.end(), faults.begin(), faults.end());
  if (!(damping >= 0 && damping < 1)) out.emplace_back("the plate's damping must lie between 0 and 1 of the critical");
  if (modes < 1 || modes + 5 > fem::kSurfaceUnknowns) out.emplace_back("a blow keeps 1 to 27 modes of the plate");
  if (rim.stretch == 0) out.emplace_back("the rim's springs must hold the plate in its plane");
  if (rim.deflection == 0) out.emplace_back("the rim's springs must hold the plate in the head");
  return out;
}

double PlateDesign::mass() const {
  // Along rays: an outline's reach takes powers, a thickness does not.
  constexpr int rays = 240, along = 40;
  const Vector2d extent = outline.extent();
  double volume = 0;
  for (int k = 0; k < rays; ++k) {
    const double angle = 2 * kPi * (k + 0.5) / rays;
    const Vector2d direction(extent.x() * std::cos(angle), extent.y() * std::sin(angle));
    const double reach = outline.reach(direction), sector = 2 * kPi / rays * extent.prod() * reach * reach;
    for (int i = 0; i < along; ++i) {
      const double share = (i + 0.5) / along;
      volume += sector * share / along * thickness.at(share * reach * direction, share);
    }
  }
  return material.density * volume;
}

bool PlateDesign::heel_toe_alike() const {
  return outline.form != mesh::PlateOutline::Form::polygon &&
         !std::holds_alternative<mesh::PlateThickness::Grid>(thickness.map);
}

PlateFace::PlateFace(PlateDesign design, const Face& curvature) : design_(std::move(design)), curvature_(curvature) {
  if (const auto faults = design_.faults(); !faults.empty())
    throw std::invalid_argument("face plate: " + faults.front());
  const mesh::PlateMesh mesh = mesh::plate_mesh(design_.outline, design_.mesh);
  std::vector<double> thickness;
  for (const Vector2d& node : mesh.nodes)
    thickness.push_back(design_.thickness.at(node, std::min(1.0, design_.outline.share(node))));
  auto term = std::make_unique<fem::Plate>(system_.dof_map, mesh, design_.material, thickness, design_.rim, curvature);
  plate_ = term.get();
  system_.terms.push_back(std::move(term));
  mass_ = plate_->mass();
  stiffness_ = assembled(system_, {1, 0, 0});
  inertia_ = assembled(system_, {0, 0, 1});
  auto factors = std::make_shared<Factors>();
  factors->of.compute(stiffness_);
  if (factors->of.info() != Eigen::Success) throw solvers::NonConvergence("face plate: its rim does not hold it");
  factors_ = std::move(factors);
  const solvers::Modes modes = solvers::modes(system_, system_.dof_map.rest(), kPendulumModes * design_.modes);
  omega_ = modes.omega;
  modes_ = modes.shapes;

  for (int m = 0; m < 2; ++m) {
    const Vector2d flip = m == 0 ? Vector2d(-1, 1) : Vector2d(1, -1), extent = design_.outline.extent();
    const double near = 1e-6 * extent.norm();
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      const Vector2d image = flip.cwiseProduct(mesh.nodes[n]);
      const auto found = std::ranges::find_if(mesh.nodes, [&](const Vector2d& x) { return (x - image).norm() < near; });
      const auto at = std::size_t(found - mesh.nodes.begin());
      if (found == mesh.nodes.end() || std::abs(thickness[at] - thickness[n]) > 1e-9 * thickness[n]) {
        mirror_[m].clear();
        break;
      }
      mirror_[m].push_back(int(at));
    }
  }

  const Vector2d extent = design_.outline.extent() + Vector2d::Constant(kMargin);
  const double spacing = std::min(design_.outline.extent().minCoeff() / 12, 2.5e-3);
  grid_from_ = -extent;
  grid_to_ = extent;
  grid_columns_ = 1 + int(std::ceil(2 * extent.x() / spacing));
  grid_rows_ = 1 + int(std::ceil(2 * extent.y() / spacing));
  std::vector<Vector2d> places;
  for (int j = 0; j < grid_rows_; ++j)
    for (int i = 0; i < grid_columns_; ++i)
      places.emplace_back(grid_from_.x() + 2 * extent.x() * i / (grid_columns_ - 1),
                          grid_from_.y() + 2 * extent.y() * j / (grid_rows_ - 1));
  on_grid_ = deflections(*plate_, stiffness_.rows(), design_.outline, places);

  const auto samples = plate_->samples();
  sample_mass_.resize(Eigen::Index(samples.size()));
  sample_place_.resize(3, sample_mass_.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& s = samples[i];
    sample_mass_[Eigen::Index(i)] = s.mass;
    sample_place_.col(Eigen::Index(i)) = curvature_.point(s.place.x(), s.place.y());
    plate_->deflections(s.element,
                        [&](int k, Eigen::Index dof) { entries.emplace_back(Eigen::Index(i), dof, s.shape[k]); });
  }
  on_samples_.resize(sample_mass_.size(), stiffness_.rows());
  on_samples_.setFromTriplets(entries.begin(), entries.end());
}

bool PlateFace::symmetric(Mirror mirror) const {
  return mirror != Mirror::none && !mirror_[mirror == Mirror::heel_toe ? 0 : 1].empty();
}

fem::Vector PlateFace::mirrored(const fem::Vector& field, Mirror mirror) const {
  const auto& images = mirror_[mirror == Mirror::heel_toe ? 0 : 1];
  const bool heel_toe = mirror == Mirror::heel_toe;
  fem::Vector out = fem::Vector::Zero(field.size());
  for (std::size_t n = 0; n < images.size(); ++n)
    for (int i = 0; i < 5; ++i) {
      const auto unknown = Unknown(i);
      const auto to = plate_->dof(int(n), unknown), from = plate_->dof(images[n], unknown);
      if (to < 0) continue;
      const bool along_y = unknown == Unknown::kRotationY || unknown == Unknown::kStretchY,
                 along_z = unknown == Unknown::kRotationZ || unknown == Unknown::kStretchZ;
      out[to] = (heel_toe ? along_y : along_z) ? -field[from] : field[from];
    }
  return out;
}

fem::Vector PlateFace::patch_load(const Vector2d& place, double radius) const {
  // 1 - r^2/a^2 over a disc: Gauss's rule in s = r^2/a^2 with weight 1 - s, twelve angles.
  constexpr std::array<std::pair<double, double>, 3> rule{
      {{0.0885879595127, 0.2009319137390}, {0.4094668644407, 0.2292411063596}, {0.7876594617608, 0.0698269799015}}};
  constexpr int angles = 12;
  fem::Vector out = fem::Vector::Zero(stiffness_.rows());
  for (const auto& [s, weight] : rule)
    for (int k = 0; k < angles; ++k) {
      const double a = 2 * kPi * (k + (s > 0.2 && s < 0.5 ? 0.5 : 0)) / angles;
      out += 2 * weight / angles *
             plate_->point_load(place + radius * std::sqrt(s) * Vector2d(std::cos(a), std::sin(a)));
    }
  return out;
}

fem::Vector PlateFace::solve(const fem::Vector& load) const { return factors_->of.solve(load); }

double PlateFace::compliance(const Vector2d& place, double radius) const {
  const fem::Vector load = patch_load(place, radius);
  return load.dot(solve(load));
}

CondensedPlate PlateFace::condensed(const Vector2d& place, Mirror mirror) const {
  if (mirror != Mirror::none && !symmetric(mirror))
    throw std::invalid_argument("face plate: it has no such plane of symmetry");
  const Eigen::Index n = stiffness_.rows();
  // Candidates: modes, then static deflections under patches and under what moves the pressure's centre.
  std::vector<fem::Vector> candidates;
  for (Eigen::Index i = 0; i < std::min<Eigen::Index>(design_.modes, modes_.cols()); ++i)
    candidates.push_back(modes_.col(i));  // a coarse plate has fewer
  for (const double radius : kPatches) candidates.push_back(solve(patch_load(place, radius)));
  const double aside = 0.5 * kPatches.back();
  for (const Vector2d& d : {Vector2d(aside, 0), Vector2d(0, aside)})
    candidates.push_back(solve(patch_load(place + d, kPatches.front()) - patch_load(place - d, kPatches.front())));
  Eigen::MatrixXd V(n, Eigen::Index(candidates.size())), MV = V;
  Eigen::Index count = 0;
  for (fem::Vector& v : candidates) {
    const double before = v.dot(inertia_ * v);
    if (mirror != Mirror::none) v = (0.5 * (v + mirrored(v, mirror))).eval();
    for (int twice = 0; twice < 2; ++twice) v -= V.leftCols(count) * (MV.leftCols(count).transpose() * v);
    const fem::Vector Mv = inertia_ * v;
    const double left = v.dot(Mv);
    if (!(left > 1e-8 * before) || before == 0) continue;  // nothing new
    V.col(count) = v / std::sqrt(left);
    MV.col(count++) = Mv / std::sqrt(left);
  }
  V.conservativeResize(Eigen::NoChange, count);
  const dense::Eigenpairs ritz = dense::eigenpairs(V.transpose() * (stiffness_ * V));
  if (!ritz.converged) throw solvers::NonConvergence("the modes of the face did not converge");
  CondensedPlate out;
  out.fields = V * ritz.vectors;
  Eigen::MatrixXd grid = on_grid_ * out.fields;
  const Eigen::RowVectorXd scale = grid.cwiseAbs().colwise().maxCoeff().cwiseInverse();
  grid = grid * scale.asDiagonal();
  out.fields = out.fields * scale.asDiagonal();
  out.largest = Eigen::VectorXd::Ones(count);
  out.shapes = std::make_shared<fem::ShapeSpline>(grid_from_, grid_to_, grid_columns_, grid_rows_, grid.transpose());

  const Eigen::MatrixXd W = on_samples_ * out.fields;
  fem::ReducedFace& f = out.face;
  f.mass = W.transpose() * sample_mass_;
  f.moment = sample_place_ * sample_mass_.asDiagonal() * W;
  f.transverse = W.transpose() * sample_mass_.asDiagonal() * W;
  const Eigen::VectorXd squared = scale.cwiseAbs2().transpose(), lambda = ritz.values;
  f.inertia = squared.asDiagonal();
  f.stiffness = squared.cwiseProduct(lambda).asDiagonal();
  f.damping = (2 * design_.damping * squared.cwiseProduct(lambda.cwiseSqrt())).asDiagonal();
  f.centre = Eigen::VectorXd::Zero(count);
  for (Eigen::Index j = 0; j < count; ++j) f.centre[j] = plate_->deflection(out.fields.col(j), Vector2d::Zero());
  return out;
}

PlateFace::Stresses::Stresses(const fem::Plate& plate, const Eigen::MatrixXd& fields) {
  constexpr std::array<std::pair<double, double>, 5> points{{{-1, -1}, {1, -1}, {0, 0}, {-1, 1}, {1, 1}}};
  const auto elements = plate.mesh().elements.size();
  rows_.resize(Eigen::Index(6 * points.size() * elements), fields.cols());
  Eigen::Index row = 0;
  for (std::size_t e = 0; e < elements; ++e)
    for (const auto& [xi, eta] : points) {
      const mesh::Q9 q = mesh::Q9::at(xi, eta);
      Vector2d place = Vector2d::Zero();
      for (int k = 0; k < 9; ++k)
        place += q.value[k] * plate.mesh().nodes[std::size_t(plate.mesh().elements[e][std::size_t(k)])];
      places_.push_back(place);
      rows_.middleRows<6>(row) = plate.stresses(fields, int(e), xi, eta);
      row += 6;
    }
}

FacePeak PlateFace::Stresses::peak(const fem::Vector& unknowns) const {
  const Eigen::VectorXd all = rows_ * unknowns;
  FacePeak out;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const fem::PlateStress s{all.segment<3>(Eigen::Index(6 * i)), all.segment<3>(Eigen::Index(6 * i + 3))};
    if (const double here = s.von_mises(); here > out.stress) out = {here, places_[i]};
  }
  return out;
}

std::shared_ptr<const PlateFace> PlateOnDemand::on(const Face& curvature) const {
  const std::scoped_lock lock(mutex_);
  if (!made_ || made_->curvature().bulge != curvature.bulge || made_->curvature().roll != curvature.roll)
    made_ = std::make_shared<const PlateFace>(design_, curvature);
  return made_;
}

std::vector<std::string> PlateOnDemand::faults(bool axial) const {
  std::vector<std::string> out = design_.faults();
  if (axial) out.emplace_back("harmonics = 0 is the axisymmetric ball: it meets no plate");
  return out;
}

FaceInSystem PlateOnDemand::add(fem::System& system, const FaceBlow& struck) const {
  const Head& head = struck.blow.club.head;
  const std::shared_ptr<const PlateFace> plate = on(head.face);
  if (!(plate->mass() < head.mass))
    throw std::invalid_argument("fe impact: the face's mass is part of the head's and must be smaller");
  const CondensedPlate condensed = plate->condensed(struck.place(), struck.mirror);
  const fem::DofMap::Block unknowns = system.dof_map.add_vector(condensed.face.size());
  FaceInSystem out{
      .surface = std::make_unique<fem::PlateSurface>(head.face, condensed.shapes, condensed.largest, unknowns)};
  out.spring = std::make_unique<fem::FaceSpring>(condensed.face, struck.carrier, unknowns);
  out.compliance = plate->compliance(struck.place(), kBallPatch);
  out.stresses = [plate, fields = condensed.fields] {
    return [of = PlateFace::Stresses(plate->plate(), fields)](const fem::Vector& w) { return of.peak(w); };
  };
  return out;
}

}  // namespace hosel::models
