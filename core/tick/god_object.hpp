#pragma once
#include <array>
#include <optional>

#include "core/tick/contact.hpp"
namespace tapstudy::core {
// The upper face of a plate, in the plate frame: z = 0, |x| and |y| within these.
struct PlateFace {
  double half_x_m{};
  double half_y_m{};
};

// The god-object (Zilles & Salisbury 1995) on a flat plate's upper face: where the haptic
// interaction point would be if it could not penetrate.
//
// Contact begins when the tip crosses the face downwards and ends when it rises above it or slides
// over the edge. A tip found below the face without having crossed it (the first reading, or a
// finger coming from the side) is not in contact, which avoids a sudden force.
//
// Contact chatter does not retrigger impacts: after an impact the next one is armed only once the
// tip has been higher than release_height_m.
class PlateContact {
 public:
  PlateContact(const PlateFace& face, double release_height_m) noexcept
      : face_{face}, release_height_m_{release_height_m} {}
  const Contact& tick(const HandState& tip) noexcept;
  const Contact& now() const noexcept { return contact_; }
  ContactHistory history() const noexcept { return history_; }
  // Takes over the contact history of the previous renderer.
  void continue_from(const ContactHistory& history) noexcept;

 private:
  PlateFace face_;
  double release_height_m_;
  Contact contact_;
  ContactHistory history_;
};

// The god-object (Zilles & Salisbury 1995) on any closed surface: where the haptic interaction
// point would be if it could not penetrate. In every tick it moves towards the tip; each triangle
// it hits becomes a constraint plane, up to three at once (a face, a concave edge, a concave
// corner), and it moves on to the nearest point that satisfies them. At convex edges constraints
// that end there are released.
//
// The force is shaded: its direction and depth, and the place that is felt, are those of the tip's
// foot on the smooth surface that the triangles stand for (SmoothNormals). So they change
// continuously from facet to facet, and only across edges sharper than
// SmoothNormals::sharp_above_rad abruptly. The depth is that below the facets, whose slope turns at
// an edge by the angle between them: sliding at v, the force steps there by stiffness × v dt × that
// angle, whatever its magnitude (0.04 N, 0.4 % of 10 N and 4 % of 1 N, at 0.1 m/s, 1 kHz and 3000
// N/m on a sphere of 1280 triangles; a finer mesh has smaller steps). The god-object itself stays
// on the facets. On flat faces, in sharp concave edges, and deeper than the radius of curvature the
// force is that of the god-object.
//
// A tip found inside without having entered (the first reading) is not in contact. Contact chatter
// does not retrigger impacts: see PlateContact.
class SurfaceContact {
 public:
  SurfaceContact(const TriangleTree& tree, double release_height_m) noexcept;
  const Contact& tick(const HandState& tip) noexcept;
  const Contact& now() const noexcept { return contact_; }
  ContactHistory history() const noexcept { return history_; }
  void continue_from(const ContactHistory& history) noexcept;

 private:
  struct Plane {
    Vec3 normal;
    double offset{0.0};  // points p with normal . p >= offset are allowed
    int triangle{TriangleTree::none};
  };
  struct Planes {
    std::array<Plane, 3> held;
    std::size_t count{0};
  };
  Planes move_towards(const Vec3& tip_m) noexcept;
  Planes slide_towards(const Vec3& tip_m) noexcept;
  Plane plane_of(int triangle) const noexcept;
  bool allow(const Planes& planes, const Vec3& point_m) const noexcept;
  std::optional<Vec3> nearest_allowed(const Planes& planes, const Vec3& wanted_m) const noexcept;
  static std::optional<Vec3> nearest_on(const Planes& planes, unsigned choice,
                                        const Vec3& wanted_m) noexcept;
  void shade(const Planes& planes, const Vec3& tip_m) noexcept;
  void describe(const Planes& planes, const HandState& tip) noexcept;

  const TriangleTree* tree_;
  double release_height_m_;
  double skin_m_;  // clearance of the god-object, against penetration by rounding
  Vec3 god_object_m_{Vec3::Zero()};
  Contact contact_;
  ContactHistory history_;
};
}  // namespace tapstudy::core
