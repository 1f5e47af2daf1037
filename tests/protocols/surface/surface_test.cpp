// Bodies from surfaces: what is refused and what becomes of the rest.
#include <Eigen/Geometry>
#include <cmath>

#include "core/error.hpp"
#include "core/model/body_modes.hpp"
#include "core/model/shape/shape.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "protocols/surface/check_surface.hpp"
#include "protocols/surface/surface_file.hpp"
#include "protocols/yaml/text_file.hpp"
#include "support/catch.hpp"
#include "support/surfaces.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using protocols::check_surface;

namespace {
const Eigen::Vector3d plate_size_m{0.3, 0.2, 0.02};

core::TriangleSurface without_last_triangle(core::TriangleSurface surface) {
  surface.triangles.conservativeResize(surface.triangles.rows() - 1, 3);
  return surface;
}
core::TriangleSurface joined(const core::TriangleSurface& a, const core::TriangleSurface& b) {
  core::TriangleSurface both;
  both.points_m.resize(a.points_m.rows() + b.points_m.rows(), 3);
  both.points_m << a.points_m, b.points_m;
  both.triangles.resize(a.triangles.rows() + b.triangles.rows(), 3);
  both.triangles << a.triangles, b.triangles.array() + static_cast<int>(a.points_m.rows());
  return both;
}
core::TriangleSurface shifted(core::TriangleSurface surface, const Eigen::RowVector3d& by_m) {
  surface.points_m.rowwise() += by_m;
  return surface;
}
core::TriangleSurface read(const std::string& file, double metres_per_unit) {
  return protocols::read_surface(protocols::surface_source(file, protocols::contents_of(file)),
                                 metres_per_unit);
}
// As OFF and PLY have them.
void write_points_and_faces(std::ostream& text, const core::TriangleSurface& surface) {
  for (const auto& p : surface.points_m.rowwise()) {
    text << p << '\n';
  }
  for (const auto& t : surface.triangles.rowwise()) {
    text << "3 " << t << '\n';
  }
}
std::string as_off(const core::TriangleSurface& surface) {
  std::ostringstream text;
  text << "OFF\n" << surface.points_m.rows() << ' ' << surface.triangles.rows() << " 0\n";
  text.precision(17);
  write_points_and_faces(text, surface);
  return text.str();
}
std::string as_obj(const core::TriangleSurface& surface) {
  std::ostringstream text;
  for (const auto& p : surface.points_m.rowwise()) {
    text << "v " << p << '\n';
  }
  for (const auto& t : surface.triangles.rowwise()) {
    text << "f " << t.array() + 1 << '\n';
  }
  return text.str();
}
std::string as_ply(const core::TriangleSurface& surface) {
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nelement vertex " << surface.points_m.rows()
       << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
       << surface.triangles.rows() << "\nproperty list uchar int vertex_indices\nend_header\n";
  write_points_and_faces(text, surface);
  return text.str();
}
std::string as_ascii_stl(const core::TriangleSurface& surface) {
  std::ostringstream text;
  text << "solid body\n";
  for (const auto& t : surface.triangles.rowwise()) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const int corner : t) {
      text << "vertex " << surface.points_m.row(corner) << '\n';
    }
    text << "endloop\nendfacet\n";
  }
  text << "endsolid body\n";
  return text.str();
}
std::string as_binary_stl(const core::TriangleSurface& surface) {
  std::string bytes(80, ' ');
  const auto append = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  append(static_cast<std::uint32_t>(surface.triangles.rows()));
  for (const auto& t : surface.triangles.rowwise()) {
    for (int i = 0; i < 3; ++i) {
      append(0.0F);
    }
    for (const int corner : t) {
      for (const double x : surface.points_m.row(corner)) {
        append(static_cast<float>(x));
      }
    }
    append(std::uint16_t{0});
  }
  return bytes;
}
}  // namespace

TEST_CASE("a surface is read alike from every kind of file", "[core][surface]") {
  struct Kind {
    const char* name;
    std::string (*text)(const core::TriangleSurface&);
  };
  const auto kind = GENERATE(values<Kind>({{"body.off", as_off},
                                           {"body.obj", as_obj},
                                           {"body.ply", as_ply},
                                           {"body.stl", as_ascii_stl},
                                           {"binary.stl", as_binary_stl}}));
  INFO(kind.name);
  const core::TriangleSurface in_mm = testing::box_surface({300.0, 200.0, 20.0}, 2);
  const testing::TempDirectory directory;
  testing::write(directory / kind.name, kind.text(in_mm));
  const core::TriangleSurface surface = read(directory / kind.name, 0.001);
  check_surface(surface);
  CHECK(surface.points_m.rows() == in_mm.points_m.rows());
  CHECK(surface.triangles.rows() == in_mm.triangles.rows());
  CHECK(core::volume_m3(surface) == Approx(0.3 * 0.2 * 0.02));
}

TEST_CASE("files that are no surface are refused with their name", "[core][surface]") {
  const testing::TempDirectory directory;
  CHECK_THROWS_WITH(read(directory / "none.stl", 1.0), Contains("no such file"));
  CHECK_THROWS_WITH(read(directory.path(), 1.0), Contains("cannot be read"));
  testing::write(directory / "words.stl", "this is not a surface");
  testing::write(directory / "cut.off", "OFF\n8 12 0\n0 0 0\n1 0");
  testing::write(directory / "body.step", as_off(testing::box_surface(plate_size_m)));
  for (const char* name : {"words.stl", "cut.off", "body.step"}) {
    CHECK_THROWS_WITH(read(directory / name, 1.0), Contains(name) && Contains("is not a surface"));
  }
}

TEST_CASE("a surface that encloses no body is refused with what and where", "[core][surface]") {
  const core::TriangleSurface box = testing::box_surface(plate_size_m);
  REQUIRE_NOTHROW(check_surface(box));
  CHECK_THROWS_WITH(check_surface(without_last_triangle(box)),
                    Contains("hole") && Contains("edge"));

  core::TriangleSurface twisted = box;
  twisted.triangles.row(0).reverseInPlace();
  CHECK_THROWS_WITH(check_surface(twisted), Contains("opposite ways"));

  core::TriangleSurface inside_out = box;
  inside_out.triangles.col(1).swap(inside_out.triangles.col(2));
  CHECK_THROWS_WITH(check_surface(inside_out), Contains("inward"));

  CHECK_THROWS_WITH(check_surface(joined(box, shifted(box, {1.0, 0.0, 0.0}))),
                    Contains("several pieces"));
  CHECK_THROWS_WITH(check_surface(testing::box_surface({600.0, 600.0, 50.0})),
                    Contains("600") && Contains("metres_per_unit"));

  core::TriangleSurface flat = box;
  flat.points_m.col(2).setZero();
  CHECK_THROWS_AS(check_surface(flat), core::InvalidInput);

  core::TriangleSurface undefined = box;
  undefined.points_m(0, 0) = std::nan("");
  CHECK_THROWS_WITH(check_surface(undefined), Contains("finite"));

  // one corner pulled through the opposite face
  core::TriangleSurface pierced = testing::box_surface(plate_size_m, 2);
  Eigen::Index middle{};
  (pierced.points_m.rowwise() - Eigen::RowVector3d{0.0, 0.0, 0.0})
      .rowwise()
      .norm()
      .minCoeff(&middle);
  pierced.points_m(middle, 2) = -0.05;
  CHECK_THROWS_WITH(check_surface(pierced), Contains("through itself"));
}

TEST_CASE("three triangles on one edge are refused", "[core][surface]") {
  core::TriangleSurface fin = testing::box_surface(plate_size_m);
  fin.points_m.conservativeResize(9, 3);
  fin.points_m.row(8) << 0.0, 0.0, 0.1;
  fin.triangles.conservativeResize(13, 3);
  fin.triangles.row(12) << fin.triangles(0, 0), fin.triangles(0, 1), 8;
  CHECK_THROWS_WITH(check_surface(fin), Contains("meet"));
}

TEST_CASE("a box from a file has the modes of the box", "[core][surface][model]") {
  core::BodySpec body{{core::Box{plate_size_m}, {}, {}}, 0.3, 3.0};
  body.mesh.order = 2;
  body.mesh.size.max_tet_volume_m3 = 2e-6;
  core::Fixation left;
  left.shape = core::RegionShape::side;
  left.side = core::Side::left;
  body.fixations = {left};
  const auto of_box = core::solve_body(body).modes;
  body.shape = core::Solid{testing::box_surface(plate_size_m)};
  const auto of_file = core::solve_body(body).modes;
  REQUIRE(of_box.kappa_rad_per_m.size() > 2);
  REQUIRE(of_file.kappa_rad_per_m.size() == of_box.kappa_rad_per_m.size());
  CHECK((of_file.kappa_rad_per_m / of_box.kappa_rad_per_m - 1.0).abs().maxCoeff() < 0.01);
}

TEST_CASE("a finger coming down meets a body at its top", "[core][surface]") {
  const core::TopHeight ball{core::Solid{testing::sphere_surface(0.1, 60)}};
  CHECK(*ball.at_m({0.0, 0.0}) == Approx(0.1));
  CHECK(*ball.at_m({0.06, 0.0}) == Approx(0.08).epsilon(0.01));
  CHECK_FALSE(ball.at_m({0.099, 0.099}));
  CHECK(*core::TopHeight{core::Solid{testing::notched_block()}}.at_m({0.05, 0.05}) ==
        Approx(-0.05));
}

TEST_CASE("a face that no triangles can fill is refused, whatever its corners are",
          "[protocols][surface]") {
  const auto* corners = GENERATE(
      // a face that crosses itself, one without area, one beyond all sizes, one corner twice
      "5 1 0\n-20 -10 0\n-20 0 -10\n-20 -20 -10\n0 0 0\n10 -10 -10\n5 0 1 2 3 4\n",
      "8 1 0\n-21.02577 2.5e-301 0\n-26.38852 7.1e-302 0\n26.204615 7.5e-301 0\n-20.5744 7.3e-301 "
      "0\n-14.5726 9e-16 0\n-0.96541 5.2e-16 0\n-19.42 0 0\n-25.37 7.9e-16 0\n8 0 1 2 3 4 5 6 7\n",
      "4 1 0\n0 0 0\n1e308 0 0\n1e308 1e308 0\n0 1e308 0\n4 0 1 2 3\n",
      "4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 0 0\n4 0 1 2 3\n");
  CHECK_THROWS_AS(protocols::read_surface(
                      protocols::surface_source("face.off", std::string{"OFF\n"} + corners), 1.0),
                  core::InvalidInput);
}

TEST_CASE("a concave face is cut inside itself", "[protocols][surface]") {
  // a U, its ends of ten corners each fanned from any one of them would cover the gap
  const std::vector<Eigen::RowVector2d> outline{{0, 0}, {3, 0}, {3, 3}, {2, 3},
                                                {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  std::ostringstream off;
  off << "OFF\n16 10 0\n";
  for (const int z : {0, 1}) {
    for (const auto& p : outline) {
      off << p.x() << ' ' << p.y() << ' ' << z << '\n';
    }
  }
  off << "8 7 6 5 4 3 2 1 0\n8 8 9 10 11 12 13 14 15\n";
  for (int i = 0; i < 8; ++i) {
    const int next = (i + 1) % 8;
    off << "4 " << i << ' ' << next << ' ' << 8 + next << ' ' << 8 + i << '\n';
  }
  const core::TriangleSurface surface =
      protocols::read_surface(protocols::surface_source("u.off", off.str()), 0.1);
  CHECK_NOTHROW(check_surface(surface));
  CHECK(core::volume_m3(surface) == Approx(7.0 * 1e-3));
  double area_m2 = 0.0;
  for (const auto& t : surface.triangles.rowwise()) {
    const Eigen::Vector3d a = surface.points_m.row(t[0]);
    const Eigen::Vector3d b = surface.points_m.row(t[1]);
    const Eigen::Vector3d c = surface.points_m.row(t[2]);
    area_m2 += 0.5 * (b - a).cross(c - a).norm();
  }
  CHECK(area_m2 == Approx((2 * 7 + 16) * 1e-2));  // two ends and the walls round
}

TEST_CASE("a surface folded onto itself is refused though no edge passes through a face",
          "[protocols][surface]") {
  core::TriangleSurface box = testing::box_surface(plate_size_m, 2);
  // a corner of the top pushed along the top onto its neighbour's far side
  for (auto point : box.points_m.rowwise()) {
    if (point.norm() < 1e-12) {
      point.x() += 0.2;
    }
  }
  CHECK_THROWS_WITH(check_surface(box), Contains("through itself"));
}

TEST_CASE("a triangle whose corner lies on its opposite side is refused with what and where",
          "[protocols][surface]") {
  // a cube of 0.1 m, one edge of it cut on one side only
  const std::string text =
      "OFF\n9 14 0\n0 0 0\n0.1 0 0\n0.1 0.1 0\n0 0.1 0\n0 0 0.1\n0.1 0 0.1\n0.1 0.1 0.1\n"
      "0 0.1 0.1\n0.03 1e-9 0\n"
      "3 0 2 8\n3 8 2 1\n3 0 8 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 2 3 7\n"
      "3 2 7 6\n3 1 2 6\n3 1 6 5\n3 0 4 7\n3 0 7 3\n";
  CHECK_THROWS_WITH(protocols::check_surface(
                        protocols::read_surface(protocols::surface_source("cap.off", text), 1.0)),
                    Contains("is flat: a corner lies on the opposite side"));
}

TEST_CASE(
    "files that lie about themselves are refused, and take neither the program nor its memory",
    "[protocols][surface]") {
  const auto [name, text] = GENERATE(table<std::string, std::string>({
      {"no_triangle.stl", std::string(80, ' ') + std::string(4, '\0')},
      {"property_first.ply",
       "ply\nformat ascii 1.0\nproperty float x\nelement vertex 3\nend_header\n0 0 0\n"},
      {"long_list.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
       "property float z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n"
       "0 0 0\n1 0 0\n0 1 0\n4294967295 0 1 2\n"},
      {"many_points.off", "OFF\n4294967295 4294967295 0\n0 0 0\n"},
      {"many_triangles.stl", std::string(80, ' ') + std::string(4, '\xff') + "x"},
  }));
  CAPTURE(name);
  CHECK_THROWS_AS(protocols::read_surface(protocols::surface_source(name, text), 1.0),
                  core::InvalidInput);
}

TEST_CASE("a surface is turned about its vector, then moved; beside it is its nearest place",
          "[protocols][surface]") {
  const std::string file = testing::source("tests/data/every_key.yaml");
  const std::string text = testing::contents(file);
  const auto solid = [&](const std::string& pose) {
    return protocols::parse_protocol(
               testing::replaced(text, "offset_m: [0, 0, 0], rotation_rad: [0, 0, 0]", pose), file)
        .plates.at("tetrahedron")
        ->shape;
  };
  const core::Bounds usual = core::bounds(solid("offset_m: [0, 0, 0]"));
  // half a turn about the upright, so that the height under the tapping point stays
  const core::Bounds turned =
      core::bounds(solid("offset_m: [0, 0, 0.0005], rotation_rad: [0, 0, 3.141592653589793]"));
  CHECK(turned.high_m.isApprox(
      core::Vec3{-usual.low_m.x(), -usual.low_m.y(), usual.high_m.z() + 0.0005}, 1e-9));
  CHECK(turned.low_m.isApprox(
      core::Vec3{-usual.high_m.x(), -usual.high_m.y(), usual.low_m.z() + 0.0005}, 1e-9));
  const core::TopHeight top{solid("offset_m: [0, 0, 0]")};
  const Eigen::Vector2d beside{usual.high_m.x() + 1.0, 0.0};
  REQUIRE_FALSE(top.at_m(beside));
  CHECK_THAT(top.describe_touchable(beside), Contains("nearest place is ("));
}
