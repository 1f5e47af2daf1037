#pragma once
namespace tapstudy::core {
// A simulated hand: finger, grip and device as one mass driven through a muscle spring-damper.
struct HandBody {
  double mass_kg{0.1};
  double muscle_stiffness_n_per_m{400.0};
  double muscle_damping_n_s_per_m{9.0};
};
}  // namespace tapstudy::core
