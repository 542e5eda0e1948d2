#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "app/read_shaft.hpp"
#include "fem/rigid_body.hpp"
#include "fem/supports.hpp"
#include "golf/shaft_library.hpp"
#include "models/club/swing.hpp"
#include "post/figure.hpp"
#include "post/vtk_series.hpp"
#include "solvers/modes.hpp"

namespace hosel::app {
namespace {

class ShaftModesJob final : public Job {
 public:
  explicit ShaftModesJob(CaseFile& file) {
    Table root = file.root();
    club_.shaft = read_shaft(root.table("shaft"));
    if (auto head = root.optional_table("head")) {
      club_.head = read_head(*head);
      with_head_ = true;
    }
    club_.geometry = read_club_geometry(root, false);
    support_ = root.choice({"support", "of the butt"}, {"clamped", "free"}, "clamped");
    clamped_ = root.quantity({"clamped_length", "of the butt that the clamp holds"}, "mm", Range::non_negative(), 0);
    if (support_ == "free" && clamped_ > 0) root.fail("clamped_length_mm", "a free butt is in no clamp");
    if (clamped_ >= club_.shaft->length()) root.fail("clamped_length_mm", "the clamp holds the whole shaft");
    count_ = static_cast<int>(root.integer({"count", "how many modes"}, 1, 100, 8));
    elements_ = static_cast<int>(root.integer({"elements", "finite elements along the free shaft"}, 1, 300, 40));
    shear_ = root.flag({"shear", "Timoshenko (true) or shear-rigid (false)"}, true);
    vtk_ = root.flag({"vtk", "write mode shapes for ParaView"}, true);
  }

  void run(Output& out) override {
    fem::System system;
    const double length = club_.shaft->length() - clamped_;
    const auto line =
        mesh::straight(mesh::graded(length, elements_), Vec3::Zero(), mesh::frame_along(-Vec3::UnitZ(), Vec3::UnitX()));
    const fem::SectionLaw law = [sections = fem::shaft_sections(*club_.shaft, shear_), from = clamped_](double s) {
      return sections(s + from);
    };
    auto owned = std::make_unique<fem::Beam>(system.dof_map, line, law, fem::BeamOptions{});
    const fem::Beam& beam = *owned;
    system.terms.push_back(std::move(owned));
    const fem::Node tip = beam.nodes().back();
    if (with_head_) {
      const Mat3 R = models::face_to_grip(club_.geometry);
      system.terms.push_back(std::make_unique<fem::RigidBody>(
          "head", tip.translation, tip.rotation,
          fem::RigidBodyProperties{club_.head.mass, R * club_.head.inertia * R.transpose(),
                                   R * (club_.head.cg - club_.geometry.hosel)}));
    }
    if (support_ == "clamped")
      system.prescribed.push_back(
          std::make_unique<fem::ImposedMotion>(beam.nodes().front(), fem::at_rest(Vec3::Zero())));
    fem::State rest = system.dof_map.rest();
    beam.place(rest);
    const int rigid = support_ == "free" ? 6 : 0;
    const solvers::Modes modes = solvers::modes(system, rest, count_ + rigid);

    nlohmann::json summary;
    post::Panel shapes{.x_label = "from the butt [mm]", .y_label = "deflection over its largest"};
    std::string csv = "mode,frequency_Hz,frequency_cpm,damping_ratio\n";
    post::TextTable table{.rows = {{"mode", "Hz", "cpm", "damping"}}, .first_width = 6, .least_width = 12};
    for (std::size_t i = static_cast<std::size_t>(rigid); i < modes.omega.size(); ++i) {
      const double f = modes.omega[i] / (2 * kPi), zeta = 0.5 * modes.omega[i] * club_.shaft->damping_time;
      const std::size_t number = i - static_cast<std::size_t>(rigid) + 1;
      csv += fmt::format("{},{:.9g},{:.9g},{:.6g}\n", number, f, 60 * f, zeta);
      table.rows.push_back({fmt::format("{}", number), fmt::format("{:.4f}", f), fmt::format("{:.2f}", 60 * f),
                            fmt::format("{:.5f}", zeta)});
      if (number < 4)
        out.page().answer(fmt::format("mode {}", number), fmt::format("{:.2f} Hz", f),
                          fmt::format("{:.1f} cpm", 60 * f));
      summary["frequency_Hz"].push_back(f);
      summary["damping_ratio"].push_back(zeta);
      if (post::Series s = deflection(beam, modes.shapes.col(Eigen::Index(i)));
          !s.x.empty() && shapes.series.size() < 8) {
        s.label = fmt::format("{}: {:.2f} Hz", number, f);
        shapes.series.push_back(std::move(s));
      }
      if (vtk_) write_shape(out, beam, modes.shapes.col(static_cast<Eigen::Index>(i)), number);
    }
    summary["shaft_mass_kg"] = hosel::mass(*club_.shaft);
    out.show(table, "Frequencies");
    out.draw({.panels = {shapes}, .panel_width = 760}, "modes");
    out.write("modes.csv", csv);
    out.write_summary(summary);
  }

 private:
  /// Of a bending mode in its own plane; empty where the shaft turns or stretches alone.
  post::Series deflection(const fem::Beam& beam, const Eigen::VectorXd& shape) const {
    Eigen::MatrixX3d across(std::ssize(beam.nodes()), 3);
    double turned = 0;
    for (std::size_t n = 0; n < beam.nodes().size(); ++n) {
      const Mat3& axes = beam.line()[n].frame;
      across.row(Eigen::Index(n)) = (axes.transpose() * shape.segment<3>(beam.nodes()[n].translation.v)).transpose();
      turned = std::max(turned, std::abs(axes.col(0).dot(shape.segment<3>(beam.nodes()[n].rotation.v))));
    }
    across.col(0).setZero();  // along the shaft
    Eigen::Index at = 0;
    const double largest = across.rowwise().norm().maxCoeff(&at);
    if (!(largest >
          0.1 * std::max(turned * club_.shaft->stations.front().outer_radius, shape.lpNorm<Eigen::Infinity>() * 0.01)))
      return {};
    post::Series s;
    for (std::size_t n = 0; n < beam.nodes().size(); ++n) {
      s.add(1e3 * (beam.line()[n].arc_length + clamped_),
            across.row(Eigen::Index(n)).dot(across.row(at)) / (largest * largest));
    }
    return s;
  }

  /// One period of a mode, its largest displacement a tenth of the shaft.
  void write_shape(Output& out, const fem::Beam& beam, const Eigen::VectorXd& shape, std::size_t number) const {
    post::VtkMesh mesh;
    std::vector<Vec3> amplitude;
    double largest = 1e-30;
    for (std::size_t n = 0; n < beam.nodes().size(); ++n) {
      mesh.points.push_back(beam.line()[n].position);
      amplitude.emplace_back(shape.segment<3>(beam.nodes()[n].translation.v));
      largest = std::max(largest, amplitude.back().norm());
      if (n > 0)
        mesh.cells.push_back({post::CellShape::line, {static_cast<std::int64_t>(n) - 1, static_cast<std::int64_t>(n)}});
    }
    post::VtkField radius{"radius", "m", 1, {}};
    for (const auto& node : beam.line())
      radius.values.push_back(club_.shaft->at(node.arc_length + clamped_).outer_radius);
    post::VtkSeries series(out.path("vtk"), fmt::format("mode_{}", number), post::VtkSeries::Form::surface);
    for (int k = 0; k < 16; ++k) {
      std::vector<Vec3> u;
      for (const Vec3& a : amplitude)
        u.push_back(0.1 * club_.shaft->length() / largest * std::sin(2 * kPi * k / 16) * a);
      mesh.point_fields = {post::vector_field("displacement", "m", u), radius};
      series.write(k / 16.0, mesh);
    }
  }

  Club club_;
  bool with_head_ = false, shear_ = true, vtk_ = true;
  std::string support_;
  double clamped_ = 0;
  int count_ = 8, elements_ = 40;
};

}  // namespace

std::unique_ptr<Job> read_shaft_modes(CaseFile& file) { return std::make_unique<ShaftModesJob>(file); }

}  // namespace hosel::app
