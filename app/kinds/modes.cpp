#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "app/read_solid.hpp"
#include "fem/harmonic_solid.hpp"
#include "solvers/modes.hpp"

namespace hosel::app {
namespace {

/// Frequencies of the free ball by harmonic (m = 0...), spheroidal and torsional families apart where
/// m = 0; eta = omega R / c_s beside each, c_s of the outermost layer at an instant.
constexpr const char* kTorsion = "torsion";

class ModesJob final : public Job {
 public:
  explicit ModesJob(CaseFile& file) {
    Table root = file.root();
    Table ball = root.table("ball");
    ball_ = read_ball(ball);
    layers_ = read_fe_ball(ball, models::range_ball());
    for (const double h : root.numbers({"harmonics", "Fourier harmonics whose modes are wanted"}, 0, {0, 12},
                                       std::vector<double>{0, 1, 2, 3})) {
      if (h != std::floor(h)) root.fail("harmonics", "whole numbers are wanted");
      harmonics_.push_back(int(h));
    }
    count_ = root.integer({"count", "modes of each harmonic"}, 1, 200, 6);
    if (auto mesh = root.optional_table("mesh")) {
      mesh_.sector =
          int(mesh->integer({"sector", "elements per 45 degrees of the surface before grading"}, 1, 32, mesh_.sector));
      mesh_.rings = int(mesh->integer({"rings", "rings of elements outside the core block"}, 1, 32, mesh_.rings));
    }
    mesh_.pole = mesh_.skin = 1;
  }

  void run(Output& out) override {
    nlohmann::json summary;
    std::vector<double> radii;
    std::vector<fem::Solid> materials;
    for (const auto& layer : layers_.layers) {
      radii.push_back(layer.radius * ball_.radius);
      materials.push_back(layer.material);
    }
    const mesh::Meridian mesh = mesh::sphere_meridian(radii, mesh_);
    double mass = 0;
    {
      fem::DofMap dof_map;
      mass =
          fem::HarmonicSolid(dof_map, mesh, fem::axisymmetric_basis(), {fem::single_angle(), 2}, materials, {}).mass();
    }
    for (auto& m : materials) m.density *= ball_.mass / mass;
    const double unit = std::sqrt(materials.back().instant_shear() / materials.back().density) / ball_.radius;
    summary["nodes"] = mesh.nodes.size();
    out.say(fmt::format("{} nodes; eta = omega R / c_s with c_s = {:.5f} m/s", mesh.nodes.size(), unit * ball_.radius));
    post::TextTable table{.rows = {{"family", "frequency [Hz]", "eta"}}};
    post::Series ring{.label = "other", .style = "points"}, twist{.label = "torsion", .style = "points"};
    std::string csv = "family,harmonic,frequency_Hz,eta\n";
    const auto solve = [&](const std::string& name, int m, const fem::FourierBasis& basis) {
      fem::System system;
      system.terms.push_back(std::make_unique<fem::HarmonicSolid>(
          system.dof_map, mesh, basis,
          fem::SolidQuadrature{m == 0 ? fem::single_angle() : fem::full_circle(4 * m + 5), 2}, materials,
          fem::Placement{}));
      const solvers::Modes modes = solvers::modes(system, system.dof_map.rest(), int(count_) + 2);
      nlohmann::json list = nlohmann::json::array();
      for (const double omega : modes.omega) {
        if (omega < 1e-4 * unit || long(list.size()) == count_) continue;  // rigid motions
        list.push_back({{"frequency_Hz", omega / (2 * kPi)}, {"eta", omega / unit}});
        table.rows.push_back({name, fmt::format("{:.3f}", omega / (2 * kPi)), fmt::format("{:.6f}", omega / unit)});
        post::Series& level = name == kTorsion ? twist : ring;
        level.add(m, 1e-3 * omega / (2 * kPi));
        csv += fmt::format("{},{},{:.9g},{:.9g}\n", name, m, omega / (2 * kPi), omega / unit);
      }
      if (!list.empty())
        out.page().answer("lowest, " + name, fmt::format("{:.0f} Hz", list[0]["frequency_Hz"].get<double>()),
                          fmt::format("η = {:.4f}", list[0]["eta"].get<double>()));
      summary["modes"][name] = list;
    };
    for (const int m : harmonics_) {
      solve(fmt::format("harmonic {}", m), m, fem::cylindrical_basis(m));
      if (m == 0) solve(kTorsion, 0, fem::torsion_basis());
    }
    out.draw(
        {.panels = {{.x_label = "harmonic around the axis", .y_label = "frequency [kHz]", .series = {ring, twist}}}},
        "modes");
    out.show(table, "Frequencies, and η = ω R / c_s");
    out.write("modes.csv", csv);
    out.write_summary(summary);
  }

 private:
  Ball ball_;
  models::FeBall layers_;
  std::vector<int> harmonics_;
  long count_ = 0;
  mesh::MeridianOptions mesh_;
};

}  // namespace

std::unique_ptr<Job> read_modes(CaseFile& file) { return std::make_unique<ModesJob>(file); }

}  // namespace hosel::app
