#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/model/fixation.hpp"
#include "core/model/plate.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
// Bodies and springs as CalculiX reads them, and what it says of them.
namespace tapstudy::testing {
constexpr const char* calculix = "/usr/bin/ccx";

class CalculixInput {
 public:
  CalculixInput() { text_.precision(12); }  // CalculiX reads twenty characters a number

  // Of order 2: a T10's nodes are numbered as ours. Returns the number of the body's first node.
  Eigen::Index add_body(const core::Plate& plate, const core::Material& material,
                        const core::TetMesh& mesh) {
    const Eigen::Index first = nodes_ + 1;
    const auto name = fmt::format("BODY{}", first);
    text_ << "*NODE, NSET=ALL\n";
    for (Eigen::Index i = 0; i < mesh.nodes_m.rows(); ++i) {
      text_ << first + i << ',' << mesh.nodes_m(i, 0) << ',' << mesh.nodes_m(i, 1) << ','
            << mesh.nodes_m(i, 2) << '\n';
    }
    nodes_ += mesh.nodes_m.rows();
    text_ << "*ELEMENT, TYPE=C3D10, ELSET=" << name << '\n';
    for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
      text_ << ++elements_;
      for (const int node : mesh.tets.row(tet)) {
        text_ << ',' << first + node;
      }
      text_ << '\n';
    }
    const std::string orientation = add_elasticity(material, first);
    text_ << "*DENSITY\n"
          << material.density_kg_per_m3 << "\n*SOLID SECTION, ELSET=" << name << ", MATERIAL=M"
          << first << orientation << '\n';
    add_constraints(plate, mesh, first);
    for (const core::SpringSupport& support :
         core::spring_supports(mesh, plate.shape, plate.fixations)) {
      add_grounded(support, first);
    }
    return first;
  }

  // Between two nodes, along one axis.
  void add_spring(Eigen::Index from, Eigen::Index to, Eigen::Index axis, double n_per_m) {
    ++elements_;
    text_ << fmt::format(
        "*ELEMENT, TYPE=SPRING2, ELSET=S{0}\n{0},{1},{2}\n*SPRING, ELSET=S{0}\n{3},{3}\n{4:.9e}\n",
        elements_, from, to, axis + 1, n_per_m);
  }

  std::string with_step(const std::string& step) const {
    return text_.str() + "*STEP\n" + step + "\n*END STEP\n";
  }

 private:
  // Returns what the section says of the material's axes.
  std::string add_elasticity(const core::Material& material, Eigen::Index first) {
    if (!material.orthotropy) {
      text_ << "*MATERIAL, NAME=M" << first << "\n*ELASTIC\n"
            << material.youngs_modulus_pa << ',' << material.poissons_ratio << '\n';
      return {};
    }
    const core::Orthotropy& elasticity = *material.orthotropy;
    const Eigen::Matrix3d axes = core::rotation(elasticity.rotation_rad);
    text_ << "*ORIENTATION, NAME=O" << first << ", SYSTEM=RECTANGULAR\n"
          << axes(0, 0) << ',' << axes(1, 0) << ',' << axes(2, 0) << ',' << axes(0, 1) << ','
          << axes(1, 1) << ',' << axes(2, 1) << "\n*MATERIAL, NAME=M" << first
          << "\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n";
    const double unit_pa = material.youngs_modulus_pa;
    for (const double modulus : elasticity.moduli) {
      text_ << modulus * unit_pa << ',';
    }
    for (const double ratio : elasticity.poissons_ratios) {
      text_ << ratio << ',';
    }
    text_ << elasticity.shear_moduli[0] * unit_pa << ',' << elasticity.shear_moduli[1] * unit_pa
          << '\n'
          << elasticity.shear_moduli[2] * unit_pa << '\n';
    return fmt::format(", ORIENTATION=O{}", first);
  }
  void add_constraints(const core::Plate& plate, const core::TetMesh& mesh, Eigen::Index first) {
    const auto held = core::constrained_dofs(mesh, plate.shape, plate.fixations);
    text_ << "*BOUNDARY\n";
    for (std::size_t dof = 0; dof < held.size(); ++dof) {
      if (held[dof]) {
        text_ << first + static_cast<Eigen::Index>(dof / 3) << ',' << dof % 3 + 1 << '\n';
      }
    }
  }
  // One for each node and axis: of supports that hold no whole triangle.
  void add_grounded(const core::SpringSupport& support, Eigen::Index first) {
    for (const Eigen::Index node : support.region.nodes) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double share =
            support.stiffness_n_per_m[axis] / static_cast<double>(support.region.nodes.size());
        text_ << fmt::format(
            "*ELEMENT, TYPE=SPRING1, ELSET=S{0}\n{0},{1}\n*SPRING, ELSET=S{0}\n{2}\n{3:.9e}\n",
            ++elements_, first + node, axis + 1, share);
      }
    }
  }

  std::ostringstream text_;
  Eigen::Index nodes_{0};
  Eigen::Index elements_{0};
};

// Its results are in directory/body.*
inline void run_calculix(const std::string& input, const TempDirectory& directory) {
  write(directory / "body.inp", input);
  const auto run =
      run_program({"/bin/sh", "-c", fmt::format("cd {} && {} body", directory / ".", calculix)});
  INFO(run.standard_output);
  REQUIRE(run.exit_code == 0);
}

// The column "FREQUENCY (CYCLES/TIME)" of the .dat file.
inline std::vector<double> calculix_hz(const std::string& input, int modes) {
  const TempDirectory directory;
  run_calculix(input, directory);
  std::ifstream results{directory / "body.dat"};
  std::vector<double> hz;
  for (std::string line; std::getline(results, line) && static_cast<int>(hz.size()) < modes;) {
    std::istringstream row{line};
    int number{};
    double eigenvalue{};
    double rad_s{};
    double cycles{};
    if (row >> number >> eigenvalue >> rad_s >> cycles) {
      hz.push_back(cycles);
    }
  }
  return hz;
}
inline std::vector<double> calculix_hz(const CalculixInput& input, int modes) {
  return calculix_hz(input.with_step(fmt::format("*FREQUENCY\n{}", modes)), modes);
}
}  // namespace tapstudy::testing
