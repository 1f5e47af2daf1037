#include "core/model/vtu_file.hpp"

#include <fmt/format.h>

#include "core/output_file.hpp"
#include "core/print.hpp"
namespace tapstudy::core {
namespace {
constexpr int vtk_tetra = 10;
constexpr int vtk_quadratic_tetra = 24;

void open_array(std::ostream& out, const char* type, const std::string& name, int components) {
  core::print(out, R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="ascii">)",
              type, name, components);
  out << '\n';
}
void close_array(std::ostream& out) {
  out << "</DataArray>\n";
}

void write_nodes(std::ostream& out, const TetMesh& mesh) {
  out << "<Points>\n";
  open_array(out, "Float64", "Points", 3);
  for (const auto node : mesh.nodes_m.rowwise()) {
    core::print(out, "{:.17g} {:.17g} {:.17g}\n", node[0], node[1], node[2]);
  }
  close_array(out);
  out << "</Points>\n";
}

// VTK numbers the nodes of its tetrahedra as TetMesh does.
void write_cells(std::ostream& out, const TetMesh& mesh) {
  out << "<Cells>\n";
  open_array(out, "Int32", "connectivity", 1);
  for (const auto tet : mesh.tets.rowwise()) {
    for (const int node : tet) {
      core::print(out, "{} ", node);
    }
    out << '\n';
  }
  close_array(out);
  open_array(out, "Int32", "offsets", 1);
  for (Eigen::Index tet = 1; tet <= mesh.tets.rows(); ++tet) {
    core::print(out, "{}\n", tet * mesh.tets.cols());
  }
  close_array(out);
  open_array(out, "UInt8", "types", 1);
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    core::print(out, "{}\n", mesh.order() == 2 ? vtk_quadratic_tetra : vtk_tetra);
  }
  close_array(out);
  out << "</Cells>\n";
}

void write_modes(std::ostream& out, const Eigen::MatrixXd& displacement) {
  out << "<PointData>\n";
  for (Eigen::Index mode = 0; mode < displacement.cols(); ++mode) {
    const auto nodes = displacement.col(mode).reshaped(3, displacement.rows() / 3);
    const double longest = nodes.colwise().norm().maxCoeff();
    open_array(out, "Float64", fmt::format("mode_{}", mode + 1), 3);
    for (const auto node : nodes.colwise()) {
      core::print(out, "{:.9g} {:.9g} {:.9g}\n", node[0] / longest, node[1] / longest,
                  node[2] / longest);
    }
    close_array(out);
  }
  out << "</PointData>\n";
}

void write_frequencies(std::ostream& out, const Eigen::ArrayXd& frequency_hz) {
  core::print(out,
              R"(<FieldData>
<DataArray type="Float64" Name="frequency_hz" NumberOfTuples="{}" format="ascii">
)",
              frequency_hz.size());
  for (const double hz : frequency_hz) {
    core::print(out, "{:.17g}\n", hz);
  }
  close_array(out);
  out << "</FieldData>\n";
}
}  // namespace

void write_vtu(const SolvedBody& body, const Eigen::ArrayXd& frequency_hz,
               const std::string& file) {
  write_new_file(file, [&](std::ostream& out) {
    out << "<?xml version=\"1.0\"?>\n"
           "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
           "<UnstructuredGrid>\n";
    write_frequencies(out, frequency_hz);
    core::print(out, "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                body.mesh.nodes_m.rows(), body.mesh.tets.rows());
    write_nodes(out, body.mesh);
    write_cells(out, body.mesh);
    write_modes(out, body.displacement.leftCols(frequency_hz.size()));
    out << "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  });
}
}  // namespace tapstudy::core
