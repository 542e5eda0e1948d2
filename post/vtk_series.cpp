#include "post/vtk_series.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <stdexcept>

#include "post/file.hpp"
#include "post/html.hpp"

namespace hosel::post {
namespace fs = std::filesystem;
namespace {

struct Shape {
  int vtk;
  int points;
};

Shape shape(CellShape s) {
  switch (s) {
    case CellShape::vertex: return {VTK_VERTEX, 1};
    case CellShape::line: return {VTK_LINE, 2};
    case CellShape::triangle: return {VTK_TRIANGLE, 3};
    case CellShape::quad: return {VTK_QUAD, 4};
    case CellShape::quadratic_wedge: return {VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18};
    case CellShape::quadratic_hexahedron: return {VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON, 24};
  }
  return {VTK_EMPTY_CELL, 0};
}

/// VTK writes an array's name into the XML as it is: what markup is made of becomes entities, which readers turn back,
/// and what no XML may hold a blank.
std::string xml_name(const std::string& name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool none = name.compare(i, 3, "\xEF\xBF\xBE") == 0 || name.compare(i, 3, "\xEF\xBF\xBF") == 0;
    if (none) i += 2;
    out += none || static_cast<unsigned char>(name[i]) < 0x20 ? ' ' : name[i];
  }
  return escape_html(out);
}

vtkNew<vtkDoubleArray> array_of(const VtkField& field, std::size_t tuples) {
  if (field.values.size() != tuples * std::size_t(field.components))
    throw std::invalid_argument(fmt::format("array '{}' has {} values, expected {} x {}", field.name,
                                            field.values.size(), tuples, field.components));
  vtkNew<vtkDoubleArray> array;
  array->SetName(xml_name(field.name).c_str());
  array->SetNumberOfComponents(field.components);
  array->SetNumberOfTuples(vtkIdType(tuples));
  std::copy(field.values.begin(), field.values.end(), array->GetPointer(0));
  if (!field.unit.empty()) array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), field.unit.c_str());
  if (field.components == 6) {
    constexpr const char* names[] = {"XX", "YY", "ZZ", "XY", "YZ", "XZ"};
    for (int i = 0; i < 6; ++i) array->SetComponentName(i, names[i]);
  }
  return array;
}

void fill(vtkPointSet& data, const VtkMesh& mesh, double time) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();  // VTK's default is single precision
  points->SetNumberOfPoints(vtkIdType(mesh.points.size()));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) points->SetPoint(vtkIdType(i), mesh.points[i].data());
  data.SetPoints(points);
  for (const VtkField& f : mesh.point_fields) data.GetPointData()->AddArray(array_of(f, mesh.points.size()));
  for (const VtkField& f : mesh.cell_fields) data.GetCellData()->AddArray(array_of(f, mesh.cells.size()));
  vtkNew<vtkDoubleArray> stamp;
  stamp->SetName("TimeValue");
  stamp->InsertNextValue(time);
  data.GetFieldData()->AddArray(stamp);
}

/// The file in memory: VTK itself does not survive a disk that is full.
template <class Writer, class Data>
std::string text_of(Data& data) {
  vtkNew<Writer> writer;
  writer->WriteToOutputStringOn();
  writer->SetInputData(&data);
  // Inline: ParaView 5.11 cannot read appended data where libexpat puts off its parsing (2.6, and 2.5 with the fix
  // of CVE-2023-52425: "junk after document element").
  writer->SetDataModeToBinary();
  if (!writer->Write()) throw std::runtime_error("VTK cannot write this mesh");
  return writer->GetOutputString();
}

/// Name of a file of a series below its directory.
std::string entry(const std::string& name, VtkSeries::Form form, std::size_t number) {
  return fmt::format("{0}/{0}_{1:04}.{2}", name, number, form == VtkSeries::Form::surface ? "vtp" : "vtu");
}

}  // namespace

VtkField vector_field(std::string name, std::string unit, const std::vector<Vec3>& values) {
  VtkField f{std::move(name), std::move(unit), 3, {}};
  f.values.reserve(3 * values.size());
  for (const Vec3& v : values) f.values.insert(f.values.end(), v.data(), v.data() + 3);
  return f;
}

std::vector<fs::path> series_in(const fs::path& directory, std::initializer_list<const char*> bodies) {
  std::vector<fs::path> out;
  for (const char* body : bodies)
    if (const fs::path file = directory / fmt::format("{}.pvd", body); fs::exists(file)) out.push_back(file);
  return out;
}

VtkSeries::VtkSeries(fs::path directory, std::string name, Form form, const Mark* kept)
    : directory_(std::move(directory)), name_(std::move(name)), form_(form) {
  if (kept) mark_ = *kept;
  remove_unfinished(directory_);
  std::vector<fs::path> old;
  if (fs::is_directory(directory_ / name_))
    for (const auto& found : fs::directory_iterator(directory_ / name_)) old.push_back(found.path());
  for (const fs::path& found : old) {
    bool mine = false;
    for (std::size_t i = 0; i < mark_.times.size(); ++i) mine = mine || found == directory_ / entry(name_, form_, i);
    if (!mine) fs::remove_all(found);
  }
  if (!kept) fs::remove(file());
  fs::create_directories(directory_ / name_);
}

bool VtkSeries::holds(const fs::path& directory, const std::string& name, Form form, const Mark& mark) {
  std::string all;
  for (std::size_t i = 0; i < mark.times.size(); ++i) {
    const fs::path file = directory / entry(name, form, i);
    if (!fs::is_regular_file(file)) return false;
    all = digest(all + read_file(file));
  }
  return all == mark.digest;
}

fs::path VtkSeries::file() const { return directory_ / (name_ + ".pvd"); }

void VtkSeries::write(double time, const VtkMesh& mesh) {
  std::string bytes;
  if (form_ == Form::volume) {
    vtkNew<vtkUnstructuredGrid> grid;
    grid->Allocate(vtkIdType(mesh.cells.size()));
    fill(*grid, mesh, time);
    for (const auto& cell : mesh.cells) {
      std::array<vtkIdType, VtkMesh::Cell::most> ids;
      std::copy(cell.points.begin(), cell.points.end(), ids.begin());
      grid->InsertNextCell(shape(cell.shape).vtk, shape(cell.shape).points, ids.data());
    }
    bytes = text_of<vtkXMLUnstructuredGridWriter>(*grid);
  } else {
    vtkNew<vtkPolyData> surface;
    fill(*surface, mesh, time);
    vtkNew<vtkCellArray> verts, lines, faces;
    for (const auto& cell : mesh.cells) {
      std::array<vtkIdType, VtkMesh::Cell::most> ids;
      std::copy(cell.points.begin(), cell.points.end(), ids.begin());
      const int n = shape(cell.shape).points;
      (n == 1 ? verts : n == 2 ? lines : faces)->InsertNextCell(n, ids.data());
    }
    surface->SetVerts(verts);
    surface->SetLines(lines);
    surface->SetPolys(faces);
    bytes = text_of<vtkXMLPolyDataWriter>(*surface);
  }
  // Not waited for: a frame that a loss of power takes is missed by its digest.
  write_file(directory_ / entry(name_, form_, mark_.times.size()), bytes, false);
  mark_.times.push_back(time);
  mark_.digest = digest(mark_.digest + bytes);

  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  "
      "<Collection>\n";
  for (std::size_t i = 0; i < mark_.times.size(); ++i)
    text += fmt::format("    <DataSet timestep=\"{:.9g}\" group=\"\" part=\"0\" file=\"{}\"/>\n", mark_.times[i],
                        entry(name_, form_, i));
  text += "  </Collection>\n</VTKFile>\n";
  write_file(file(), text, false);
}

}  // namespace hosel::post
