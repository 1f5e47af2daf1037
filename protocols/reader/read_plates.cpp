// Plates: shape, mesh and fixations.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <variant>

#include "core/error.hpp"
#include "core/geometry/smooth_normals.hpp"
#include "core/model/cubic_elements.hpp"
#include "core/model/shells/shell_elements.hpp"
#include "protocols/axes/axis.hpp"
#include "protocols/reader/read_sections.hpp"
#include "protocols/surface/check_surface.hpp"
#include "protocols/surface/repair_command.hpp"
#include "protocols/surface/repaired_surface.hpp"
#include "protocols/surface/surface_file.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;
constexpr Range coordinate_m{-10.0, 10.0};
constexpr const char* some_above_0 = R"({"contains": {"exclusiveMinimum": 0}})";

std::array<bool, 3> read_axes(MapReader& fixation) {
  const std::string axes =
      fixation.word({"axes", "constrained axes, plate frame; not beside springs_n_per_m"},
                    "set of axes", {"xyz", "xy", "xz", "yz", "x", "y", "z"}, std::string{"xyz"});
  const auto has = [&](char axis) { return axes.find(axis) != std::string::npos; };
  return {has('x'), has('y'), has('z')};
}

// A region is constrained along some axes, or on springs.
void read_hold(MapReader& reader, core::Fixation& fixation) {
  if (!reader.has("springs_n_per_m")) {
    fixation.constrained_axes = read_axes(reader);
    return;
  }
  reader.refuse("axes", "not beside springs_n_per_m, whose axes of stiffness 0 are free");
  const core::Vec3 springs_n_per_m =
      reader.numbers({"springs_n_per_m",
                      "the region is not held rigidly but on springs to the ground: stiffness of "
                      "the whole region along x, y and z, 0: free along that axis; "
                      "youngs_modulus_pa cannot vary on such a plate; unset: rigid"},
                     3, allowed::spring_n_per_m);
  reader.check("springs_n_per_m", !springs_n_per_m.isZero(0.0), some_above_0,
               "holds nothing: every stiffness is 0");
  fixation.springs_n_per_m = springs_n_per_m;
}

Key at_key() {
  return {"at_m", "vertex and disc with size_m: x, y; ball, and vertex of a surface: x, y, z"};
}

void read_place(MapReader& reader, bool is_box, core::Fixation& fixation) {
  if (!is_box) {
    fixation.at_m = reader.numbers(at_key(), 3, coordinate_m);
    return;
  }
  fixation.at_m.head<2>() = reader.numbers(at_key(), 2, coordinate_m);
  fixation.face = reader.one_of<core::Face>(
      {"face",
       "vertex and disc with size_m only: both faces, one of them, or through the thickness"},
      core::face_names, "both");
}

core::Fixation read_region(MapReader& reader, bool is_box) {
  using core::RegionShape;
  core::Fixation fixation;
  fixation.shape =
      reader.one_of<RegionShape>({"region",
                                  "vertex: single nodes; disc: circle on the faces; ball, box: all "
                                  "nodes within; side: all nodes on it"},
                                 core::region_names);
  switch (fixation.shape) {
    case RegionShape::disc:
      if (!is_box) {
        reader.reject("region", "a disc lies on a plate; on a surface from a file use a ball");
      }
      [[fallthrough]];
    case RegionShape::vertex:
      read_place(reader, is_box, fixation);
      break;
    case RegionShape::ball:
      fixation.at_m = reader.numbers(at_key(), 3, coordinate_m);
      break;
    case RegionShape::box:
      fixation.low_m =
          reader.numbers({"low_m", "lower corner of a box region, plate frame"}, 3, coordinate_m);
      fixation.high_m = reader.numbers({"high_m", "upper corner of a box region, not below low_m"},
                                       3, coordinate_m);
      if ((fixation.low_m.array() > fixation.high_m.array()).any()) {
        reader.reject("low_m", "is not below high_m along every axis");
      }
      break;
    case RegionShape::side:
      fixation.side = reader.one_of<core::Side>(
          {"side", "side of the bounding box: left is low x, front low y, bottom low z"},
          core::side_names);
      break;
  }
  if (fixation.shape == RegionShape::disc || fixation.shape == RegionShape::ball) {
    fixation.radius_m =
        reader.number({"radius_m", "radius of a disc or ball"}, Range::positive(10.0));
  }
  return fixation;
}

core::Fixation read_fixation(MapReader& reader, bool is_box) {
  core::Fixation fixation = read_region(reader, is_box);
  read_hold(reader, fixation);
  return fixation;
}

bool is_bent_sheet(const core::Shape& shape) {
  return std::holds_alternative<core::Solid>(shape) && core::is_sheet(shape);
}

void refuse_settings_of_tetrahedra(MapReader& mesh, const std::string& why) {
  for (const char* const other :
       {"order", "max_tet_volume_m3", "radius_edge_ratio", "flattening", "accuracy"}) {
    if (mesh.has(other)) {
      mesh.reject(other, "is of tetrahedra, and " + why);
    }
  }
}

void read_mesh(MapReader& mesh, core::Meshing& meshing) {
  if (mesh.has("order")) {
    meshing.order = mesh.integer(
        {"order", fmt::format("element order: 1 as in the paper, 2 is far more accurate, 3 for "
                              "sheets and thin walls; unset: 2, but 1 where that would take more "
                              "than {} unknowns",
                              core::max_chosen_dofs)},
        1, core::cubic_order);
  }
  if (mesh.has("max_tet_volume_m3")) {
    meshing.size.max_tet_volume_m3 =
        mesh.number({"max_tet_volume_m3",
                     "maximum tetrahedron volume, with accuracy that of the first round; unset: no "
                     "limit, with accuracy 1/200 of the body"},
                    Range::positive(1e6));
  }
  meshing.size.radius_edge_ratio =
      mesh.number({"radius_edge_ratio", "TetGen's bound on circumradius over shortest edge"},
                  {1.1, 10.0}, 1.414);
  meshing.size.flattening = mesh.number(
      {"flattening", fmt::format("elements are this many times wider than thick, for thin sheets; "
                                 "beyond {} of order 3 alone",
                                 core::max_flattening)},
      {1.0, core::max_cubic_flattening}, 1.0);
  if (mesh.has("shell_width_m")) {
    meshing.shell_width_m = mesh.number(
        {"shell_width_m",
         fmt::format("size_m at least {} times wider than thick, or a surface with thickness_m: "
                     "shell elements this wide, without any other setting; unset: tetrahedra, or a "
                     "shell for each triangle",
                     core::least_width_to_thickness)},
        Range::positive(10.0));
    refuse_settings_of_tetrahedra(mesh, "shell_width_m takes shell elements");
  }
  if (meshing.order != core::cubic_order && meshing.size.flattening > core::max_flattening) {
    mesh.reject("flattening", fmt::format("beyond {} is of order 3 alone: elements of lower order "
                                          "bend too stiffly",
                                          core::max_flattening));
  }
  if (mesh.has("accuracy")) {
    meshing.accuracy = mesh.number({"accuracy",
                                    "refine until no frequency in the band changes by more than "
                                    "this fraction; unset: no refinement"},
                                   {1e-5, 1.0, true, false});
  }
}

// Read once, however many plates have it: what is modelled is what is stored.
SurfaceSource& surface_of(const std::string& file, const ReadFile& read_file, Protocol& protocol) {
  const auto known = std::ranges::find(protocol.surfaces, file, &SurfaceSource::file);
  if (known != protocol.surfaces.end()) {
    return *known;
  }
  return protocol.surfaces.emplace_back(surface_source(file, read_file(file)));
}

// Of the file's coordinates in the plate frame: turned first, by the length of a vector about its
// direction, then moved.
Eigen::Isometry3d read_pose(MapReader& reader) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (reader.has("offset_m")) {
    pose.translation() = reader.numbers(
        {"offset_m", "moves the surface in the plate frame, after it was turned; unset: stays"}, 3,
        coordinate_m);
  }
  if (reader.has("rotation_rad")) {
    const Eigen::Vector3d turn = reader.numbers(
        {"rotation_rad",
         "turns the surface about the direction of this vector by its length; unset: stays"},
        3, {-6.3, 6.3});
    pose.linear() = core::rotation({turn.x(), turn.y(), turn.z()});
  }
  return pose;
}

core::InvalidInput with_cure(const SurfaceFault& fault, const core::TriangleSurface& surface,
                             const std::string& file, double metres_per_unit) {
  const auto* const pieces = dynamic_cast<const SeveralPieces*>(&fault);
  return pieces != nullptr && pieces->have_cavity
             ? core::InvalidInput{fault.what()}
             : core::InvalidInput{
                   fmt::format("{}; {}", fault.what(), cures(surface, file, metres_per_unit))};
}

// Of a surface that passes; else a fault with the command that should cure it.
core::Solid solid_of(core::TriangleSurface surface, const std::string& file,
                     double metres_per_unit) {
  try {
    check_count(surface);
    check_surface(surface);
  } catch (const SurfaceFault& fault) {
    throw with_cure(fault, surface, file, metres_per_unit);
  }
  std::string command = command_that_simplifies(surface, file, metres_per_unit);
  return core::Solid{std::move(surface), std::move(command)};
}

RepairRequest read_repair(MapReader& repair) {
  const Range length_m = Range::positive(100.0);
  RepairRequest request;
  request.terms = &key_terms;
  request.join_share =
      repair.number({"join_share", "corners no further apart than this share of the size are one"},
                    {0.0, 0.01}, request.join_share);
  if (repair.has("largest_hole_m")) {
    request.longest_hole_m = repair.number(
        {"largest_hole_m", "fills holes up to this many metres round; unset: as the size"},
        length_m);
  }
  request.is_largest_piece_only = repair.yes_or_no(
      {"largest_piece",
       "drops all pieces but the one of the largest area, and those that wrap_m bridges to it"},
      false);
  if (repair.has("wrap_m")) {
    request.wrap_m = repair.number({"wrap_m",
                                    "where mending or simplifying does not do: a new surface "
                                    "around all, which bridges this many metres; unset: none"},
                                   length_m);
  }
  if (repair.has("max_triangles")) {
    request.max_triangles =
        repair.integer({"max_triangles", "simplifies to so many at most; unset: as it has"},
                       fewest_triangles, max_triangles);
  }
  return request;
}

// Made of the file once, however many plates have it, or as it is stored.
SurfaceSource repaired_surface_of(const SurfaceSource& file, const core::TriangleSurface& surface,
                                  const AskedRepair& asked, const SurfaceFiles& files,
                                  Protocol& protocol) {
  const std::string name = repaired_name(file.file, asked);
  const auto known = std::ranges::find(protocol.surfaces, name, &SurfaceSource::file);
  if (known != protocol.surfaces.end()) {
    return *known;
  }
  return protocol.surfaces.emplace_back(files.repaired ? repaired_source(name, files.repaired(name))
                                                       : repaired_source(file, surface, asked));
}

// What a plate's key `surface` says, but for the pose.
struct AskedSurface {
  std::string file;
  double metres_per_unit{};
  std::optional<double> thickness_m{};  // of a sheet
  std::optional<RepairRequest> repair{};
};

AskedSurface read_asked_surface(MapReader& reader) {
  AskedSurface asked;
  asked.file = reader.text({"file", "STL, PLY, OFF or OBJ; path relative to the protocol"});
  asked.metres_per_unit = reader.number({"metres_per_unit", "0.001 for a file in millimetres"},
                                        Range::positive(1000.0));
  if (reader.has("thickness_m")) {
    asked.thickness_m = reader.number(
        {"thickness_m",
         fmt::format("the surface is the middle of a sheet this thick, open or closed, of shell "
                     "elements; smooth but at edges at which it turns by more than {:.0f} degrees; "
                     "unset: it encloses a solid",
                     core::SmoothNormals::sharp_above_rad * 180.0 / std::numbers::pi)},
        Range::positive(0.1));
    reader.refuse("repair",
                  "makes closed surfaces of solids, and thickness_m takes a surface as it is");
    return asked;
  }
  reader.map(
      {"repair",
       "makes of a surface that encloses no body one that does, as `tapstudy repair`; check, "
       "modes and the report say what changed, and the result is stored with the study; "
       "unset: such a surface is refused"},
      Presence::optional, [&](MapReader& repair) { asked.repair = read_repair(repair); });
  return asked;
}

ReadSurface read_or_refuse(const SurfaceSource& source, double metres_per_unit) {
  try {
    return read_surface(source, metres_per_unit);
  } catch (const SurfaceFault& fault) {
    throw with_cure(fault, read_to_repair(source, metres_per_unit).surface, source.file,
                    metres_per_unit);
  }
}

core::TriangleSurface surface_asked_for(const AskedSurface& asked, const SurfaceFiles& files,
                                        Protocol& protocol) {
  SurfaceSource& source = surface_of(asked.file, files.contents, protocol);
  auto [surface, noise] = asked.repair ? read_to_repair(source, asked.metres_per_unit)
                                       : read_or_refuse(source, asked.metres_per_unit);
  source.noise = noise;
  if (asked.repair) {
    surface =
        read_surface(repaired_surface_of(source, surface, {asked.metres_per_unit, *asked.repair},
                                         files, protocol),
                     1.0)
            .surface;
  }
  return surface;
}

// Problems of the surface itself are reported at its key; reading then continues.
core::Shape read_surface_shape(MapReader& plate, const SurfaceFiles& files, Protocol& protocol) {
  core::Shape shape = core::Box{core::Vec3::Constant(10.0)};  // placeholder until read
  plate.map({"surface", "surface from a file, instead of a box"}, Presence::required,
            [&](MapReader& reader) {
              const std::size_t earlier_problems = reader.problems_in_file();
              const AskedSurface asked = read_asked_surface(reader);
              const bool is_known = reader.problems_in_file() == earlier_problems;
              const Eigen::Isometry3d pose = read_pose(reader);
              if (!is_known) {
                return;  // its size would be wrong
              }
              try {
                core::TriangleSurface surface = surface_asked_for(asked, files, protocol);
                for (auto point : surface.points_m.rowwise()) {
                  point = (pose * point.transpose()).transpose().eval();
                }
                shape = asked.thickness_m
                            ? checked_sheet(std::move(surface), *asked.thickness_m)
                            : solid_of(std::move(surface), asked.file, asked.metres_per_unit);
              } catch (const core::Error& error) {  // also what cannot be modelled or repaired
                reader.reject("file", error.what());
              }
            });
  return shape;
}
void read_lateral_scale(MapReader& reader, bool is_box, const core::Placement& placement,
                        Plate& plate) {
  const double scale = reader.number({"lateral_scale", "of this plate; unset: the placement's"},
                                     Range::positive(1000.0), placement.lateral_scale);
  if (placement.lateral_scale > 0.0) {  // or it was rejected
    plate.lateral_ratio = scale / placement.lateral_scale;
  }
  if (!is_box && scale != 1.0) {
    reader.reject(
        reader.has("lateral_scale") ? "lateral_scale" : "surface",
        "needs a lateral_scale of 1, here or in placement (only a flat plate can be scaled "
        "sideways)");
  }
}

// The protocol's points lie at the same places of the device on every plate, unless a plate has its
// own.
void read_own_points(MapReader& reader, const Protocol& protocol, Plate& plate) {
  for (const auto& [name, at_m] : protocol.tapping_points_m) {
    plate.tapping_points_m[name] = at_m / plate.lateral_ratio;
  }
  reader.each_point({"tapping_points_m",
                     "of this plate, for some of the study's names; unset: the study's, at the "
                     "same places of the device"},
                    Presence::optional, [&](const std::string& name, const Eigen::Vector2d& at_m) {
                      if (!plate.tapping_points_m.contains(name)) {
                        reader.reject(
                            "tapping_points_m",
                            fmt::format("'{}' is not among the study's tapping points{}", name,
                                        did_you_mean(name, keys_of(protocol.tapping_points_m))));
                        return;
                      }
                      plate.tapping_points_m[name] = at_m;
                    });
}
}  // namespace

void read_plates(MapReader& top, Protocol& protocol, const SurfaceFiles& files,
                 const EarlierDefaults& defaults) {
  top.each(
      {"plates", "named bodies, each a box or a surface, with mesh and boundary conditions"},
      Presence::required, [&](const std::string& name, MapReader& reader) {
        Plate plate;
        plate.stated_at = reader.stated_at();
        const bool is_box = !reader.has("surface");
        plate.shape = is_box ? core::Shape{core::Box{reader.numbers(
                                   {"size_m", "edge lengths of a box along x, y and z (thickness)"},
                                   3, allowed::edge_m)}}
                             : read_surface_shape(reader, files, protocol);
        plate.mesh.order = defaults.element_order;
        reader.map_or_word(
            {"mesh",
             "settings of the tetrahedral mesh; auto: order and size are chosen for a tenth of the "
             "smallest difference between the frequencies of the study's stimuli, at most 2 %"},
            Presence::optional, "auto", [&] { plate.mesh.is_automatic = true; },
            [&](MapReader& mesh) {
              read_mesh(mesh, plate.mesh);
              if (is_bent_sheet(plate.shape)) {
                refuse_settings_of_tetrahedra(mesh, "the surface has a thickness_m");
              }
            });
        if (is_bent_sheet(plate.shape) && !plate.mesh.is_automatic && !plate.mesh.shell_width_m) {
          plate.mesh.shell_width_m = core::widest_shells_m(plate.shape);
        }
        reader.list({"fixations", "regions that are held; an empty list: none"}, Presence::required,
                    [&](MapReader& fixation) {
                      plate.fixations.push_back(read_fixation(fixation, is_box));
                    });
        reader.each(
            {"contact_points",
             "regions at which the plate may touch other bodies, by name; as those of fixations"},
            Presence::optional, [&](const std::string& point, MapReader& region) {
              plate.contact_points[point] = read_region(region, is_box);
            });
        read_lateral_scale(reader, is_box, protocol.placement, plate);
        read_own_points(reader, protocol, plate);
        protocol.plates[name] = std::make_shared<const Plate>(std::move(plate));
      });
}

// Bodies that a tapped plate touches, and the springs between them.
namespace {
using Presence = MapReader::Presence;
using EndsByName = std::map<std::string, core::JointSpring::End>;  // by "body.point"

// Refinement follows one body's frequencies, and they have them together.
void check_mesh(MapReader& reader, const std::string& key, const Plate& plate) {
  if (plate.mesh.accuracy || plate.mesh.is_automatic) {
    reader.reject(key, fmt::format("its mesh {}, to which bodies in contact are not refined (give "
                                   "max_tet_volume_m3)",
                                   plate.mesh.is_automatic ? "is auto" : "has an accuracy"));
  } else if (plate.mesh.order == core::cubic_order) {
    reader.reject(key, "its mesh has order 3, which bodies in contact cannot have (1 or 2)");
  }
}

void add_points(const std::string& body, const std::shared_ptr<const Plate>& plate,
                Contacts& contacts, EndsByName& ends) {
  if (plate) {
    for (const auto& [name, region] : plate->contact_points) {
      ends.emplace(fmt::format("{}.{}", body, name),
                   core::JointSpring::End{contacts.plates.size(), region});
    }
  }
  contacts.plates.push_back(plate);
}

void read_body(const std::string& name, MapReader& reader, const Protocol& protocol,
               Contacts& contacts, EndsByName& ends) {
  const auto plate = named(
      protocol.plates, reader.word({"plate", "key in plates"}, "plate", keys_of(protocol.plates)));
  const auto material =
      named(protocol.materials, reader.word({"material", "key in materials; without modal_ratios"},
                                            "material", keys_of(protocol.materials)));
  if (plate) {
    check_mesh(reader, "plate", *plate);
  }
  if (material && std::holds_alternative<core::ModalDamping>(material->damping)) {
    reader.reject("material", modal_ratios_in_contact);
  }
  core::JoinedBody body;
  if (plate) {
    static_cast<core::Plate&>(body) = *plate;
  }
  if (material) {
    body.material = *material;
  }
  contacts.bodies.push_back(std::move(body));
  add_points(name, plate, contacts, ends);
}

// nullopt for a name that was rejected.
std::optional<core::JointSpring::End> read_end(MapReader& reader, const Key& key,
                                               const EndsByName& ends) {
  const auto found = ends.find(reader.word(key, "contact point", keys_of(ends)));
  return found == ends.end() ? std::nullopt : std::optional{found->second};
}

// nullopt where an end was rejected.
std::optional<core::JointSpring> read_spring(MapReader& reader, const EndsByName& ends) {
  core::JointSpring spring;
  const auto from = read_end(
      reader,
      {"from", "BODY.POINT: a contact point of a body's plate; the tapped plate has its own name"},
      ends);
  const auto to = read_end(reader, {"to", "likewise, of another body"}, ends);
  if (from && to && from->body == to->body) {
    reader.reject("to", "is a point of the same body as from");
  }
  spring.stiffness_n_per_m = reader.numbers({"springs_n_per_m",
                                             "along x, y and z, between the mean displacements of "
                                             "the two regions; 0: none along that axis"},
                                            3, allowed::spring_n_per_m);
  reader.check("springs_n_per_m", !spring.stiffness_n_per_m.isZero(0.0), some_above_0,
               "joins nothing: every stiffness is 0");
  spring.loss_factor = reader.number({"loss_factor",
                                      "of the pad between the regions: a mode whose strain is all "
                                      "in it has half of this as damping ratio"},
                                     {0.0, 2.0}, 0.0);
  if (!from || !to) {
    return std::nullopt;
  }
  spring.from = *from;
  spring.to = *to;
  return spring;
}

// A body that no springs lead to would ring unfelt.
void check_are_joined(MapReader& reader, const Contacts& contacts,
                      const std::vector<std::string>& bodies) {
  std::vector<bool> is_joined(bodies.size() + 1, false);
  is_joined[0] = true;
  for (std::size_t round = 0; round < bodies.size(); ++round) {
    for (const core::JointSpring& spring : contacts.springs) {
      const bool is_either = is_joined[spring.from.body] || is_joined[spring.to.body];
      is_joined[spring.from.body] = is_either;
      is_joined[spring.to.body] = is_either;
    }
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!is_joined[i + 1]) {
      reader.reject("bodies", fmt::format("no springs lead from '{}' to the plate that is tapped",
                                          bodies[i]));
    }
  }
}

Contacts read_set(MapReader& reader, const Protocol& protocol) {
  Contacts contacts;
  EndsByName ends;
  const std::string tapped =
      reader.word({"tapped", "plate of the stimuli that name these contacts"}, "plate",
                  keys_of(protocol.plates));
  add_points(tapped, named(protocol.plates, tapped), contacts, ends);
  if (contacts.plates.front()) {
    check_mesh(reader, "tapped", *contacts.plates.front());
  }
  std::vector<std::string> bodies;
  bool are_ends_known = true;
  reader.each({"bodies",
               "the other bodies, by names of their own, each joined to the tapped plate by "
               "springs, directly or through others; axes parallel to those of the tapped plate; "
               "without mesh.accuracy"},
              Presence::required, [&](const std::string& name, MapReader& body) {
                bodies.push_back(name);
                if (name == tapped) {
                  body.reject("has the name of the plate that is tapped");
                }
                read_body(name, body, protocol, contacts, ends);
              });
  reader.list({"springs", "what joins the bodies; linear: contacts are never lost"},
              Presence::at_least_one, [&](MapReader& inner) {
                const auto spring = read_spring(inner, ends);
                are_ends_known = are_ends_known && spring;
                contacts.springs.push_back(spring.value_or(core::JointSpring{}));
              });
  if (are_ends_known && !contacts.springs.empty()) {
    check_are_joined(reader, contacts, bodies);
  }
  return contacts;
}
}  // namespace

void read_contacts(MapReader& top, Protocol& protocol) {
  top.each(
      {"contacts",
       "what tapped plates touch: other bodies, joined to them by springs, all vibrating together"},
      Presence::optional, [&](const std::string& name, MapReader& reader) {
        protocol.contacts[name] = std::make_shared<const Contacts>(read_set(reader, protocol));
      });
}

void check_contacts(MapReader& reader, const Stimulus& stimulus, const Protocol& protocol) {
  if (!stimulus.contacts) {
    return;
  }
  const auto& tapped = stimulus.contacts->plates.front();
  if (stimulus.plate && tapped && stimulus.plate != tapped) {
    const auto name = std::ranges::find_if(
        protocol.plates, [&](const auto& known) { return known.second == tapped; });
    reader.reject("contacts", fmt::format("are those of plate '{}'", name->first));
  }
  if (stimulus.material && std::holds_alternative<core::ModalDamping>(stimulus.material->damping)) {
    reader.reject("material", modal_ratios_in_contact);
  }
  if (stimulus.technique != nullptr && stimulus.technique->needs_beam()) {
    reader.reject("contacts", fmt::format("technique '{}' computes a plate that touches no other",
                                          stimulus.technique->name));
  }
}
}  // namespace tapstudy::protocols
