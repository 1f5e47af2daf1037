#include "core/model/universal_file.hpp"

#include <array>
#include <cmath>

#include "core/files/output_files.hpp"
#include "core/text/print.hpp"
namespace tapstudy::core {
namespace {
constexpr const char* delimiter = "    -1\n";

void open_data_set(std::ostream& out, int number) {
  out << delimiter;
  print(out, "{:>6}\n", number);
}

// Fortran's D for the exponent of double precision.
std::string in_double(double value) {
  std::string text = fmt::format("{:>25.16E}", value);
  text[text.find('E')] = 'D';
  return text;
}

void write_units(std::ostream& out) {
  constexpr double kelvin_at_0_celsius = 273.15;
  open_data_set(out, 164);
  print(out, "{:>10}{:<20}{:>10}\n", 1, "SI", 2);
  out << in_double(1.0) << in_double(1.0) << in_double(1.0) << '\n'
      << in_double(kelvin_at_0_celsius) << '\n'
      << delimiter;
}

void write_nodes_in_single(std::ostream& out, const TetMesh& mesh) {
  open_data_set(out, 15);
  for (Eigen::Index node = 0; node < mesh.nodes_m.rows(); ++node) {
    const auto at_m = mesh.nodes_m.row(node);
    print(out, "{:>10}{:>10}{:>10}{:>10}{:>13.5E}{:>13.5E}{:>13.5E}\n", node + 1, 0, 0, 1, at_m[0],
          at_m[1], at_m[2]);
  }
  out << delimiter;
}

void write_nodes_in_double(std::ostream& out, const TetMesh& mesh) {
  open_data_set(out, 2411);
  for (Eigen::Index node = 0; node < mesh.nodes_m.rows(); ++node) {
    const auto at_m = mesh.nodes_m.row(node);
    print(out, "{:>10}{:>10}{:>10}{:>10}\n", node + 1, 1, 1, 1);
    out << in_double(at_m[0]) << in_double(at_m[1]) << in_double(at_m[2]) << '\n';
  }
  out << delimiter;
}

// Nodes of the triangle 0 1 2 all round, then mid-side nodes of the edges to the corner 3, then
// this corner.
constexpr std::array<int, 10> parabolic_order{0, 4, 1, 5, 2, 6, 7, 8, 9, 3};

void write_elements(std::ostream& out, const TetMesh& mesh) {
  constexpr int solid_linear = 111;
  constexpr int solid_parabolic = 118;
  constexpr Eigen::Index nodes_a_line = 8;
  const bool is_parabolic = mesh.order() == 2;
  open_data_set(out, 2412);
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    const Eigen::Index nodes = mesh.tets.cols();
    print(out, "{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", tet + 1,
          is_parabolic ? solid_parabolic : solid_linear, 1, 1, 1, nodes);
    for (Eigen::Index i = 0; i < nodes; ++i) {
      const Eigen::Index node = is_parabolic ? parabolic_order.at(static_cast<std::size_t>(i)) : i;
      print(out, "{:>10}", mesh.tets(tet, node) + 1);
      if (i % nodes_a_line == nodes_a_line - 1 || i == nodes - 1) {
        out << '\n';
      }
    }
  }
  out << delimiter;
}

void write_mode(std::ostream& out, const ModalModel& modal, Eigen::Index mode,
                const Eigen::VectorXd& shape) {
  open_data_set(out, 55);
  print(out, "mode {}, {:.6g} Hz\nmass-normalised displacement, 1/sqrt(kg)\nNONE\nNONE\nNONE\n",
        mode + 1, modal.frequency_hz[mode]);
  // structural; normal modes; three translations; displacement; real; 3 values a node
  print(out, "{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", 1, 2, 2, 8, 2, 3);
  print(out, "{:>10}{:>10}{:>10}{:>10}\n", 2, 4, 1, mode + 1);
  print(out, "{:>13.5E}{:>13.5E}{:>13.5E}{:>13.5E}\n", modal.frequency_hz[mode], 1.0,
        modal.damping_ratio[mode], 0.0);
  for (Eigen::Index node = 0; node < shape.size() / 3; ++node) {
    print(out, "{:>10}\n{:>13.5E}{:>13.5E}{:>13.5E}\n", node + 1, shape[3 * node],
          shape[3 * node + 1], shape[3 * node + 2]);
  }
  out << delimiter;
}
}  // namespace

void write_universal_file(const SolvedBody& body, const ModalModel& modal, double density_kg_per_m3,
                          const std::string& file) {
  write_new_file(file, [&](std::ostream& out) {
    write_units(out);
    write_nodes_in_single(out, body.mesh);
    write_nodes_in_double(out, body.mesh);
    write_elements(out, body.mesh);
    for (Eigen::Index mode = 0; mode < modal.frequency_hz.size(); ++mode) {
      // the body was solved at unit density
      write_mode(out, modal, mode, body.displacement.col(mode) / std::sqrt(density_kg_per_m3));
    }
  });
}
}  // namespace tapstudy::core
