#include "core/model/mesh/tet_mesh.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"
namespace tapstudy::core {
namespace {
// TetGen's own order of a T10's nodes: corners, then the middles of 23 03 01 12 13 02.
constexpr std::array<Eigen::Index, 10> tetgen_order{0, 1, 2, 3, 9, 7, 4, 5, 8, 6};

std::ofstream new_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error)) {
    throw InvalidInput{path + ": exists already and is not overwritten"};
  }
  std::ofstream file{path};
  if (!file) {
    throw InvalidInput{path + ": cannot be written"};
  }
  return file;
}
}  // namespace

double tet_volume_m3(const TetMesh& mesh, Eigen::Index tet) {
  const auto corner = [&](Eigen::Index i) -> Eigen::Vector3d {
    return mesh.nodes_m.row(mesh.tets(tet, i));
  };
  const Eigen::Vector3d origin = corner(0);
  return (corner(1) - origin).cross(corner(2) - origin).dot(corner(3) - origin) / 6.0;
}

double volume_m3(const TetMesh& mesh) {
  double sum = 0.0;
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    sum += tet_volume_m3(mesh, tet);
  }
  return sum;
}

void write_tetgen_files(const TetMesh& mesh, const std::string& prefix) {
  std::ofstream nodes = new_file(prefix + ".node");
  std::ofstream elements = new_file(prefix + ".ele");
  fmt::print(nodes, "{} 3 0 0\n", mesh.nodes_m.rows());
  for (Eigen::Index i = 0; i < mesh.nodes_m.rows(); ++i) {
    fmt::print(nodes, "{} {:.17g} {:.17g} {:.17g}\n", i, mesh.nodes_m(i, 0), mesh.nodes_m(i, 1),
               mesh.nodes_m(i, 2));
  }
  fmt::print(elements, "{} {} 0\n", mesh.tets.rows(), mesh.tets.cols());
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    fmt::print(elements, "{}", tet);
    for (Eigen::Index i = 0; i < mesh.tets.cols(); ++i) {
      fmt::print(elements, " {}", mesh.tets(tet, tetgen_order.at(static_cast<std::size_t>(i))));
    }
    fmt::print(elements, "\n");
  }
  if (!nodes.flush() || !elements.flush()) {
    std::error_code ignored;
    std::filesystem::remove(prefix + ".node", ignored);
    std::filesystem::remove(prefix + ".ele", ignored);
    throw InvalidInput{prefix + ".node, .ele: writing failed (is the disk full?)"};
  }
}
}  // namespace tapstudy::core
