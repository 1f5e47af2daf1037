#include "core/model/joints/coupled_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/algebra/dense_solvers.hpp"
#include "core/error.hpp"
#include "core/model/elements/assembly.hpp"
#include "core/model/elements/spring_support.hpp"
#include "core/model/error_estimate.hpp"
#include "core/model/joints/joints.hpp"
#include "core/model/modes/modal_solver.hpp"
namespace tapstudy::core {
namespace {
using Entries = std::vector<Eigen::Triplet<double>>;

void add_block(const SparseMatrix& block, int first, Entries& entries) {
  for (Eigen::Index column = 0; column < block.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry{block, column}; entry; ++entry) {
      entries.emplace_back(first + static_cast<int>(entry.row()), first + static_cast<int>(column),
                           entry.value());
    }
  }
}

class Elongations {
 public:
  Elongations(const Plate& plate, const Joints& joints, const CoupledBodies& system)
      : plate_{plate}, joints_{joints}, system_{system}, shifts_m_{shifts_of_bodies()} {}

  std::vector<Elongation> all() const {
    std::vector<Elongation> elongations;
    for (std::size_t i = 0; i < joints_.springs.size(); ++i) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        if (joints_.springs[i].stiffness_n_per_m[axis] > 0.0) {
          elongations.push_back(along(axis, i));
        }
      }
    }
    return elongations;
  }

  // Axes are parallel, so that shifts of the bodies must bring all joints together at once: else
  // the springs would hold free bodies against turning.
  void check_can_touch() const {
    for (std::size_t i = 0; i < joints_.springs.size(); ++i) {
      const auto& joins = joints_.springs[i];
      const double apart_m =
          (shifts_m_[joins.to.body] - shifts_m_[joins.from.body] + shift_m(i)).norm();
      if (apart_m > max_misplacement * larger_diagonal_m(joins)) {
        throw ModelError{fmt::format(
            "contact spring {} joins places that cannot lie on one another while those of the "
            "springs before it do: {:.3g} mm apart",
            i + 1, 1e3 * apart_m)};
      }
    }
  }

 private:
  struct NamedEnd {
    const JointSpring::End& end;
    std::size_t spring;
    const char* name;  // as in a protocol
  };
  static constexpr double max_misplacement = 0.02;  // of a body: discs are meshed coarsely

  Elongation along(Eigen::Index axis, std::size_t spring) const {
    const JointSpring& joins = joints_.springs[spring];
    const auto motions = 6 * static_cast<Eigen::Index>(system_.bodies.size());
    Elongation elongation{
        spring, joins.stiffness_n_per_m[axis], {}, Eigen::VectorXd::Zero(motions)};
    add({joins.from, spring, "from"}, axis, 1.0, elongation);
    add({joins.to, spring, "to"}, axis, -1.0, elongation);
    return elongation;
  }
  double larger_diagonal_m(const JointSpring& spring) const {
    return std::max(bounds(shape_of(spring.from.body)).size_m().norm(),
                    bounds(shape_of(spring.to.body)).size_m().norm());
  }
  // The translation of each body to where the first springs that reach it join it.
  std::vector<Vec3> shifts_of_bodies() const {
    std::vector<std::optional<Vec3>> shifts_m(system_.bodies.size());
    for (std::optional<Vec3>& first : shifts_m) {
      if (first) {
        continue;
      }
      first = Vec3::Zero();
      while (reach_another(shifts_m)) {
      }
    }
    std::vector<Vec3> all_m;
    std::ranges::transform(shifts_m, std::back_inserter(all_m),
                           [](const std::optional<Vec3>& shift) { return *shift; });
    return all_m;
  }
  bool reach_another(std::vector<std::optional<Vec3>>& shifts_m) const {
    for (std::size_t i = 0; i < joints_.springs.size(); ++i) {
      std::optional<Vec3>& of_from = shifts_m[joints_.springs[i].from.body];
      std::optional<Vec3>& of_to = shifts_m[joints_.springs[i].to.body];
      if (of_from.has_value() != of_to.has_value()) {
        (of_from ? of_to : of_from) = of_from ? Vec3{*of_from - shift_m(i)} : *of_to + shift_m(i);
        return true;
      }
    }
    return false;
  }
  // The translation from one end of a spring to the other.
  Vec3 shift_m(std::size_t spring) const {
    const JointSpring& joins = joints_.springs[spring];
    return mean_place_m({joins.to, spring, "to"}) - mean_place_m({joins.from, spring, "from"});
  }
  const Shape& shape_of(std::size_t body) const {
    return body == 0 ? plate_.shape : joints_.bodies.at(body - 1).shape;
  }
  std::vector<Eigen::Index> nodes_at(const NamedEnd& named) const {
    const JointSpring::End& end = named.end;
    return nodes_of(end.region, system_.bodies.at(end.body).mesh, shape_of(end.body),
                    fmt::format("contact spring {}, {}", named.spring + 1, named.name));
  }
  Vec3 mean_place_m(const NamedEnd& named) const {
    const TetMesh& mesh = system_.bodies.at(named.end.body).mesh;
    return mean_of(mean_weights(mesh, nodes_at(named)), mesh);
  }
  static Vec3 mean_of(const std::vector<NodeWeight>& weights, const TetMesh& mesh) {
    Vec3 place_m = Vec3::Zero();
    for (const NodeWeight& one : weights) {
      place_m += one.weight * mesh.nodes_m.row(one.node).transpose();
    }
    return place_m;
  }
  // The mean place of both ends, in the frame of this one.
  Vec3 middle_m(const NamedEnd& named) const {
    const JointSpring& joins = joints_.springs[named.spring];
    const Vec3 from_m =
        mean_place_m({joins.from, named.spring, "from"}) + shifts_m_[joins.from.body];
    const Vec3 to_m = mean_place_m({joins.to, named.spring, "to"}) + shifts_m_[joins.to.body];
    return 0.5 * (from_m + to_m) - shifts_m_[named.end.body];
  }
  // The mean displacement of a region about the place where both ends meet. Two meshes of one disc
  // have their means a little apart, and springs between these would hold free bodies against
  // turning: so the weights are tilted, w (1 + a·(x - mean)), until their mean place is that one.
  // Only along a region's extent; a point stays where it is.
  std::vector<NodeWeight> weights_of(const NamedEnd& named) const {
    const TetMesh& mesh = system_.bodies.at(named.end.body).mesh;
    std::vector<NodeWeight> weights = mean_weights(mesh, nodes_at(named));
    const Vec3 mean_m = mean_of(weights, mesh);
    Eigen::Matrix3d spread_m2 = Eigen::Matrix3d::Zero();
    const auto arm_m = [&](const NodeWeight& one) -> Vec3 {
      return mesh.nodes_m.row(one.node).transpose() - mean_m;
    };
    for (const NodeWeight& one : weights) {
      spread_m2 += one.weight * arm_m(one) * arm_m(one).transpose();
    }
    constexpr double extended = 3.0 * std::numeric_limits<double>::epsilon();
    const Vec3 tilt_per_m = shortest_solution(spread_m2, middle_m(named) - mean_m, extended);
    for (NodeWeight& one : weights) {
      one.weight *= 1.0 + tilt_per_m.dot(arm_m(one));
    }
    return weights;
  }
  void add(const NamedEnd& named, Eigen::Index axis, double sign, Elongation& elongation) const {
    const JointSpring::End& end = named.end;
    const DiscreteBody& body = system_.bodies.at(end.body);
    const RigidMotions motions{body.mesh};
    for (const NodeWeight& one : weights_of(named)) {
      for (decltype(body.displacement)::InnerIterator share{body.displacement, 3 * one.node + axis};
           share; ++share) {
        elongation.weights.emplace_back(system_.first_dof[end.body] + static_cast<int>(share.col()),
                                        sign * one.weight * share.value());
      }
      elongation.motions.segment<6>(6 * static_cast<Eigen::Index>(end.body)) +=
          sign * one.weight *
          motions.displacement(body.mesh.nodes_m.row(one.node).transpose(), axis);
    }
  }

  const Plate& plate_;
  const Joints& joints_;
  const CoupledBodies& system_;
  std::vector<Vec3> shifts_m_;  // of the bodies, by which their joints meet
};

// k g g', of which the lower triangle.
void add_spring(const Elongation& elongation, Entries& entries) {
  for (const auto& [row, a] : elongation.weights) {
    for (const auto& [column, b] : elongation.weights) {
      if (row >= column) {
        entries.emplace_back(row, column, elongation.stiffness_n_per_m * a * b);
      }
    }
  }
}

SparseMatrix from_entries(const Entries& entries, int size) {
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void place_after_one_another(CoupledBodies& system) {
  system.first_dof = {0};
  for (const DiscreteBody& body : system.bodies) {
    const int first = system.first_dof.back();
    const std::vector<int>& nodes = body.matrices.first_of_node;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      system.matrices.first_of_node.push_back(first + nodes[i]);
    }
    system.first_dof.push_back(first + static_cast<int>(body.matrices.K.rows()));
  }
  system.matrices.first_of_node.push_back(system.first_dof.back());
}
}  // namespace

CoupledBodies coupled(const Plate& plate, std::vector<DiscreteBody> bodies, const Joints& joints) {
  CoupledBodies system;
  system.bodies = std::move(bodies);
  place_after_one_another(system);
  Entries stiffness;
  Entries mass;
  const auto motions = 6 * static_cast<Eigen::Index>(system.bodies.size());
  Eigen::MatrixXd& resisted = system.matrices.resisted_motions;
  resisted.setZero(motions, motions);
  for (std::size_t i = 0; i < system.bodies.size(); ++i) {
    const DiscreteBody& body = system.bodies[i];
    add_block(body.matrices.K, system.first_dof[i], stiffness);
    add_block(body.matrices.M, system.first_dof[i], mass);
    resisted.block<6, 6>(6 * static_cast<Eigen::Index>(i), 6 * static_cast<Eigen::Index>(i)) =
        body.matrices.resisted_motions;
  }
  const Elongations elongations{plate, joints, system};
  elongations.check_can_touch();
  system.elongations = elongations.all();
  for (const Elongation& elongation : system.elongations) {
    add_spring(elongation, stiffness);
    resisted += elongation.motions * elongation.motions.transpose();
  }
  system.matrices.K = from_entries(stiffness, system.first_dof.back());
  system.matrices.M = from_entries(mass, system.first_dof.back());
  system.matrices.rigid_body_modes = unresisted(resisted);
  return system;
}

std::vector<Fixation> regions_of(std::size_t body, const Joints& joints) {
  std::vector<Fixation> regions;
  for (const JointSpring& spring : joints.springs) {
    for (const JointSpring::End* const end : {&spring.from, &spring.to}) {
      if (end->body == body) {
        regions.push_back(end->region);
      }
    }
  }
  return regions;
}

namespace {
std::vector<DiscreteBody> all_discretised(const BodySpec& body, const ProgressHook& progress) {
  const Joints& joints = *body.joints;
  std::vector<DiscreteBody> all{
      discretised(body, body.unit_material(), body.mesh.size, regions_of(0, joints), progress)};
  for (const JoinedBody& other : joints.bodies) {
    all.push_back(discretised(other, other.material, other.mesh.size,
                              regions_of(all.size(), joints), progress));
  }
  return all;
}

// The squared elongation in each mode.
Eigen::ArrayXd squares(const Elongation& elongation, const Eigen::MatrixXd& shapes) {
  Eigen::ArrayXd displacement = Eigen::ArrayXd::Zero(shapes.cols());
  for (const auto& [dof, weight] : elongation.weights) {
    displacement += weight * shapes.row(dof).transpose().array();
  }
  return displacement.square();
}

void set_energy_shares(const CoupledBodies& system, std::size_t springs, const Modes& modes,
                       BodyModes& found) {
  const auto bodies = static_cast<Eigen::Index>(system.bodies.size());
  const Eigen::ArrayXd eigenvalues = modes.omega_rad_s.square();
  found.kinetic_share.resize(bodies, modes.shapes.cols());
  found.strain_share.setZero(bodies + static_cast<Eigen::Index>(springs), modes.shapes.cols());
  for (Eigen::Index i = 0; i < bodies; ++i) {
    const auto body = static_cast<std::size_t>(i);
    const StiffnessAndMass& matrices = system.bodies[body].matrices;
    const Eigen::MatrixXd shapes =
        modes.shapes.middleRows(system.first_dof[body], matrices.K.rows());
    found.kinetic_share.row(i) = shapes.cwiseProduct(matrices.mass() * shapes).colwise().sum();
    found.strain_share.row(i) =
        shapes.cwiseProduct(matrices.stiffness() * shapes).colwise().sum().array() /
        eigenvalues.transpose();
  }
  found.strain_share = found.strain_share.cwiseMax(0.0);  // rounding, where a body hardly bends
  for (const Elongation& elongation : system.elongations) {
    const Eigen::Index row = bodies + static_cast<Eigen::Index>(elongation.spring);
    found.strain_share.row(row).array() +=
        (elongation.stiffness_n_per_m * squares(elongation, modes.shapes) / eigenvalues)
            .transpose();
  }
}
}  // namespace

namespace {
std::string held_in_part_of_any(const BodySpec& body, const std::vector<DiscreteBody>& bodies) {
  std::string all;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Plate& one = i == 0 ? body : static_cast<const Plate&>(body.joints->bodies[i - 1]);
    for (const std::string& part : held_in_part(bodies[i].mesh, one.shape, one.fixations)) {
      all += (all.empty() ? "" : "; ") + part;
      all += i == 0 ? "" : fmt::format(" of body {}", i);
    }
  }
  return all;
}
}  // namespace

SolvedBody solve_joined_bodies(const BodySpec& body, const ProgressHook& progress,
                               ErrorEstimation estimation) {
  CoupledBodies system = coupled(body, all_discretised(body, progress), *body.joints);
  const double turn = 2.0 * std::numbers::pi;
  const Modes modes = solve_modes(system.matrices, body.band_limit_rad_per_m / turn, progress);
  SolvedBody solved;
  solved.modes.kappa_rad_per_m = modes.omega_rad_s;
  solved.modes.band_limit_rad_per_m = body.band_limit_rad_per_m;
  set_energy_shares(system, body.joints->springs.size(), modes, solved.modes);
  solved.modes.report = report_on(system.bodies, modes);
  solved.modes.estimate = estimate_if_wanted(estimation, body, system, modes, progress);
  solved.modes.estimate.held_in_part = held_in_part_of_any(body, system.bodies);
  DiscreteBody& tapped = system.bodies.front();
  solved.displacement = tapped.displacement * modes.shapes.topRows(tapped.matrices.K.rows());
  solved.mesh = std::move(tapped.mesh);
  return solved;
}
}  // namespace tapstudy::core
