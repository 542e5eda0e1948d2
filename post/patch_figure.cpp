#include "post/patch_figure.hpp"

#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hosel::post {
namespace fs = std::filesystem;

PatchHistory read_patch(const fs::path& vtk, const Mat3& ball_axes, const Mat3& mesh_axes) {
  std::vector<fs::path> frames;
  for (const auto& entry : fs::directory_iterator(vtk / "patch"))
    if (entry.path().extension() == ".vtp") frames.push_back(entry.path());
  // By their number: five digits stand behind four.
  std::ranges::sort(frames, {}, [](const fs::path& f) { return std::pair(f.native().size(), f.native()); });

  struct Frame {
    double time;
    std::vector<double> pressure, traction, slip;  // of the points on the line, from behind to before
  };
  std::vector<Frame> all;
  vtkIdType points = 0;
  std::vector<vtkIdType> line;  // points on it
  std::vector<double> position;
  for (const fs::path& file : frames) {
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    vtkPolyData* data = reader->GetOutput();
    vtkDataArray* stamp = data->GetFieldData()->GetArray("TimeValue");
    bool whole = reader->GetErrorCode() == 0 && stamp && (all.empty() || data->GetNumberOfPoints() == points);
    for (const char* name : {"contact_pressure", "contact_traction", "slip"})
      whole = whole && data->GetPointData()->GetArray(name);
    if (!whole) throw std::runtime_error(file.string() + ": is damaged: remove the run and start it again");
    points = data->GetNumberOfPoints();
    if (line.empty()) {
      // The angles nearest the plane of slip: the same ones in every ring.
      std::vector<Vec3> local, ring;  // from the point of first contact, and about the mesh's axis
      for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
        const Eigen::Map<const Vec3> x(data->GetPoint(i));
        local.push_back(ball_axes.transpose() * x);
        ring.push_back(mesh_axes.transpose() * x);
      }
      const auto off = [&](const Vec3& x) { return std::abs(x.z()) / std::hypot(x.y(), x.z()); };
      double least = 1;
      for (const Vec3& x : ring) least = std::min(least, off(x));
      for (std::size_t i = 0; i < local.size(); ++i)
        if (off(ring[i]) <= least + 1e-6) line.push_back(vtkIdType(i));
      const auto arc = [&](vtkIdType i) {
        const Vec3& x = local[std::size_t(i)];
        return x.norm() * std::copysign(std::atan2(std::hypot(x.y(), x.z()), x.x()), x.y());
      };
      std::ranges::sort(line, {}, arc);
      for (const vtkIdType i : line) position.push_back(arc(i));
    }
    Frame frame{stamp->GetComponent(0, 0), {}, {}, {}};
    for (const vtkIdType i : line) {
      const auto value = [&](const char* name, int k) {
        return data->GetPointData()->GetArray(name)->GetComponent(i, k);
      };
      frame.pressure.push_back(value("contact_pressure", 0));
      frame.traction.push_back(ball_axes.col(1).dot(
          Vec3(value("contact_traction", 0), value("contact_traction", 1), value("contact_traction", 2))));
      frame.slip.push_back(value("slip", 0));
    }
    all.push_back(std::move(frame));
  }

  std::size_t first = position.size(), last = 0;
  for (const Frame& f : all)
    for (std::size_t j = 0; j < position.size(); ++j)
      if (f.pressure[j] > 0) first = std::min(first, j), last = std::max(last, j);
  PatchHistory out;
  if (first > last) return out;
  first -= first > 0;
  last += last + 1 < position.size();
  for (const Frame& f : all) out.time.push_back(f.time);
  for (std::size_t j = first; j <= last; ++j) {
    out.position.push_back(position[j]);
    for (const Frame& f : all) {
      out.pressure.push_back(f.pressure[j]);
      out.traction.push_back(f.traction[j]);
      out.slip.push_back(f.slip[j]);
    }
  }
  return out;
}

Figure patch_figure(const PatchHistory& patch, std::string_view model) {
  Figure figure;
  figure.title = fmt::format("{}: the ball's surface along the line of slip", model);
  figure.columns = 3;
  if (patch.time.size() < 2) return figure;
  const auto panel = [&](const char* title, const char* label, const std::vector<double>& values, double unit,
                         bool symmetric) {
    if (std::ranges::all_of(values, [](double v) { return v == 0; })) return;  // nothing pulls along a normal blow
    Panel p;
    p.title = title;
    p.x_label = "time [ms]";
    p.y_label = "place on the ball [mm]";
    p.map_label = label;
    p.map_symmetric = symmetric;
    p.map_contours = false;
    for (const double t : patch.time) p.map_x.push_back(1e3 * t);
    for (const double x : patch.position) p.map_y.push_back(1e3 * x);
    for (const double v : values) p.map.push_back(v / unit);
    figure.panels.push_back(std::move(p));
  };
  panel("pressure", "[MPa]", patch.pressure, 1e6, false);
  panel("traction along the slip", "[MPa]", patch.traction, 1e6, true);
  panel("path slid", "[mm]", patch.slip, 1e-3, false);
  return figure;
}

}  // namespace hosel::post
