#include "core/model/beam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.hpp"
namespace tapstudy::core {
namespace {
constexpr double least_slenderness = 10.0;
constexpr double least_length_over_width = 3.0;  // a wider one bends, and turns, as a plate
constexpr std::size_t max_modes = 200;
constexpr int stations = 256;  // along the touched face; shapes are linear between them

bool is_clamped_side(const Fixation& fixation) {
  return fixation.shape == RegionShape::side && !fixation.springs_n_per_m &&
         std::ranges::all_of(fixation.constrained_axes, [](bool is) { return is; }) &&
         fixation.side != Side::top && fixation.side != Side::bottom;
}
int axis_of(Side side) {
  return side == Side::left || side == Side::right ? 0 : 1;
}
bool is_low(Side side) {
  return side == Side::left || side == Side::front;
}

// The n-th (b L), from 1: the roots of cos x = -+1 / cosh x.
double root(std::size_t n, bool is_held_at_both_ends) {
  const double sign = is_held_at_both_ends ? -1.0 : 1.0;
  const auto excess = [&](double x) { return std::cos(x) + sign / std::cosh(x); };
  const double low =
      std::numbers::pi * (static_cast<double>(n) - (is_held_at_both_ends ? 0.0 : 1.0));
  std::uintmax_t iterations = 100;
  const auto [below, above] =
      boost::math::tools::toms748_solve(excess, low, low + std::numbers::pi,
                                        boost::math::tools::eps_tolerance<double>(52), iterations);
  return 0.5 * (below + above);
}

// cosh bx - cos bx - s (sinh bx - sin bx), whose mean square along the beam is 1, arranged so that
// the growing exponentials do not cancel. s makes the other end free, or held.
class BeamShape {
 public:
  BeamShape(double root, bool is_held_at_both_ends) : root_{root} {
    const double decayed = std::exp(-root);
    const double sine = std::sin(root);
    const double cosine = std::cos(root);
    less_than_one_ = is_held_at_both_ends ? (cosine - sine - decayed) / (std::sinh(root) - sine)
                                          : (decayed + cosine + sine) / (std::cosh(root) + cosine);
  }
  double at(double share) const {  // of the length
    const double bx = root_ * share;
    return std::exp(-bx) + less_than_one_ * std::sinh(bx) - std::cos(bx) +
           (1.0 - less_than_one_) * std::sin(bx);
  }

 private:
  double root_;
  double less_than_one_{};  // 1 - s
};

// Two rows of nodes along the tapped face, z = 0.
void set_touched_face(const Box& box, const Beam& beam, BodyModes& modes) {
  const int across = 1 - beam.axis;
  modes.touch_nodes_m.setZero(Eigen::Index{2} * (stations + 1), 3);
  modes.touch_surface.resize(Eigen::Index{2} * stations, 3);
  for (int i = 0; i <= stations; ++i) {
    for (int edge = 0; edge < 2; ++edge) {
      const Eigen::Index node = Eigen::Index{2} * i + edge;
      modes.touch_nodes_m(node, beam.axis) =
          box.low_m()[beam.axis] + beam.length_m * i / static_cast<double>(stations);
      modes.touch_nodes_m(node, across) = edge == 0 ? box.low_m()[across] : box.high_m()[across];
    }
  }
  // counter-clockwise from above
  const bool is_along_x = beam.axis == 0;
  for (int i = 0; i < stations; ++i) {
    const int first = 2 * i;
    const std::array<int, 3> one{first, first + 2, first + 3};
    const std::array<int, 3> other{first, first + 3, first + 1};
    for (int corner = 0; corner < 3; ++corner) {
      const int from = is_along_x ? corner : 2 - corner;
      modes.touch_surface(Eigen::Index{2} * i, corner) = one.at(static_cast<std::size_t>(from));
      modes.touch_surface(Eigen::Index{2} * i + 1, corner) =
          other.at(static_cast<std::size_t>(from));
    }
  }
}

// Mass-normalised for a density of 1.
void set_shapes(const Box& box, const Beam& beam, const std::vector<double>& roots,
                BodyModes& modes) {
  const double scale = 1.0 / std::sqrt(box.size_m.prod());
  modes.shape.setZero(3 * modes.touch_nodes_m.rows(), static_cast<Eigen::Index>(roots.size()));
  for (std::size_t n = 0; n < roots.size(); ++n) {
    const BeamShape shape{roots[n], beam.is_held_at_both_ends};
    for (Eigen::Index node = 0; node < modes.touch_nodes_m.rows(); ++node) {
      const double along_m = modes.touch_nodes_m(node, beam.axis) - beam.held_at_m;
      modes.shape(3 * node + 2, static_cast<Eigen::Index>(n)) =
          scale * shape.at(beam.towards * along_m / beam.length_m);
    }
  }
}
}  // namespace

std::optional<Beam> beam_of(const Plate& plate) {
  const auto* const box = std::get_if<Box>(&plate.shape);
  const auto& held = plate.fixations;
  if (box == nullptr || held.empty() || held.size() > 2 ||
      !std::ranges::all_of(held, is_clamped_side)) {
    return std::nullopt;
  }
  const Side side = held.front().side;
  const bool are_opposite = held.size() == 1 || (axis_of(held[1].side) == axis_of(side) &&
                                                 is_low(held[1].side) != is_low(side));
  const int axis = axis_of(side);
  const double length_m = box->size_m[axis];
  if (!are_opposite || length_m < least_slenderness * box->size_m.z() ||
      length_m < least_length_over_width * box->size_m[1 - axis]) {
    return std::nullopt;
  }
  return Beam{axis,
              length_m,
              box->size_m.z(),
              is_low(side) ? box->low_m()[axis] : box->high_m()[axis],
              is_low(side) ? 1.0 : -1.0,
              held.size() == 2};
}

BodyModes beam_modes(const BodySpec& body) {
  const std::optional<Beam> beam = beam_of(body);
  if (!beam) {
    throw ModelError{fmt::format("a beam is {}", beam_requirements)};
  }
  if (body.orthotropy) {
    throw ModelError{beams_are_isotropic};
  }
  const double radius_of_gyration_m = beam->thickness_m / std::sqrt(12.0);
  std::vector<double> roots;
  std::vector<double> kappas;
  while (true) {
    const double next = root(roots.size() + 1, beam->is_held_at_both_ends);
    const double kappa = next * next * radius_of_gyration_m / (beam->length_m * beam->length_m);
    if (kappa >= body.band_limit_rad_per_m) {
      break;
    }
    if (roots.size() == max_modes) {
      throw ModelError{
          fmt::format("the beam has more than {} modes below band_limit_hz", max_modes)};
    }
    roots.push_back(next);
    kappas.push_back(kappa);
  }
  BodyModes modes;
  modes.kappa_rad_per_m =
      Eigen::Map<const Eigen::ArrayXd>(kappas.data(), static_cast<Eigen::Index>(kappas.size()));
  modes.band_limit_rad_per_m = body.band_limit_rad_per_m;
  const Box& box = std::get<Box>(body.shape);
  set_touched_face(box, *beam, modes);
  set_shapes(box, *beam, roots, modes);
  modes.report.counted_in_band = static_cast<int>(roots.size());
  return modes;
}
}  // namespace tapstudy::core
