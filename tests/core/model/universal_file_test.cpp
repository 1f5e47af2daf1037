// The model as a universal file, read by the widths of fields that the format's description states.
#include "core/model/universal_file.hpp"

#include <algorithm>
#include <map>
#include <sstream>

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
using Lines = std::vector<std::string>;

// The lines of each data set, by its number, in order.
std::multimap<int, Lines> data_sets_of(const std::string& text) {
  std::multimap<int, Lines> sets;
  std::istringstream stream{text};
  for (std::string line; std::getline(stream, line);) {
    REQUIRE(line == "    -1");
    std::getline(stream, line);
    REQUIRE(line.size() == 6);
    const auto set = sets.emplace(std::stoi(line), Lines{});
    while (std::getline(stream, line) && line != "    -1") {
      REQUIRE(line.size() <= 80);
      set->second.push_back(line);
    }
  }
  return sets;
}

// Field `at` (from 0) of those of one width.
double field(const std::string& line, std::size_t width, std::size_t at, std::size_t from = 0) {
  std::string text = line.substr(from + at * width, width);
  REQUIRE(text.size() == width);
  std::ranges::replace(text, 'D', 'E');
  return std::stod(text);
}
int whole(const std::string& line, std::size_t at) {
  return static_cast<int>(field(line, 10, at));
}

struct SmallModel {
  core::SolvedBody body;
  core::ModalModel modal;
};
constexpr double block_density_kg_per_m3 = 4.0;

SmallModel small_model(int order) {
  SmallModel model;
  core::TetMesh& mesh = model.body.mesh;
  mesh.nodes_m.resize(4, 3);
  mesh.nodes_m << 0.0, 0.0, 0.0, 1.0 / 3.0, 0.0, 0.0, 0.0, 0.7, 0.0, -0.1, 0.2, 1e-7;
  mesh.tets.resize(1, 4);
  mesh.tets << 0, 1, 2, 3;
  mesh.surface.resize(1, 3);
  mesh.surface << 0, 2, 1;
  if (order == 2) {
    mesh = core::to_quadratic(mesh);
  }
  model.body.displacement.resize(mesh.nodes_m.size(), 2);
  for (Eigen::Index i = 0; i < model.body.displacement.size(); ++i) {
    model.body.displacement(i) = std::cos(1.7 * static_cast<double>(i)) * 1e-3;
  }
  model.modal.frequency_hz = Eigen::ArrayXd{{41.25, 1234.5}};
  model.modal.damping_ratio = Eigen::ArrayXd{{0.015, 0.25}};
  return model;
}

void check_nodes(const std::multimap<int, Lines>& sets, const core::TetMesh& mesh) {
  const Lines& single = sets.find(15)->second;
  const Lines& twice = sets.find(2411)->second;
  REQUIRE(std::ssize(single) == mesh.nodes_m.rows());
  REQUIRE(std::ssize(twice) == 2 * mesh.nodes_m.rows());
  for (std::size_t node = 0; node < single.size(); ++node) {
    CHECK(whole(single[node], 0) == static_cast<int>(node) + 1);
    CHECK(whole(twice[2 * node], 0) == static_cast<int>(node) + 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double at_m =
          mesh.nodes_m(static_cast<Eigen::Index>(node), static_cast<Eigen::Index>(axis));
      CHECK(field(single[node], 13, axis, 40) == Approx(at_m).epsilon(1e-5));
      CHECK(field(twice[2 * node + 1], 25, axis) == at_m);
    }
  }
}

// Node labels of the one element.
std::vector<Eigen::Index> nodes_of_element(const Lines& element) {
  std::vector<Eigen::Index> nodes;
  for (int i = 0; i < whole(element[0], 5); ++i) {
    const auto at = static_cast<std::size_t>(i);
    nodes.push_back(whole(element[1 + at / 8], at % 8) - 1);
  }
  return nodes;
}
}  // namespace

TEST_CASE("a universal file holds nodes and elements as its format describes them",
          "[core][universal_file]") {
  const int order = GENERATE(1, 2);
  const SmallModel model = small_model(order);
  const testing::TempDirectory directory;
  const std::string file = directory / "body.uff";
  core::write_universal_file(model.body, model.modal, block_density_kg_per_m3, file);
  const auto sets = data_sets_of(testing::contents(file));
  CHECK(whole(sets.find(164)->second[0], 0) == 1);  // SI
  check_nodes(sets, model.body.mesh);
  const Lines& element = sets.find(2412)->second;
  CHECK(whole(element[0], 1) == (order == 2 ? 118 : 111));
  const auto nodes = nodes_of_element(element);
  const auto place = [&](std::size_t i) -> Eigen::RowVector3d {
    return model.body.mesh.nodes_m.row(nodes.at(i));
  };
  if (order == 1) {
    CHECK(nodes == std::vector<Eigen::Index>{0, 1, 2, 3});
    return;
  }
  // corner and mid-side nodes take turns round the base, then the sides up to the tip, the tip last
  const std::array<std::array<std::size_t, 3>, 6> middles{
      {{1, 0, 2}, {3, 2, 4}, {5, 4, 0}, {6, 0, 9}, {7, 2, 9}, {8, 4, 9}}};
  for (const auto& [middle, one, other] : middles) {
    CHECK((place(middle) - 0.5 * (place(one) + place(other))).norm() < 1e-12);
  }
}

TEST_CASE("a universal file holds each mode's frequency, damping and mass-normalised shape",
          "[core][universal_file]") {
  const SmallModel model = small_model(1);
  const testing::TempDirectory directory;
  const std::string file = directory / "body.uff";
  core::write_universal_file(model.body, model.modal, block_density_kg_per_m3, file);
  const auto sets = data_sets_of(testing::contents(file));
  REQUIRE(sets.count(55) == 2);
  Eigen::Index mode = 0;
  for (auto [set, end] = sets.equal_range(55); set != end; ++set, ++mode) {
    const Lines& lines = set->second;
    REQUIRE(lines.size() == 8 + 2 * 4);
    const std::vector<int> kind{1, 2, 2, 8, 2, 3};  // normal mode, real displacements, 3 a node
    for (std::size_t i = 0; i < kind.size(); ++i) {
      CHECK(whole(lines[5], i) == kind[i]);
    }
    CHECK(whole(lines[6], 3) == mode + 1);
    CHECK(field(lines[7], 13, 0) == Approx(model.modal.frequency_hz[mode]));
    CHECK(field(lines[7], 13, 1) == 1.0);
    CHECK(field(lines[7], 13, 2) == Approx(model.modal.damping_ratio[mode]));
    for (std::size_t node = 0; node < 4; ++node) {
      CHECK(whole(lines[8 + 2 * node], 0) == static_cast<int>(node) + 1);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        // solved at unit density: of a body four times as dense half the displacement
        const double moved =
            0.5 * model.body.displacement(static_cast<Eigen::Index>(3 * node + axis), mode);
        CHECK(field(lines[9 + 2 * node], 13, axis) == Approx(moved).epsilon(1e-5));
      }
    }
  }
  CHECK_THROWS_AS(
      core::write_universal_file(model.body, model.modal, block_density_kg_per_m3, file),
      core::InvalidInput);
}
