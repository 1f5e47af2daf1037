// The modes of an acrylic plate screwed down at its corners, and the force on a finger that taps
// it:
//   cmake -B build && cmake --build build && build/tap_a_plate
// or, with pkg-config instead of CMake:
//   c++ -std=c++20 tap_a_plate.cpp $(pkg-config --cflags --libs tapstudy-core)
#include <cstdio>

#include "core/model/plate_model.hpp"
#include "core/process/bounded_child.hpp"
#include "core/techniques/technique.hpp"

using namespace tapstudy::core;

int main(int argc, char** argv) {
  serve_if_child(argc, argv);  // TetGen meshes in a process of its own, which is this program

  PlateSpec plate;
  plate.shape = Box{{0.6, 0.6, 0.02}};  // m
  plate.mesh.order = 2;
  plate.material = {3.2e9, 1180.0, 0.35, RayleighDamping{120.0, 8.5e-5}};
  plate.band_limit_hz = 300.0;
  for (const double x : {-0.27, 0.27}) {
    for (const double y : {-0.27, 0.27}) {
      Fixation screw;
      screw.shape = RegionShape::disc;
      screw.at_m = {x, y, 0.0};
      screw.radius_m = 0.01;
      plate.fixations.push_back(screw);
    }
  }
  const VibratingPlate vibrating{build_plate_model(plate).modal};
  for (const double hz : vibrating.model.frequency_hz) {
    std::printf("mode %8.2f Hz\n", hz);
  }

  RenderSettings settings;  // 1 kHz, contact spring of 3000 N/m
  TapRenderer renderer =
      make_renderer(natural_vibration(), settings, PlateFace{0.3, 0.3}, &vibrating);
  const Vec3 velocity_m_s{0.0, 0.0, -0.3};
  for (HandState finger{{0.05, 0.02, 0.003}, velocity_m_s}; finger.position_m.z() > -0.003;
       finger.position_m += settings.dt_s * velocity_m_s) {
    const RenderedTick tick = renderer.tick(finger);
    std::printf("z %7.4f m  contact spring %6.3f N  vibration %7.4f N\n", finger.position_m.z(),
                tick.parts.penalty_n, tick.parts.vibration_n);
  }
}
