// Surfaces that enclose no body yet: what repair makes of them, and what it refuses.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "core/model/mesh/wanted_order.hpp"
#include "core/model/shape/shape.hpp"
#include "protocols/reader/earlier_defaults.hpp"
#include "protocols/surface/check_surface.hpp"
#include "protocols/surface/repair_command.hpp"
#include "protocols/surface/repair_surface.hpp"
#include "protocols/surface/repaired_surface.hpp"
#include "protocols/surface/surface_file.hpp"
#include "support/catch.hpp"
#include "support/sharp_fins.hpp"
#include "support/surfaces.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
core::TriangleSurface as_it_is_read(const core::TriangleSurface& surface) {
  return protocols::read_surface(
             protocols::surface_source("body.ply", protocols::ply_text(surface)), 1.0)
      .surface;
}
bool are_bitwise_equal(const core::TriangleSurface& a, const core::TriangleSurface& b) {
  return a.points_m.rows() == b.points_m.rows() && a.triangles.rows() == b.triangles.rows() &&
         a.points_m == b.points_m && a.triangles == b.triangles;
}
// A frame of square cells around one that is empty: a body with a handle, of volume 8 mL.
core::TriangleSurface frame() {
  return as_it_is_read(
      testing::cells_surface({0.0, 0.0, 0.0}, {0.01, 0.01, 0.01}, {3, 3, 1},
                             [](const Eigen::Vector3i& at) { return at[0] != 1 || at[1] != 1; }));
}
constexpr double frame_volume_m3 = 8e-6;

core::TriangleSurface cube_at(double low_m, double side_m) {
  return testing::cells_surface(Eigen::Vector3d::Constant(low_m), Eigen::Vector3d::Constant(side_m),
                                {1, 1, 1}, [](const Eigen::Vector3i&) { return true; });
}
// A ball's skin between two spheres, with a tube through it: a body of one piece and little
// thickness.
core::TriangleSurface thin_shell() {
  constexpr double thick = 0.002;
  return testing::wrapped_surface(24, 40, [](int i, int j) -> Eigen::RowVector3d {
    const double along = j < 20 ? (j + 0.5) / 20.0 : (39.5 - j) / 20.0;
    const double radius = j < 20 ? 0.05 : 0.05 * (1.0 - thick);
    const double polar = 0.4 + 2.3 * along;
    const double turn = -2.0 * M_PI * i / 24;
    return {radius * std::sin(polar) * std::cos(turn), radius * std::sin(polar) * std::sin(turn),
            radius * std::cos(polar)};
  });
}
core::TriangleSurface without_triangles(const core::TriangleSurface& surface, int count) {
  core::TriangleSurface open = surface;
  open.triangles = surface.triangles.bottomRows(surface.triangles.rows() - count).eval();
  return open;
}
void check_restored(const protocols::SurfaceRepair& repair) {
  CHECK_NOTHROW(protocols::check_surface(repair.surface));
  CHECK(are_bitwise_equal(as_it_is_read(repair.surface), repair.surface));
  CHECK(core::volume_m3(repair.surface) == Approx(frame_volume_m3).epsilon(1e-4));
}
}  // namespace

TEST_CASE("a surface that encloses a body is not changed by repair, to the bit",
          "[protocols][surface][repair]") {
  const core::TriangleSurface body = frame();
  const protocols::SurfaceRepair repair = protocols::repair_surface(body, {.wrap_m = 0.001});
  CHECK(are_bitwise_equal(repair.surface, body));
  CHECK(repair.kept == body.triangles.rows());
  CHECK(repair.turned + repair.dropped + repair.added + repair.corners_joined == 0);
  CHECK_FALSE(repair.wrap_offset_m);
  CHECK(repair.farthest_from_old_m == Approx(0.0).margin(1e-12));
}

TEST_CASE("a flat hole is filled with what was cut out, and is measured",
          "[protocols][surface][repair]") {
  core::TriangleSurface open = frame();
  open.triangles = open.triangles.topRows(open.triangles.rows() - 1).eval();
  const Eigen::RowVector3i lost = frame().triangles.bottomRows(1);
  double around_m = 0.0;
  for (int k = 0; k < 3; ++k) {
    around_m += (open.points_m.row(lost[k]) - open.points_m.row(lost[(k + 1) % 3])).norm();
  }
  const protocols::SurfaceRepair repair = protocols::repair_surface(open, {});
  check_restored(repair);
  CHECK(repair.holes.filled == 1);
  CHECK(repair.holes.longest_m == Approx(around_m));
  CHECK(repair.added == 1);
  CHECK_FALSE(repair.volume_before_m3);
  CHECK(repair.surface.triangles == frame().triangles);
}

TEST_CASE("filling a hole moves the volume by less than the hole's hull holds",
          "[protocols][surface][repair]") {
  const core::TriangleSurface body = frame();
  const int cut = GENERATE(3, 5);
  const core::TriangleSurface open = without_triangles(body, cut);
  const protocols::SurfaceRepair repair = protocols::repair_surface(open, {.longest_hole_m = 1.0});
  CHECK_NOTHROW(protocols::check_surface(repair.surface));
  core::Vec3 low_m = core::Vec3::Constant(1.0);
  core::Vec3 high_m = -low_m;
  for (const int corner : body.triangles.topRows(cut).reshaped()) {
    low_m = low_m.cwiseMin(body.points_m.row(corner).transpose());
    high_m = high_m.cwiseMax(body.points_m.row(corner).transpose());
  }
  CHECK(std::abs(core::volume_m3(repair.surface) - frame_volume_m3) <=
        (high_m - low_m).prod() + 1e-15);
}

TEST_CASE("triangles that face the wrong way are turned outward", "[protocols][surface][repair]") {
  core::TriangleSurface turned = frame();
  const bool is_whole = GENERATE(true, false);
  const Eigen::Index count = is_whole ? turned.triangles.rows() : 3;
  for (Eigen::Index i = 0; i < count; ++i) {
    std::swap(turned.triangles(i, 1), turned.triangles(i, 2));
  }
  const protocols::SurfaceRepair repair = protocols::repair_surface(turned, {});
  check_restored(repair);
  CHECK(repair.turned == count);
  CHECK(repair.added + repair.dropped == 0);
}

TEST_CASE("a corner that stands apart within the stated share of the size is joined",
          "[protocols][surface][repair]") {
  core::TriangleSurface split = frame();
  const double size_m = core::bounds(split).size_m().norm();
  split.points_m.conservativeResize(split.points_m.rows() + 1, 3);
  split.points_m.bottomRows(1) =
      split.points_m.row(0) + Eigen::RowVector3d{4e-6 * size_m, 0.0, 0.0};
  split.triangles(0, 0) = static_cast<int>(split.points_m.rows()) - 1;
  const core::TriangleSurface read = as_it_is_read(split);
  REQUIRE_THROWS(protocols::check_surface(read));
  const protocols::SurfaceRepair repair = protocols::repair_surface(read, {});
  check_restored(repair);
  CHECK(repair.corners_joined == 1);
  CHECK(repair.holes.filled == 0);
}

TEST_CASE("a triangle whose corner lies on its opposite side is replaced",
          "[protocols][surface][repair]") {
  core::TriangleSurface capped = frame();
  // a side's middle, belonging to one of its two triangles only, and a triangle without area
  // between
  const Eigen::RowVector3i t = capped.triangles.row(0);
  const int middle = static_cast<int>(capped.points_m.rows());
  capped.points_m.conservativeResize(middle + 1, 3);
  capped.points_m.row(middle) = 0.5 * (capped.points_m.row(t[0]) + capped.points_m.row(t[1]));
  capped.triangles.conservativeResize(capped.triangles.rows() + 2, 3);
  capped.triangles.row(0) << t[0], middle, t[2];
  capped.triangles.bottomRows(2) << middle, t[1], t[2], t[0], t[1], middle;
  const core::TriangleSurface read = as_it_is_read(capped);
  REQUIRE_THROWS(protocols::check_surface(read));
  const protocols::SurfaceRepair repair = protocols::repair_surface(read, {});
  check_restored(repair);
  CHECK(repair.surface.triangles.rows() == read.triangles.rows());
}

TEST_CASE("two bodies that cross are refused until they are wrapped, in what contains both",
          "[protocols][surface][repair]") {
  const core::TriangleSurface one = cube_at(0.0, 0.02);
  const core::TriangleSurface other = cube_at(0.01, 0.02);
  const core::TriangleSurface crossing = as_it_is_read(testing::joined_surfaces(one, other));
  CHECK_THROWS_WITH(protocols::repair_surface(crossing, {}), Contains("--wrap"));
  constexpr double wrap_m = 0.002;
  const protocols::SurfaceRepair repair = protocols::repair_surface(crossing, {.wrap_m = wrap_m});
  CHECK(repair.wrap_offset_m);
  CHECK_NOTHROW(protocols::check_surface(repair.surface));
  const core::Bounds around = core::bounds(repair.surface);
  CHECK((around.low_m.array() < 0.0).all());
  CHECK((around.high_m.array() > 0.03).all());
  constexpr double union_m3 = 2.0 * 8e-6 - 1e-6;
  const double volume_m3 = core::volume_m3(repair.surface);
  CHECK(volume_m3 > union_m3);
  CHECK(volume_m3 < union_m3 + repair.area_before_m2 * wrap_m);
  CHECK(repair.farthest_from_old_m < wrap_m);
  CHECK(repair.farthest_from_old_m > 0.5 * wrap_m / 30.0);
}

TEST_CASE("a wrap that goes inside by a hole is told, with the volume of what fills it",
          "[protocols][surface][repair]") {
  const core::TriangleSurface open =
      as_it_is_read(without_triangles(testing::box_surface({0.03, 0.02, 0.01}), 1));
  protocols::RepairRequest request{.longest_hole_m = 0.01, .wrap_m = 0.002};
  const auto told = [&] {
    return fmt::format(
        "{}", fmt::join(describe_changes(protocols::repair_surface(open, request), request), "\n"));
  };
  CHECK_THAT(told(), Contains("warning: the wrap goes inside by a hole") &&
                         Contains("encloses 6e-06 m³ (--largest-hole 0."));
  request.longest_hole_m = 1.0;
  CHECK_THAT(told(), !Contains("warning") && Contains("volume: 6e-06 m³"));
}

TEST_CASE("a wrap that makes a skin of a body, whose gaps it does not bridge, says so",
          "[protocols][surface][repair]") {
  const core::TriangleSurface open = without_triangles(frame(), 2);
  const auto told = [&](double wrap_m) {
    const protocols::RepairRequest request{.wrap_m = wrap_m};
    return fmt::format(
        "{}", fmt::join(describe_changes(protocols::repair_surface(open, request), request), "\n"));
  };
  CHECK_THAT(told(0.001),
             Contains("warning: the result is a skin about") && Contains("try a larger --wrap"));
  CHECK_THAT(told(0.02), !Contains("skin"));
}

TEST_CASE("holes that were filled before a wrap are counted", "[protocols][surface][repair]") {
  const core::TriangleSurface crossing =
      testing::joined_surfaces(without_triangles(cube_at(0.0, 0.01), 1), cube_at(0.005, 0.01));
  const core::TriangleSurface apart =
      as_it_is_read(testing::joined_surfaces(crossing, cube_at(0.1, 0.002)));
  const protocols::SurfaceRepair repair =
      protocols::repair_surface(apart, {.is_largest_piece_only = true, .wrap_m = 0.001});
  CHECK(repair.wrap_offset_m);
  CHECK(repair.pieces_dropped == 1);
  CHECK(repair.holes.filled == 1);
}

TEST_CASE("holes that touch each other in one corner are not filled but refused",
          "[protocols][surface][repair]") {
  const core::TriangleSurface open = without_triangles(frame(), 2);
  CHECK_THROWS_WITH(protocols::repair_surface(open, {.longest_hole_m = 1.0}),
                    Contains("open") && Contains("nothing is written") &&
                        !Contains("--largest-hole"));  // which would not help
  const core::TriangleSurface with_long_hole = without_triangles(frame(), 3);
  CHECK_THROWS_WITH(protocols::repair_surface(with_long_hole, {.longest_hole_m = 1e-3}),
                    Contains("--largest-hole"));
}

TEST_CASE("of several pieces the largest is kept where that is asked for",
          "[protocols][surface][repair]") {
  const core::TriangleSurface apart =
      as_it_is_read(testing::joined_surfaces(frame(), cube_at(0.1, 0.002)));
  CHECK_THROWS_WITH(protocols::repair_surface(apart, {}), Contains("--largest-piece"));
  const protocols::SurfaceRepair repair =
      protocols::repair_surface(apart, {.is_largest_piece_only = true});
  check_restored(repair);
  CHECK(repair.pieces_dropped == 1);
  CHECK(repair.dropped == 12);
}

TEST_CASE("a triangle left over beside a body is dropped by what is advised, which wraps nothing",
          "[protocols][surface][repair]") {
  const core::TriangleSurface left_over = testing::surface_of(
      {{0.001, 0.001, 0.012}, {0.002, 0.001, 0.012}, {0.001, 0.002, 0.013}}, {{0, 1, 2}});
  const core::TriangleSurface spiked = as_it_is_read(testing::joined_surfaces(frame(), left_over));
  const std::string cure = protocols::cures(spiked, "box.stl", 1.0);
  CHECK_THAT(cure, Contains("--largest-piece --out") && Contains("repair: {largest_piece: true}") &&
                       !Contains("--wrap"));
  check_restored(protocols::repair_surface(spiked, {.is_largest_piece_only = true}));
  CHECK_THAT(protocols::cures(as_it_is_read(testing::joined_surfaces(frame(), cube_at(0.1, 0.01))),
                              "two.stl", 1.0),
             Contains("--wrap"));
}

TEST_CASE("a repair that makes another body says how much larger it is",
          "[protocols][surface][repair]") {
  const auto lines_of = [](const core::TriangleSurface& surface, double wrap_m) {
    const protocols::RepairRequest request{.is_largest_piece_only = true, .wrap_m = wrap_m};
    return fmt::format("{}", fmt::join(protocols::describe_changes(
                                           protocols::repair_surface(surface, request), request),
                                       "\n"));
  };
  core::TriangleSurface cavity = cube_at(0.005, 0.01);
  cavity.triangles.col(1).swap(cavity.triangles.col(2));
  const core::TriangleSurface hollow =
      as_it_is_read(testing::joined_surfaces(cube_at(0.0, 0.02), cavity));
  CHECK_THAT(lines_of(hollow, 0.002), Contains("times what it did"));  // 8 of 7 mL and more
  CHECK_THAT(lines_of(without_triangles(frame(), 1), 0.001), !Contains("warning"));
  // The law: a layer of the offset on all sides.
  const core::TriangleSurface doubled =
      as_it_is_read(testing::joined_surfaces(cube_at(0.0, 0.01), cube_at(0.005, 0.01)));
  CHECK_THAT(lines_of(doubled, 0.001), Contains("% larger"));
}

TEST_CASE("a sheet is wrapped into a skin a third as thick as what the wrap bridges",
          "[protocols][surface][repair]") {
  constexpr double side_m = 0.02;
  const core::TriangleSurface sheet = testing::surface_of(
      {{0.0, 0.0, 0.0}, {side_m, 0.0, 0.0}, {side_m, side_m, 0.0}, {0.0, side_m, 0.002}},
      {{0, 1, 2}, {0, 2, 3}});
  constexpr double wrap_m = 0.001;
  const protocols::SurfaceRepair repair =
      protocols::repair_surface(as_it_is_read(sheet), {.longest_hole_m = 0.01, .wrap_m = wrap_m});
  CHECK_NOTHROW(protocols::check_surface(repair.surface));
  const double thickness_m =
      core::volume_m3(repair.surface) / (0.5 * protocols::area_m2(repair.surface));
  CHECK(thickness_m == Approx(wrap_m / 3.0).epsilon(0.1));
  CHECK(repair.wrap_offset_m.value() == Approx(wrap_m / 6.0));
}

TEST_CASE(
    "pieces within what a wrap bridges are one body with the largest, those further away are "
    "dropped",
    "[protocols][surface][repair]") {
  const core::TriangleSurface near = testing::joined_surfaces(
      cube_at(0.0, 0.02), testing::cells_surface({0.0, 0.0, 0.021}, {0.02, 0.02, 0.01}, {1, 1, 1},
                                                 [](const Eigen::Vector3i&) { return true; }));
  const core::TriangleSurface pieces =
      as_it_is_read(testing::joined_surfaces(near, cube_at(0.1, 0.005)));
  const protocols::SurfaceRepair repair =
      protocols::repair_surface(pieces, {.is_largest_piece_only = true, .wrap_m = 0.002});
  CHECK_NOTHROW(protocols::check_surface(repair.surface));
  CHECK(repair.wrap_offset_m);
  CHECK(repair.pieces_dropped == 1);
  const core::Bounds around = core::bounds(repair.surface);
  CHECK((around.high_m - core::Vec3{0.02, 0.02, 0.031}).norm() < 0.001);
  CHECK(core::volume_m3(repair.surface) > 8e-6 + 4e-6);
}

TEST_CASE("a piece further away than a wrap bridges is dropped without wrapping the rest",
          "[protocols][surface][repair]") {
  const core::TriangleSurface apart =
      as_it_is_read(testing::joined_surfaces(frame(), cube_at(0.1, 0.002)));
  const protocols::SurfaceRepair repair =
      protocols::repair_surface(apart, {.is_largest_piece_only = true, .wrap_m = 0.002});
  check_restored(repair);
  CHECK_FALSE(repair.wrap_offset_m);
  CHECK(repair.pieces_dropped == 1);
}

TEST_CASE("what runs through itself once it is simplified is wrapped where that is asked for",
          "[protocols][surface][repair]") {
  const core::TriangleSurface shell = as_it_is_read(thin_shell());
  REQUIRE_NOTHROW(protocols::check_surface(shell));
  CHECK_THROWS_WITH(protocols::repair_surface(shell, {.max_triangles = 700}),
                    Contains("runs through itself") && Contains("simplified"));
  const protocols::SurfaceRepair repair =
      protocols::repair_surface(shell, {.wrap_m = 0.012, .max_triangles = 700});
  CHECK_NOTHROW(protocols::check_surface(repair.surface));
  CHECK(repair.wrap_offset_m);
  CHECK(repair.surface.triangles.rows() <= 700);
}

TEST_CASE(
    "the command for a refused surface is one shell word an argument, and simplifies what has too "
    "many triangles",
    "[protocols][surface][repair]") {
  const core::TriangleSurface body = frame();
  CHECK_THAT(protocols::cures(body, "my 'mug'.stl", 0.001),
             Contains(R"(repair 'my '\''mug'\''.stl' --metres-per-unit 0.001 --wrap)") &&
                 Contains("--max-triangles 20000") && !Contains("--largest-hole"));
  core::TriangleSurface large = body;
  large.triangles = body.triangles.replicate(200'001 / body.triangles.rows() + 1, 1).eval();
  CHECK_THROWS_AS(protocols::check_count(large), protocols::SurfaceFault);
  CHECK_THAT(protocols::cures(large, "mug.stl", 1.0), Contains("--max-triangles 10000"));
}

TEST_CASE("a surface that the mesher cannot fill is refused with the command that simplifies it",
          "[protocols][surface][repair]") {
  const core::TriangleSurface crossing = testing::joined_surfaces(
      testing::icosphere_surface(0.02, 4),
      testing::box_surface({0.03, 0.01, 0.03}));  // as only a fault of check_surface lets through
  const core::Shape body = core::Solid{crossing, "tapstudy repair this"};
  CHECK_THROWS_WITH(core::mesh_shape(body, {}), Contains("; try: tapstudy repair this"));
}

TEST_CASE("what the mesher cannot fill is wrapped where that is asked for",
          "[protocols][surface][repair][slow]") {
  const core::TriangleSurface finned = as_it_is_read(testing::sharp_fins(16, 1e-5));
  REQUIRE_NOTHROW(protocols::check_surface(finned));
  CHECK_FALSE(protocols::repair_surface(finned, {}).wrap_offset_m);
  const protocols::SurfaceRepair repair =
      protocols::repair_surface(finned, {.wrap_m = 0.02, .max_triangles = 1000});
  CHECK(repair.wrap_offset_m);
  CHECK_NOTHROW(core::mesh_shape(core::Solid{repair.surface}, {}));
}

TEST_CASE("a closed surface without volume is wrapped into a skin",
          "[protocols][surface][repair]") {
  constexpr double side_m = 0.02;
  const core::TriangleSurface flat = as_it_is_read(testing::surface_of(
      {{0.0, 0.0, 0.0}, {side_m, 0.0, 0.0}, {side_m, side_m, 0.0}, {0.0, side_m, 0.0}},
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}));
  CHECK_THROWS_AS(protocols::check_surface(flat), protocols::SurfaceFault);
  CHECK_THROWS_WITH(protocols::check_surface(flat), Contains("no volume"));
  CHECK(protocols::repair_surface(flat, {.wrap_m = 0.002}).wrap_offset_m);
}

TEST_CASE("a flat-sided body keeps its volume when it is simplified",
          "[protocols][surface][repair]") {
  const core::TriangleSurface fine =
      as_it_is_read(testing::cells_surface({0.0, 0.0, 0.0}, {0.005, 0.005, 0.005}, {4, 4, 4},
                                           [](const Eigen::Vector3i&) { return true; }));
  const protocols::SurfaceRepair repair = protocols::repair_surface(fine, {.max_triangles = 40});
  CHECK(repair.surface.triangles.rows() <= 40);
  CHECK(core::volume_m3(repair.surface) == Approx(8e-6).epsilon(1e-6));
  CHECK(repair.farthest_from_new_m < 1e-8);
}

// tests/data/every_key.yaml with another tetrahedron, in memory.
namespace {
std::string whole_tetrahedron() {
  return testing::contents(testing::source("tests/data/tetrahedron.off"));
}
std::string open_tetrahedron() {
  return testing::replaced(testing::replaced(whole_tetrahedron(), "4 4 0", "4 3 0"), "3 0 2 1\n",
                           "");
}
// With a small one within it.
std::string hollow_tetrahedron() {
  const core::TriangleSurface outer =
      protocols::read_surface(protocols::surface_source("outer.off", whole_tetrahedron()), 1.0)
          .surface;
  core::TriangleSurface inner = outer;
  const Eigen::RowVector3d centre = outer.points_m.colwise().mean();
  inner.points_m = (0.2 * (outer.points_m.rowwise() - centre)).rowwise() + centre;
  const core::TriangleSurface both = testing::joined_surfaces(outer, inner);
  std::string text = fmt::format("OFF\n{} {} 0\n", both.points_m.rows(), both.triangles.rows());
  for (const auto& p : both.points_m.rowwise()) {
    text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
  }
  for (const auto& t : both.triangles.rowwise()) {
    text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  }
  return text;
}
protocols::Protocol protocol_with(const std::string& repair, const std::string& surface) {
  const std::string file = testing::source("tests/data/every_key.yaml");
  std::string text = testing::contents(file);
  const auto sheet = text.find("  shell_of_tetrahedron:\n");  // whose surface cannot be repaired
  text.erase(sheet, text.find("  tetrahedron:\n") - sheet);
  const auto from = text.find("repair: {");
  text.replace(from, text.find('}', from) + 1 - from, repair);
  return protocols::parse_protocol({text, file}, [&](const std::string& name) {
    return name.ends_with(".off") ? surface
                                  : testing::contents(testing::source("tests/data/" + name));
  });
}
const core::TriangleSurface& tetrahedron_of(const protocols::Protocol& protocol) {
  return std::get<core::Solid>(protocol.plates.at("tetrahedron")->shape).surface();
}
std::string refusal_with(const std::string& repair, const std::string& surface) {
  try {
    protocol_with(repair, surface);
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}
}  // namespace

TEST_CASE("a surface is repaired where its protocol asks for that, and nowhere else",
          "[protocols][surface][repair]") {
  CHECK_THAT(refusal_with("offset_m: [0, 0, 0]", hollow_tetrahedron()),
             Contains("is a cavity") && !Contains("try:"));  // every repair would fill it
  CHECK_THAT(
      refusal_with("offset_m: [0, 0, 0]", open_tetrahedron()),
      Contains("surface.file") && Contains("try: tapstudy repair") &&
          Contains("--largest-hole 1.05 --wrap 0.0094") &&
          Contains("(of an open sheet without --largest-hole 1.05: a skin, or thickness_m)") &&
          Contains("in the study, beside the file: repair: {largest_hole_m: 1.05, wrap_m: "
                   "0.0094, largest_piece: true, max_triangles: 20000}"));
  const std::size_t made_before = protocols::repairs_made();
  const protocols::Protocol repaired =
      protocol_with("repair: {largest_hole_m: 2}", open_tetrahedron());
  CHECK(protocols::repairs_made() == made_before + 1);
  CHECK(protocol_with("repair: {largest_hole_m: 2}", open_tetrahedron()).surfaces[1].bytes ==
        repaired.surfaces[1].bytes);
  CHECK(protocols::repairs_made() == made_before + 1);
  CHECK(are_bitwise_equal(
      tetrahedron_of(repaired),
      tetrahedron_of(protocol_with("repair: {largest_hole_m: 2}", whole_tetrahedron()))));
  REQUIRE(repaired.surfaces.size() == 2);
  CHECK(repaired.surfaces[0].changes.empty());
  CHECK_THAT(fmt::format("{}", fmt::join(repaired.surfaces[1].changes, "\n")),
             Contains("holes filled: 1") && Contains("triangles: 3 kept, 0 turned, 0 dropped, 1"));
}

TEST_CASE("a face without area is refused with its cure, and what it joins is one body",
          "[protocols][surface][repair]") {
  // a box, between the corners 4 and 5 of its top a sliver: 8 on the front's edge, 9 on the top's
  const std::string with_sliver =
      "OFF\n10 7 0\n0 0 -99\n99 0 -99\n99 99 -99\n0 99 -99\n0 0 0\n99 0 0\n99 99 0\n0 99 0\n"
      "33 0 0\n66 0 0\n"
      "4 3 2 1 0\n5 0 1 5 8 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n5 4 9 5 6 7\n4 4 8 5 9\n";
  CHECK_THAT(refusal_with("offset_m: [0, 0, 0]", with_sliver),
             Contains("the face of 4 corners") && Contains("try: tapstudy repair"));
  const core::TriangleSurface repaired = tetrahedron_of(protocol_with("repair: {}", with_sliver));
  CHECK(core::volume_m3(repaired) == Approx(std::pow(0.099, 3)));
}

TEST_CASE("a study that has begun has the repaired surface that it stored",
          "[protocols][surface][repair]") {
  const protocols::Protocol began =
      protocol_with("repair: {largest_hole_m: 2}", open_tetrahedron());
  std::vector<std::string> asked_for;
  const protocols::ReadFile of_contents = [](const std::string& name) {
    return name == "plates.svg" ? testing::contents(testing::source("tests/data/plates.svg"))
                                : open_tetrahedron();
  };
  const protocols::ReadFile of_repaired = [&](const std::string& name) {
    asked_for.push_back(name);
    return testing::replaced(began.surfaces[1].bytes, "\n-0.1 0.173 ", "\n-0.1 0.174 ");
  };
  const protocols::Protocol gone_on =
      protocols::parse_protocol({began.text, "study.yaml"}, {of_contents, of_repaired}, {});
  CHECK(asked_for == std::vector<std::string>{began.surfaces[1].file});
  CHECK(gone_on.surfaces[1].changes == began.surfaces[1].changes);
  CHECK(core::bounds(tetrahedron_of(gone_on)).high_m.y() == Approx(0.174));
}

TEST_CASE("what a repair of a protocol's surface cannot cure is refused in the protocol's words",
          "[protocols][surface][repair]") {
  const std::string said = refusal_with("repair: {}", open_tetrahedron());
  CHECK_THAT(said,
             Contains("largest_hole_m: 1.05 fills") && Contains("wrap_m: 0.0") && !Contains("--"));
}

// tests/data/every_key.yaml with another sheet, in memory.
namespace {
std::string refusal_of_sheet(const std::string& keys, const std::string& surface) {
  const std::string file = testing::source("tests/data/every_key.yaml");
  const std::string text =
      testing::replaced(testing::contents(file),
                        "{file: tetrahedron.off, metres_per_unit: 0.001, thickness_m: 0.0005}",
                        "{file: sheet.ply, metres_per_unit: 1, " + keys + "}");
  try {
    protocols::parse_protocol({text, file}, [&](const std::string& name) {
      return name == "sheet.ply" ? surface
                                 : testing::contents(testing::source("tests/data/" + name));
    });
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}
core::TriangleSurface flat_grid(int cells) {
  std::vector<Eigen::RowVector3d> points;
  std::vector<Eigen::RowVector3i> triangles;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      points.emplace_back(-0.1 + 0.2 * i / cells, -0.1 + 0.2 * j / cells, 0.0);
      if (i < cells && j < cells) {
        const int at = i * (cells + 1) + j;
        triangles.emplace_back(at, at + cells + 1, at + cells + 2);
        triangles.emplace_back(at, at + cells + 2, at + 1);
      }
    }
  }
  return testing::surface_of(points, triangles);
}
core::TriangleSurface with_triangle(core::TriangleSurface surface, const Eigen::RowVector3i& more) {
  surface.triangles.conservativeResize(surface.triangles.rows() + 1, 3);
  surface.triangles.bottomRows(1) = more;
  return surface;
}
}  // namespace

TEST_CASE("a surface that is no middle of a sheet is refused with what and where",
          "[protocols][surface][sheet]") {
  struct Case {
    core::TriangleSurface surface;
    const char* keys;
    const char* refusal;
  };
  const core::TriangleSurface flat = flat_grid(2);
  core::TriangleSurface large = flat;
  large.points_m *= 100.0;
  core::TriangleSurface turned = flat;
  turned.triangles.row(0).reverseInPlace();
  const core::TriangleSurface folded = testing::surface_of(
      {{-0.1, -0.1, 0.0}, {0.1, -0.1, 0.0}, {-0.1, 0.1, 0.0}, {-0.1, 0.1, 0.001}},
      {{0, 1, 2}, {1, 0, 3}});
  core::TriangleSurface apart = testing::joined_surfaces(flat, flat);
  apart.points_m.bottomRows(flat.points_m.rows()).array() += 0.05;
  const std::vector<Case> cases{
      {flat, "thickness_m: 0.0005", "accepted"},
      {flat, "thickness_m: 0.2", "thickness_m"},
      {flat, "thickness_m: 0.0005, repair: {}", "makes closed surfaces of solids"},
      {flat, "thickness_m: 0.02", "less than 20 times its thickness_m"},
      {flat_grid(56), "thickness_m: 0.0005", "6272 triangles (with thickness_m at most 6000)"},
      {large, "thickness_m: 0.0005", "is metres_per_unit right?"},
      {turned, "thickness_m: 0.0005", "face opposite ways along the edge"},
      {with_triangle(flat, {4, 0, 2}), "thickness_m: 0.0005", "3 triangles meet (two may)"},
      {apart, "thickness_m: 0.0005", "it is in several pieces"},
      {folded, "thickness_m: 0.0005", "the sheet is folded back on itself"}};
  for (const Case& one : cases) {
    CAPTURE(one.refusal);
    CHECK_THAT(refusal_of_sheet(one.keys, protocols::ply_text(one.surface)), Contains(one.refusal));
  }
}

TEST_CASE("a sheet whose faces run through themselves, or with settings of tetrahedra, is refused",
          "[protocols][surface][sheet]") {
  // a strip that winds back above itself at less than its thickness
  std::vector<Eigen::RowVector3d> points;
  std::vector<Eigen::RowVector3i> triangles;
  constexpr int steps = 24;
  for (int i = 0; i <= steps; ++i) {
    const double turn = 2.0 * M_PI * 1.1 * i / steps;
    const double radius_m = 0.1 + 0.001 * i / steps;
    for (const double y : {-0.1, 0.1}) {
      points.emplace_back(radius_m * std::cos(turn), y, radius_m * std::sin(turn));
    }
    if (i < steps) {
      triangles.emplace_back(2 * i, 2 * i + 1, 2 * i + 3);
      triangles.emplace_back(2 * i, 2 * i + 3, 2 * i + 2);
    }
  }
  const std::string wound = protocols::ply_text(testing::surface_of(points, triangles));
  CHECK_THAT(refusal_of_sheet("thickness_m: 0.003", wound),
             Contains("the faces of the sheet, half of thickness_m beside the surface") &&
                 Contains("runs through itself"));
  const std::string file = testing::source("tests/data/every_key.yaml");
  const std::string text =
      testing::replaced(testing::contents(file), "{shell_width_m: 0.1}", "{order: 2}");
  CHECK_THROWS_WITH(
      protocols::parse_protocol({text, file},
                                [](const std::string& name) {
                                  return testing::contents(testing::source("tests/data/" + name));
                                }),
      Contains("is of tetrahedra, and the surface has a thickness_m"));
}
