#include "core/techniques/technique.hpp"

#include "support/catch.hpp"
using namespace tapstudy::core;

// Two springs in series beside a third.
TEST_CASE("a coupled finger adds its spring, in series with the pad, to a slow press",
          "[core][technique]") {
  RenderSettings settings;
  settings.penalty_stiffness_n_per_m = 3000.0;
  settings.finger.stiffness_n_per_m = 300.0;
  for (const char* const name : {"fem-coupled", "fem-coupled+sinusoid"}) {
    CHECK(find_technique(name)->added_stiffness_n_per_m(settings) ==
          Approx(1.0 / (1.0 / 3000.0 + 1.0 / 300.0)));
  }
  for (const char* const name : {"none", "sinusoid", "fem", "fem+sinusoid"}) {
    CHECK(find_technique(name)->added_stiffness_n_per_m(settings) == 0.0);
  }
}
