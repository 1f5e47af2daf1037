#include "runner/accuracy/hand_on_plate.hpp"

#include "core/techniques/make_renderer.hpp"
#include "core/tick/tap_renderer.hpp"
#include "device/hand/penalty_limit.hpp"
#include "support/catch.hpp"
using namespace tapstudy;

TEST_CASE("a hand rests on a wall softer than its limit and chatters on a stiffer one",
          "[runner][stability]") {
  const core::HandBody hand;
  core::RenderSettings settings;
  const double limit = device::largest_stable_penalty_n_per_m(hand, settings.dt_s);
  for (const double part : {0.5, 0.95, 1.05, 2.0}) {
    settings.penalty_stiffness_n_per_m = part * limit;
    core::TapRenderer renderer = core::make_renderer(*core::find_technique("none"), settings,
                                                     core::PlateFace{0.3, 0.3}, nullptr);
    const auto seen = runner::tap_and_stay(renderer, hand, settings.dt_s, {});
    CAPTURE(part, seen.residual_oscillation);
    CHECK((seen.residual_oscillation > 0.1) == (part > 1.0));
  }
}
