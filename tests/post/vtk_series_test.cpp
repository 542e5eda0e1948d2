// What is written is read back with VTK's own readers: names, components, units, times.
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <filesystem>

#include "post/file.hpp"
#include "post/vtk_series.hpp"
#include "tests/support/fresh_directory.hpp"

namespace hosel::post {
namespace {

namespace fs = std::filesystem;

VtkMesh one_hexahedron() {
  VtkMesh m;
  constexpr std::array<std::pair<double, double>, 8> square = {
      {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0}, {1, 0.5}, {0.5, 1}, {0, 0.5}}};
  for (const double z : {0.0, 0.5, 1.0})
    for (const auto& [x, y] : square) m.points.emplace_back(x, y, z + 1e-9);
  m.cells.push_back({CellShape::quadratic_hexahedron,
                     {0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23, 8, 9, 10, 11, 15, 13, 12, 14}});
  m.point_fields.push_back(vector_field("displacement", "m", std::vector<Vec3>(24, Vec3(1e-3, 0, 2e-3))));
  m.cell_fields.push_back({"cauchy_stress", "Pa", 6, {1, 2, 3, 4, 5, 6}});
  return m;
}

TEST(VtkSeries, VolumeReadsBack) {
  const test::FreshDirectory home("vtk_volume");
  const fs::path& dir = home.path();
  VtkSeries series(dir, "ball", VtkSeries::Form::volume);
  series.write(0, one_hexahedron());
  series.write(2.5e-4, one_hexahedron());
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((dir / "ball" / "ball_0001.vtu").c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  ASSERT_EQ(grid->GetNumberOfPoints(), 24);
  EXPECT_EQ(grid->GetPoints()->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(grid->GetPoint(0)[2], 1e-9);
  vtkDataArray* u = grid->GetPointData()->GetArray("displacement");
  ASSERT_NE(u, nullptr);
  EXPECT_EQ(u->GetNumberOfComponents(), 3);
  EXPECT_EQ(u->GetComponent(23, 2), 2e-3);
  // Of the order that VTK knows: every point lies where the cell expects it. What VTK points at is good to the next
  // call.
  vtkCell* cell = grid->GetCell(0);
  for (int i = 0; i < 24; ++i) {
    const Vec3 wanted = Eigen::Map<const Vec3>(cell->GetParametricCoords() + 3 * i) + Vec3(0, 0, 1e-9),
               point = Eigen::Map<const Vec3>(grid->GetPoint(cell->GetPointId(i)));
    EXPECT_LT((point - wanted).norm(), 1e-12) << i;
  }
  EXPECT_STREQ(u->GetInformation()->Get(vtkDataArray::UNITS_LABEL()), "m");
  vtkDataArray* s = grid->GetCellData()->GetArray("cauchy_stress");
  ASSERT_NE(s, nullptr);
  EXPECT_STREQ(s->GetComponentName(5), "XZ");
  EXPECT_EQ(grid->GetFieldData()->GetArray("TimeValue")->GetComponent(0, 0), 2.5e-4);
  EXPECT_NE(read_file(series.file()).find("timestep=\"0.00025\""), std::string::npos);
}

TEST(VtkSeries, SurfaceAndLinesReadBack) {
  const test::FreshDirectory home("vtk_surface");
  const fs::path& dir = home.path();
  VtkMesh m;
  m.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  m.cells = {{CellShape::triangle, {0, 1, 2}}, {CellShape::line, {0, 1}}};
  m.point_fields.push_back({"radius", "m", 1, {0.1, 0.2, 0.3}});
  VtkSeries series(dir, "shaft", VtkSeries::Form::surface);
  series.write(0, m);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((dir / "shaft" / "shaft_0000.vtp").c_str());
  reader->Update();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPolys(), 1);
  EXPECT_EQ(reader->GetOutput()->GetNumberOfLines(), 1);
  EXPECT_EQ(reader->GetOutput()->GetPointData()->GetArray("radius")->GetComponent(2, 0), 0.3);
}

TEST(VtkSeries, ResumeKeepsWhatItsMarkSaysAndStartOverRemovesIt) {
  const test::FreshDirectory home("vtk_resume");
  const fs::path& dir = home.path();
  const auto form = VtkSeries::Form::volume;
  // Times that nine digits do not tell apart: all that is kept is counted, not compared.
  const double t1 = 1.00000000001, t2 = 1.00000000002;
  VtkSeries::Mark mark;
  std::string whole;
  {
    VtkSeries series(dir, "ball", form);
    for (const double t : {0.0, t1}) series.write(t, one_hexahedron());
    mark = series.mark();
    for (const double t : {t2, 3.0}) series.write(t, one_hexahedron());
    whole = read_file(series.file());
  }
  ASSERT_TRUE(VtkSeries::holds(dir, "ball", form, mark));
  {
    VtkSeries series(dir, "ball", form, &mark);
    EXPECT_FALSE(fs::exists(dir / "ball/ball_0002.vtu")) << "written after the mark";
    for (const double t : {t2, 3.0}) series.write(t, one_hexahedron());
    EXPECT_EQ(read_file(series.file()), whole);
  }
  fs::resize_file(dir / "ball/ball_0001.vtu", 100);
  EXPECT_FALSE(VtkSeries::holds(dir, "ball", form, mark));
  fs::remove(dir / "ball/ball_0001.vtu");
  EXPECT_FALSE(VtkSeries::holds(dir, "ball", form, mark));
  VtkSeries again(dir, "ball", form);
  again.write(0, one_hexahedron());
  EXPECT_FALSE(fs::exists(dir / "ball/ball_0002.vtu"));
  EXPECT_EQ(read_file(again.file()).find("ball_0001"), std::string::npos);
}

TEST(VtkSeries, RefusesAnArrayOfTheWrongLength) {
  const test::FreshDirectory home("vtk_wrong");
  VtkSeries series(home.path(), "ball", VtkSeries::Form::volume);
  VtkMesh m = one_hexahedron();
  m.point_fields[0].values.pop_back();
  EXPECT_THROW(series.write(0, m), std::invalid_argument);
}

}  // namespace
}  // namespace hosel::post
