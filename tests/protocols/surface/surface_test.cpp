// Bodies from surfaces: what is refused and what becomes of the rest.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "core/error.hpp"
#include "core/model/body_modes.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
#include "core/model/shape/shape.hpp"
#include "core/random/rng.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "protocols/surface/check_surface.hpp"
#include "protocols/surface/join_points.hpp"
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
core::TriangleSurface shifted(core::TriangleSurface surface, const Eigen::RowVector3d& by_m) {
  surface.points_m.rowwise() += by_m;
  return surface;
}
core::TriangleSurface read(const std::string& file, double metres_per_unit) {
  return protocols::read_surface(protocols::surface_source(file, protocols::contents_of(file)),
                                 metres_per_unit)
      .surface;
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

namespace {
core::TriangleSurface read_text(const std::string& name, const std::string& text,
                                double metres_per_unit = 1.0) {
  return protocols::read_surface(protocols::surface_source(name, text), metres_per_unit).surface;
}
std::string replaced_all(const std::string& text, const std::string& from, const std::string& to) {
  std::string result;
  std::size_t at = 0;
  for (auto found = text.find(from); found != std::string::npos; found = text.find(from, at)) {
    result += text.substr(at, found - at) + to;
    at = found + from.size();
  }
  return result + text.substr(at);
}
bool are_equal(const core::TriangleSurface& a, const core::TriangleSurface& b) {
  return a.points_m == b.points_m && a.triangles == b.triangles;
}
// A cube of 100 units, by its corners' numbers from 0.
const std::vector<std::array<int, 4>> cube_sides{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                 {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
std::string cube_points(const std::string& start, const std::string& between,
                        const std::string& end) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    text += start;
    for (const int bit : {1, 2, 4}) {
      text += between + ((i & bit) != 0 ? "100" : "0");
    }
    text += end;
  }
  return text;
}
std::string cube_obj(const std::string& between, const std::string& point_end) {
  std::string text = cube_points("v", between, point_end + "\n");
  for (const auto& side : cube_sides) {
    text += "f";
    for (const int corner : side) {
      text += between + std::to_string(corner + 1);
    }
    text += "\n";
  }
  return text;
}
std::string cube_stl() {
  return as_ascii_stl(read_text("cube.obj", cube_obj(" ", "")));
}
}  // namespace

TEST_CASE("an OBJ may have tabs, continued lines, lines, colours, weights and places from the end",
          "[protocols][surface]") {
  const core::TriangleSurface cube = read_text("cube.obj", cube_obj(" ", ""));
  check_surface(read_text("cube.obj", cube_obj(" ", ""), 0.001));
  CHECK(core::volume_m3(cube) == Approx(1e6));
  CHECK(are_equal(read_text("tabs.obj", cube_obj("\t", "")), cube));
  CHECK(are_equal(read_text("continued.obj", cube_obj(" \\\n ", "")), cube));
  CHECK(are_equal(read_text("returns.obj", replaced_all(cube_obj(" ", ""), "\n", "\r\n")), cube));
  CHECK(are_equal(read_text("lines.obj", cube_obj(" ", "") + "l 1 2\nl 3 4 5\n"), cube));
  CHECK(are_equal(read_text("colours.obj", cube_obj(" ", " 0.5 0.5 1")), cube));
  CHECK(are_equal(read_text("marked.obj", "\xEF\xBB\xBF" + cube_obj(" ", "")), cube));
  CHECK(are_equal(read_text("comment.obj", "# a cube\n" + cube_obj(" ", " # corner")), cube));
  // homogeneous coordinates
  CHECK(are_equal(read_text("weights.obj", cube_obj(" ", " 2"), 2.0), cube));
  CHECK(are_equal(
      read_text("back.obj", testing::replaced(cube_obj(" ", ""), "f 1 3 4 2", "f -8 -6 -5 -7")),
      cube));
}

TEST_CASE("an OBJ that is none is refused with its line and what is there",
          "[protocols][surface]") {
  const auto refused = [](const std::string& text, const std::string& message) {
    CHECK_THROWS_WITH(read_text("body.obj", text), Contains(message));
  };
  refused("v 0 0 0\nv 1 0 0\nl 1 2\n", "holds 2 points (v), 1 lines (l) and no face (f)");
  refused("v 0 0\n", "body.obj:1: a point (v) of 2 numbers");
  refused("v 0 0 0\nv 1,5 0 0\n", "body.obj:2: '1,5' has a decimal comma");
  refused(std::string{"\xFF\xFEv\0 \0", 6},
          "its text is UTF-16. Convert it: iconv -f UTF-16 -t UTF-8 ");
  refused("v 0 0 0 0\n", "weight 0");
  refused("v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 \\\n 4\n",
          "body.obj:5: a face (f) with the corner '4' (3 points so far)");
  refused("v 0 0 nan\n", "'nan' is not a finite number");
}

TEST_CASE("an ASCII STL may be in capitals and begin with a byte order mark",
          "[protocols][surface]") {
  const core::TriangleSurface cube = read_text("cube.obj", cube_obj(" ", ""));
  std::string capitals = cube_stl();
  std::ranges::transform(capitals, capitals.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  CHECK(are_equal(read_text("small.stl", cube_stl()), cube));
  CHECK(are_equal(read_text("capitals.stl", capitals), cube));
  CHECK(are_equal(read_text("marked.stl", "\xEF\xBB\xBF" + cube_stl()), cube));
  // many a binary file begins with the word
  std::string binary = as_binary_stl(cube);
  binary.replace(0, 6, "solid ");
  CHECK(are_equal(read_text("binary.stl", binary), cube));
}

TEST_CASE("an STL that is none is refused with what was found", "[protocols][surface]") {
  CHECK_THROWS_WITH(
      read_text("comma.stl", replaced_all(cube_stl(), "100", "100,000")),
      Contains("comma.stl:") && Contains("'100,000' has a decimal comma") && Contains("100.000"));
  CHECK_THROWS_WITH(read_text("cut.stl", cube_stl().substr(0, cube_stl().find("endloop"))),
                    Contains("ends inside a facet"));
  CHECK_THROWS_WITH(read_text("empty.stl", "solid nothing\nendsolid nothing\n"),
                    Contains("without a facet"));
  const std::string binary = as_binary_stl(read_text("cube.obj", cube_obj(" ", "")));
  CHECK_THROWS_WITH(read_text("cut.stl", binary.substr(0, binary.size() - 60)),
                    Contains("12 triangles by its header, and with bytes for 10"));
  for (const char* name : {"solid ", "cut at"}) {
    std::string few = binary;
    few.replace(0, 6, name);
    few[80] = 10;
    CHECK_THROWS_WITH(read_text("few.stl", few),
                      Contains("10 triangles by its header, and with bytes for 12"));
  }
}

TEST_CASE("a PLY or OFF with more than its header counts is refused, blanks and comments not",
          "[protocols][surface]") {
  const core::TriangleSurface cube = read_text("cube.obj", cube_obj(" ", ""));
  for (const auto& [name, text] :
       {std::pair{"cube.ply", as_ply(cube)}, {"cube.off", as_off(cube)}}) {
    CAPTURE(name);
    CHECK(are_equal(read_text(name, text + " \n\n"), cube));
    const std::string few = name == std::string_view{"cube.off"}
                                ? testing::replaced(text, "8 12", "8 11")
                                : testing::replaced(text, "face 12", "face 11");
    CHECK_THROWS_WITH(read_text(name, few), Contains("left after all that its header counts (8 "
                                                     "points, 11 faces)"));
  }
  CHECK(are_equal(read_text("cube.off", as_off(cube) + "# written by hand\n"), cube));
}

namespace {
template <class Number>
void append_number(std::string& bytes, double value, bool is_big_endian) {
  const auto number = static_cast<Number>(value);
  std::string own(reinterpret_cast<const char*>(&number), sizeof number);
  if (is_big_endian) {
    std::ranges::reverse(own);
  }
  bytes += own;
}
struct PlyType {
  const char* name;
  void (*append)(std::string& bytes, double value, bool is_big_endian);
};
const std::vector<PlyType> coordinate_types{
    {"char", append_number<std::int8_t>},   {"uint8", append_number<std::uint8_t>},
    {"short", append_number<std::int16_t>}, {"int32", append_number<std::int32_t>},
    {"float", append_number<float>},        {"float64", append_number<double>}};
const std::vector<PlyType> index_types{
    {"char", append_number<std::int8_t>},     {"uchar", append_number<std::uint8_t>},
    {"short", append_number<std::int16_t>},   {"ushort", append_number<std::uint16_t>},
    {"uint16", append_number<std::uint16_t>}, {"int", append_number<std::int32_t>},
    {"uint", append_number<std::uint32_t>}};
std::string ply_header(const std::string& format, const std::string& coordinate,
                       const std::string& faces) {
  std::string text = "ply\nformat " + format + " 1.0\ncomment a cube\nelement vertex 8\n";
  for (const char* const axis : {"x", "y", "z"}) {
    text += "property " + coordinate + " " + axis + "\n";
  }
  return text + faces + "end_header\n";
}
}  // namespace

TEST_CASE("a PLY is read whatever the types of its coordinates and indices are",
          "[protocols][surface]") {
  const core::TriangleSurface cube = read_text("cube.obj", cube_obj(" ", ""));
  for (const bool is_big_endian : {false, true}) {
    const std::string format = is_big_endian ? "binary_big_endian" : "binary_little_endian";
    for (const PlyType& coordinate : coordinate_types) {
      for (const PlyType& index : index_types) {
        INFO(format << " " << coordinate.name << " " << index.name);
        std::string bytes =
            ply_header(format, coordinate.name,
                       std::string{"element face 6\nproperty uchar flags\nproperty list uchar "} +
                           index.name + " vertex_indices\n");
        for (int i = 0; i < 8; ++i) {
          for (const int bit : {1, 2, 4}) {
            coordinate.append(bytes, (i & bit) != 0 ? 100.0 : 0.0, is_big_endian);
          }
        }
        for (const auto& side : cube_sides) {
          bytes += "\x01\x04";
          for (const int corner : side) {
            index.append(bytes, corner, is_big_endian);
          }
        }
        CHECK(are_equal(read_text("cube.ply", bytes), cube));
      }
    }
  }
}

TEST_CASE("a PLY of triangle strips is read, each triangle facing as the strip does",
          "[protocols][surface]") {
  // round the four walls, then the two ends
  const std::string text =
      ply_header("ascii", "float", "element tristrips 1\nproperty list int int vertex_indices\n") +
      cube_points("", " ", "\n") + "20 0 4 1 5 3 7 2 6 0 4 -1 0 1 2 3 -1 4 6 5 7\n";
  const core::TriangleSurface strips = read_text("strips.ply", text, 0.001);
  CHECK(strips.triangles.rows() == 12);
  CHECK(std::abs(core::volume_m3(strips)) == Approx(1e-3));
}

TEST_CASE("a PLY that is none is refused with what was found", "[protocols][surface]") {
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
  const auto refused = [](const std::string& text, const std::string& message) {
    CHECK_THROWS_WITH(read_text("body.ply", text), Contains(message));
  };
  refused("solid", "a PLY begins with a line 'ply'");
  refused("ply\nformat ascii 1.0\nelement vertex 8\n", "does not end (end_header)");
  refused(ply_header("text", "float", faces), "its format is 'text'");
  refused(ply_header("ascii", "real", faces), "body.ply:5: the type 'real'");
  refused(ply_header("ascii", "float", faces) + "0 0 0 1", "ends in vertex 1 of 8");
  refused(ply_header("ascii", "float", faces) + cube_points("", " ", "\n") + "3 0 1 8\n",
          "face 0 has the corner 8 (numbered from 0, of 8 points)");
  refused(ply_header("ascii", "float", "") + cube_points("", " ", "\n"),
          "holds 8 points and no face");
}

TEST_CASE("another format is refused with the program that converts it and its unit of length",
          "[protocols][surface]") {
  for (const char* const name : {"body.3mf", "body.gltf", "body.GLB"}) {
    CHECK_THROWS_WITH(read_text(name, "x"),
                      Contains(std::string{"assimp export "} + name + " body.ply"));
  }
  CHECK_THROWS_WITH(read_text("body.step", "x"), Contains("gmsh body.step -2 -o body.stl") &&
                                                     Contains("metres_per_unit is then 0.001"));
  CHECK_THROWS_WITH(read_text("body.3mf", "x"), Contains("metres_per_unit is then what the file's "
                                                         "<model unit=…> says"));
  CHECK_THROWS_WITH(read_text("body.dae", "x"), Contains("metres_per_unit is then 1 (and y is up"));
  CHECK_THROWS_WITH(read_text("body.doc", "x"), Contains(".stl, .ply, .off, .obj"));
}

TEST_CASE("equal surfaces are equal bodies, to the last digit", "[protocols][surface][model]") {
  const core::TriangleSurface in_mm = testing::box_surface({301.7, 202.3, 20.1}, 2);
  core::TriangleSurface in_m = in_mm;
  for (double& x : in_m.points_m.reshaped()) {
    x = std::round(x * 100.0) / 1e5;
  }
  core::TriangleSurface shuffled = in_mm;
  shuffled.triangles = in_mm.triangles.colwise().reverse().eval();
  for (auto triangle : shuffled.triangles.rowwise()) {
    triangle = Eigen::RowVector3i{triangle[1], triangle[2], triangle[0]};
  }
  const auto modes = [](const std::string& name, const std::string& text, double metres_per_unit) {
    core::BodySpec body{{core::Solid{read_text(name, text, metres_per_unit)}, {}, {}}, 0.3, 3.0};
    body.mesh.size.max_tet_volume_m3 = 1e-5;
    core::Fixation left;
    left.shape = core::RegionShape::side;
    left.side = core::Side::left;
    body.fixations = {left};
    return core::solve_body(body).modes.kappa_rad_per_m.eval();
  };
  const Eigen::ArrayXd ascii = modes("body.stl", as_ascii_stl(in_mm), 0.001);
  REQUIRE(ascii.size() > 2);
  const auto same = [&](const Eigen::ArrayXd& other) {
    return other.size() == ascii.size() && (other == ascii).all();
  };
  CHECK(same(modes("metres.stl", as_ascii_stl(in_m), 1.0)));
  CHECK(same(modes("binary.stl", as_binary_stl(in_mm), 0.001)));
  CHECK(same(modes("binary_metres.stl", as_binary_stl(in_m), 1.0)));
  CHECK(same(modes("body.obj", as_obj(in_mm), 0.001)));
  CHECK(same(modes("metres.ply", as_ply(in_m), 1.0)));
  CHECK(same(modes("shuffled.stl", as_ascii_stl(shuffled), 0.001)));
}

namespace {
// Each triangle with corners of its own, off by up to `noise_m` along each axis.
core::TriangleSurface with_noise(const core::TriangleSurface& surface, double noise_m) {
  core::Rng rng{7};
  core::TriangleSurface apart;
  apart.points_m.resize(surface.triangles.size(), 3);
  apart.triangles.resize(surface.triangles.rows(), 3);
  for (Eigen::Index i = 0; i < surface.triangles.size(); ++i) {
    apart.points_m.row(i) = surface.points_m.row(surface.triangles(i / 3, i % 3));
    for (double& x : apart.points_m.row(i)) {
      x += noise_m * (2.0 * rng.uniform() - 1.0);
    }
    apart.triangles(i / 3, i % 3) = static_cast<int>(i);
  }
  return apart;
}
// The same in a file that has its points and triangles from last to first, each triangle turned.
core::TriangleSurface from_last_to_first(const core::TriangleSurface& surface) {
  const int last = static_cast<int>(surface.points_m.rows()) - 1;
  core::TriangleSurface reversed = surface;
  reversed.points_m = surface.points_m.colwise().reverse().eval();
  reversed.triangles = (last - surface.triangles.array()).matrix().colwise().reverse().eval();
  for (auto triangle : reversed.triangles.rowwise()) {
    triangle = Eigen::RowVector3i{triangle[1], triangle[2], triangle[0]};
  }
  return reversed;
}
core::TriangleSurface reread(const core::TriangleSurface& surface) {
  return read_text("body.off", as_off(surface));
}
protocols::SurfaceNoise noise_in(const core::TriangleSurface& surface) {
  return protocols::read_surface(protocols::surface_source("body.off", as_off(surface)), 1.0).noise;
}
}  // namespace

TEST_CASE("corners that differ by a writing program's noise are one, and that is told",
          "[protocols][surface]") {
  const std::vector<core::TriangleSurface> bodies{
      testing::sphere_surface(0.1, 12), testing::box_surface(plate_size_m, 3),
      testing::notched_block(),
      shifted(testing::box_surface({0.01, 0.02, 0.03}), {0.3, -0.2, 0.1})};
  const double share = GENERATE(1e-12, 1e-9, 1e-8, 1e-7, 2.5e-7);
  for (const core::TriangleSurface& body : bodies) {
    const double noise_m = share * core::bounds(body).size_m().norm();
    CAPTURE(body.points_m.rows(), share);
    const core::TriangleSurface noisy = with_noise(body, noise_m);
    const core::TriangleSurface read = reread(noisy);
    CHECK_NOTHROW(check_surface(read));
    CHECK(read.points_m.rows() == body.points_m.rows());
    CHECK(read.triangles.rows() == body.triangles.rows());
    CHECK(core::volume_m3(read) == Approx(core::volume_m3(body)).epsilon(1e-5));
    CHECK(are_equal(reread(from_last_to_first(noisy)), read));
    const protocols::SurfaceNoise noise = noise_in(noisy);
    CHECK(noise.points == body.triangles.size() - body.points_m.rows());
    CHECK(noise.without_area == 0);
    CHECK(noise.farthest <= 2.0 * std::sqrt(3.0) * share * 1.001);
    CHECK(noise.farthest > share);
    CHECK_THAT(noise.describe(), Contains(std::to_string(noise.points) +
                                          " of its points differ from others by noise"));
    CHECK(noise_in(body).describe().empty());
  }
}

TEST_CASE("corners further apart than noise stay apart, and so does a chain of noise",
          "[protocols][surface]") {
  const core::TriangleSurface box = testing::box_surface(plate_size_m, 2);
  CHECK_THROWS_WITH(check_surface(reread(with_noise(box, 1e-5 * plate_size_m.norm()))),
                    Contains("open"));
  // along a metre: a pair closer than noise, and ten points each closer than that to the next
  std::vector<core::Vec3> points{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.9e-6}, {0.0, 0.5, 0.0}};
  for (int i = 0; i < 10; ++i) {
    points.emplace_back(0.5 + 0.9e-6 * i, 0.0, 0.0);
  }
  points.emplace_back(1.0, 0.0, 0.0);
  std::vector<std::size_t> expected(points.size());
  std::iota(expected.begin(), expected.end(), std::size_t{0});
  expected[1] = 0;
  CHECK(protocols::without_noise(points) == expected);
}

TEST_CASE("a triangle with two corners in one point is left out, and that is told",
          "[protocols][surface]") {
  const core::TriangleSurface box = testing::box_surface(plate_size_m, 2);
  core::TriangleSurface more = box;
  more.points_m.conservativeResize(box.points_m.rows() + 2, 3);
  more.points_m.bottomRows(2) << box.points_m.row(0),
      box.points_m.row(0) + Eigen::RowVector3d::Constant(1e-9);
  more.triangles.conservativeResize(box.triangles.rows() + 2, 3);
  const int added = static_cast<int>(box.points_m.rows());
  more.triangles.bottomRows(2) << 0, added, 3, 5, 0, added + 1;
  CHECK(are_equal(reread(more), reread(box)));
  CHECK(noise_in(more).points == 1);
  CHECK(noise_in(more).without_area == 2);
  CHECK_THAT(noise_in(more).describe(), Contains("2 of its triangles have two corners in one"));
  core::TriangleSurface nothing = more;
  nothing.triangles = more.triangles.bottomRows(2).eval();
  CHECK_THROWS_WITH(reread(nothing), Contains("no triangle of it has an area"));
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

  CHECK_THROWS_WITH(check_surface(testing::joined_surfaces(box, shifted(box, {1.0, 0.0, 0.0}))),
                    Contains("several pieces") && !Contains("cavity"));
  core::TriangleSurface inner = box;
  const core::Bounds around = core::bounds(box);
  const Eigen::RowVector3d centre_m = 0.5 * (around.low_m + around.high_m).transpose();
  inner.points_m = (0.5 * (box.points_m.rowwise() - centre_m)).rowwise() + centre_m;
  CHECK_THROWS_WITH(check_surface(testing::joined_surfaces(box, inner)), Contains("cavity"));
  inner.triangles.col(1).swap(inner.triangles.col(2));  // facing into the cavity
  CHECK_THROWS_WITH(check_surface(testing::joined_surfaces(box, inner)), Contains("cavity"));
  // Its top lies inside, and its bottom comes out.
  const core::TriangleSurface crossing = shifted(inner, {0.0, 0.0, -0.5 * around.size_m().z()});
  CHECK_THROWS_WITH(check_surface(testing::joined_surfaces(box, crossing)),
                    Contains("several pieces") && !Contains("cavity"));
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

namespace {
protocols::ReadSurface read_off(const std::string& corners) {
  return protocols::read_surface(protocols::surface_source("face.off", "OFF\n" + corners), 1.0);
}
}  // namespace

TEST_CASE("a face that no triangles can fill is refused, with its place", "[protocols][surface]") {
  const auto* corners = GENERATE(
      // a face that crosses itself, one without area
      "5 1 0\n-20 -10 0\n-20 0 -10\n-20 -20 -10\n0 0 0\n10 -10 -10\n5 0 1 2 3 4\n",
      "8 1 0\n-21.02577 2.5e-301 0\n-26.38852 7.1e-302 0\n26.204615 7.5e-301 0\n-20.5744 7.3e-301 "
      "0\n-14.5726 9e-16 0\n-0.96541 5.2e-16 0\n-19.42 0 0\n-25.37 7.9e-16 0\n8 0 1 2 3 4 5 6 7\n");
  CHECK_THROWS_WITH(read_off(corners), Contains("corners at (") && Contains("cannot be cut"));
}

TEST_CASE("corners of a face that follow each other in one place are one", "[protocols][surface]") {
  const protocols::ReadSurface face =
      read_off("5 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 0\n6 0 1 1 2 3 4\n");
  CHECK(face.surface.triangles.rows() == 2);
  const protocols::ReadSurface with_line =
      read_off("4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 0 0\n4 0 1 2 3\n4 0 1 1 3\n");
  CHECK(with_line.surface.triangles.rows() == 1);
  CHECK(with_line.noise.without_area == 1);
}

TEST_CASE("a face beyond all sizes is refused", "[protocols][surface]") {
  CHECK_THROWS_AS(read_off("4 1 0\n0 0 0\n1e308 0 0\n1e308 1e308 0\n0 1e308 0\n4 0 1 2 3\n"),
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
  const core::TriangleSurface surface = read_text("u.off", off.str(), 0.1);
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
  CHECK_THROWS_WITH(protocols::check_surface(read_text("cap.off", text)),
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
  const std::string words = top.describe_touchable(beside);
  Eigen::Vector2d named{};
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg,cert-err34-c)
  REQUIRE(std::sscanf(words.c_str(), "seen from above its nearest place is (%lf, %lf)", &named.x(),
                      &named.y()) == 2);
  CHECK(top.at_m(named));
}

TEST_CASE("a mesh that would be too large is refused with what would help, not with keys unset",
          "[protocols][surface][slow]") {
  const core::Shape sheet = core::Solid{testing::box_surface({1.0, 1.0, 0.002})};
  CHECK_THROWS_WITH(core::mesh_shape(sheet, {}, {}),
                    Contains("also with mesh.radius_edge_ratio: 40 in place of 1.414") &&
                        Contains("mesh.flattening") && !Contains("larger than"));
}
