#pragma once
#include "core/model/plate_model.hpp"
namespace tapstudy::testing {
// The paper's Table 1 and Figure 2.
inline core::Material mdf() {
  return {2.5e9, 610.0, 0.25, core::RayleighDamping{120.0, 7.05e-5}};
}
inline core::Material acrylic() {
  return {3.2e9, 1180.0, 0.35, core::RayleighDamping{120.0, 8.5e-5}};
}
inline core::Fixation corner_vertex(double sign_x, double sign_y) {
  core::Fixation fixation;
  fixation.at_m = {0.3 * sign_x, 0.3 * sign_y, 0.0};
  return fixation;
}
inline core::PlateSpec paper_plate(int corners, const core::Material& material) {
  const std::vector<core::Fixation> all{corner_vertex(-1, -1), corner_vertex(1, -1),
                                        corner_vertex(1, 1), corner_vertex(-1, 1)};
  return {{core::Box{{0.6, 0.6, 0.05}}, {}, {all.begin(), all.begin() + corners}}, material, 300.0};
}
}  // namespace tapstudy::testing
