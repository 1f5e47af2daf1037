#include "core/model/mesh/tetgen_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <new>
#include <span>

#include "core/error.hpp"
#include "core/process/bounded_child.hpp"

#define TETLIBRARY
#include <tetgen.h>
namespace tapstudy::core {
namespace {
// TetGen frees its input with delete[], so its structures must be allocated with new[].
// NOLINTBEGIN(cppcoreguidelines-owning-memory)
tetgenio::polygon polygon_of(const std::vector<int>& vertices) {
  tetgenio::polygon polygon{};
  tetgenio::init(&polygon);
  polygon.numberofvertices = static_cast<int>(vertices.size());
  polygon.vertexlist = new int[vertices.size()];
  std::ranges::copy(vertices, polygon.vertexlist);
  return polygon;
}

void fill_facet(tetgenio::facet& facet, const std::vector<std::vector<int>>& polygons) {
  tetgenio::init(&facet);
  facet.numberofpolygons = static_cast<int>(polygons.size());
  facet.polygonlist = new tetgenio::polygon[polygons.size()];
  std::ranges::transform(polygons, facet.polygonlist, polygon_of);
}

void fill(tetgenio& in, const TetgenInput& input) {
  in.firstnumber = 0;
  in.numberofpoints = static_cast<int>(input.coordinates.size() / 3);
  in.pointlist = new REAL[input.coordinates.size()];
  std::ranges::copy(input.coordinates, in.pointlist);
  in.numberoffacets = static_cast<int>(input.facets.size());
  in.facetlist = new tetgenio::facet[input.facets.size()];
  in.facetmarkerlist = nullptr;
  for (std::size_t i = 0; i < input.facets.size(); ++i) {
    fill_facet(in.facetlist[i], input.facets[i]);
  }
}
// NOLINTEND(cppcoreguidelines-owning-memory)

std::string packed(const TetgenInput& input) {
  PackedBytes bytes;
  bytes.put(input.switches);
  bytes.put(input.coordinates);
  bytes.put(std::vector<std::size_t>{input.facets.size()});
  for (const auto& polygons : input.facets) {
    bytes.put(std::vector<std::size_t>{polygons.size()});
    for (const auto& polygon : polygons) {
      bytes.put(polygon);
    }
  }
  return bytes.take();
}

TetgenInput input_from(const std::string& packed_bytes) {
  UnpackedBytes bytes{packed_bytes};
  const auto count = [&] { return bytes.get<std::vector<std::size_t>>().at(0); };
  TetgenInput input;
  input.switches = bytes.get<std::string>();
  input.coordinates = bytes.get<std::vector<double>>();
  input.facets.resize(count());
  for (auto& polygons : input.facets) {
    polygons.resize(count());
    std::ranges::generate(polygons, [&] { return bytes.get<std::vector<int>>(); });
  }
  return input;
}

std::string reason_for(int tetgen_code) {
  switch (tetgen_code) {
    case 1:
      return "not enough memory";
    case 3:
      return "the surface runs through itself";
    case 4:
      return "the surface has features too small for its size";
    case 5:
      return "two faces nearly coincide";
    default:
      return fmt::format("code {}", tetgen_code);
  }
}

std::string tetrahedralised(const std::string& packed_input) {
  TetgenInput input = input_from(packed_input);
  tetgenio in;
  tetgenio out;
  fill(in, input);
  try {
    tetrahedralize(input.switches.data(), &in, &out);
  } catch (int code) {
    throw ModelError{fmt::format("mesh: TetGen failed to mesh the body: {}", reason_for(code))};
  } catch (const std::bad_alloc&) {
    throw ModelError{"mesh: not enough memory for so many tetrahedra"};
  }
  if (out.numberoftetrahedra <= 0) {
    throw ModelError{"mesh: TetGen found no inside of the body"};
  }
  PackedBytes bytes;
  bytes.put(std::span{out.pointlist, 3 * static_cast<std::size_t>(out.numberofpoints)});
  bytes.put(std::span{out.tetrahedronlist, 4 * static_cast<std::size_t>(out.numberoftetrahedra)});
  return bytes.take();
}

const ChildJob tetgen{"tetgen", tetrahedralised};
}  // namespace

TetgenOutput run_tetgen(const TetgenInput& input) {
  const std::string packed_output =
      in_bounded_child(tetgen, packed(input), "mesh: TetGen could not mesh the body");
  UnpackedBytes bytes{packed_output};
  TetgenOutput output;
  output.coordinates = bytes.get<std::vector<double>>();
  output.corners = bytes.get<std::vector<int>>();
  return output;
}
}  // namespace tapstudy::core
