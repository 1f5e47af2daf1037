#include "core/model/vtu_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/files/output_files.hpp"
#include "core/text/print.hpp"
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

// A column per mode, mass-normalised: its nodes one after the other, x y z.
void write_modes(std::ostream& out, const Eigen::MatrixXd& shapes) {
  out << "<PointData>\n";
  for (Eigen::Index mode = 0; mode < shapes.cols(); ++mode) {
    open_array(out, "Float64", fmt::format("mode_{}", mode + 1), 3);
    const auto nodes = shapes.col(mode).reshaped(3, shapes.rows() / 3);
    for (const auto node : nodes.colwise()) {
      core::print(out, "{:.17g} {:.17g} {:.17g}\n", node[0], node[1], node[2]);
    }
    close_array(out);
  }
  out << "</PointData>\n";
}

// The modal mass of each mode scaled to a largest displacement of 1.
Eigen::ArrayXd modal_mass_kg(const Eigen::MatrixXd& shapes) {
  Eigen::ArrayXd mass_kg{shapes.cols()};
  for (Eigen::Index mode = 0; mode < shapes.cols(); ++mode) {
    mass_kg[mode] =
        1.0 / shapes.col(mode).reshaped(3, shapes.rows() / 3).colwise().squaredNorm().maxCoeff();
  }
  return mass_kg;
}

void write_field(std::ostream& out, const char* name, const Eigen::ArrayXd& values) {
  core::print(out, R"(<DataArray type="Float64" Name="{}" NumberOfTuples="{}" format="ascii">)",
              name, values.size());
  out << '\n';
  for (const double value : values) {
    core::print(out, "{:.17g}\n", value);
  }
  close_array(out);
}
}  // namespace

void write_vtu(const SolvedBody& body, const ModalModel& modal, double density_kg_per_m3,
               const std::string& file) {
  // the body was solved at unit density
  const Eigen::MatrixXd shapes =
      body.displacement.leftCols(modal.frequency_hz.size()) / std::sqrt(density_kg_per_m3);
  write_new_file(file, [&](std::ostream& out) {
    out << "<?xml version=\"1.0\"?>\n"
           "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
           "<UnstructuredGrid>\n";
    out << "<FieldData>\n";
    write_field(out, "frequency_hz", modal.frequency_hz);
    write_field(out, "modal_mass_kg", modal_mass_kg(shapes));
    out << "</FieldData>\n";
    core::print(out, "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                body.mesh.nodes_m.rows(), body.mesh.tets.rows());
    write_nodes(out, body.mesh);
    write_cells(out, body.mesh);
    write_modes(out, shapes);
    out << "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  });
}
}  // namespace tapstudy::core
