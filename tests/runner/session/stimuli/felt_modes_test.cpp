// Which modes a tap excites, and which accuracy a study asks of its meshes.
#include "runner/session/stimuli/felt_modes.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "core/tick/modal_state.hpp"
#include "runner/laboratory/reproduce/paper_protocols.hpp"
#include "runner/session/stimuli/mesh_accuracy.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "support/catch.hpp"
using namespace tapstudy;

namespace {
protocols::PresentedStimulus tapped_at(const Eigen::Vector2d& at_m,
                                       const protocols::Protocol& protocol) {
  auto stimulus = stimulus_with(protocol, protocol.stimulus("aluminium"));
  protocols::Plate plate = *stimulus.plate;
  plate.tapping_points_m = {{"P", at_m}};
  stimulus.plate = std::make_shared<const protocols::Plate>(plate);
  return stimulus;
}

// The largest force that each mode alone, undamped, gives the finger after an impact there.
Eigen::ArrayXd forces_after_impact(const core::VibratingPlate& plate, const Eigen::Vector2d& at_m,
                                   const core::Finger& finger) {
  Eigen::ArrayXd largest = Eigen::ArrayXd::Zero(plate.model.frequency_hz.size());
  for (Eigen::Index i = 0; i < largest.size(); ++i) {
    core::ModalModel alone = plate.model;
    alone.frequency_hz = plate.model.frequency_hz.segment(i, 1).eval();
    alone.damping_ratio = Eigen::ArrayXd::Zero(1);
    alone.shape = plate.model.shape.col(i).eval();
    constexpr int ticks = 400;
    core::ModalState state{alone, core::Integrator::exact, 2.0 / (ticks * alone.frequency_hz[0])};
    state.touch(plate.locator->locate(at_m.x(), at_m.y()), core::Vec3::UnitZ());
    state.strike(-0.01);
    for (int tick = 0; tick < ticks; ++tick) {
      state.tick();
      largest[i] = std::max(largest[i], std::abs(finger.stiffness_n_per_m * state.displacement_m() +
                                                 finger.damping_n_s_per_m * state.velocity_m_s()));
    }
  }
  return largest;
}
}  // namespace

TEST_CASE("modes are left out that after an impact stay below the level of the strongest",
          "[runner][stimuli][felt_modes]") {
  protocols::Protocol protocol = runner::shipped_protocol("protocols/paper/plate_model.yaml");
  protocol.band_limit_hz = 2500.0;
  runner::ModelLibrary models{core::ModelCache{"", ""}, core::ErrorEstimation::none};
  const Eigen::Vector2d at_m{0.0, 0.0};
  const auto stimulus = tapped_at(at_m, protocol);
  const auto whole = models.plate_of(protocol, stimulus);
  const Eigen::ArrayXd force = forces_after_impact(*whole, at_m, stimulus.rendering.finger);
  protocol.drop_modes = protocols::DroppedModes{25.0, 0.0};
  const auto unfelt = runner::unfelt_modes(*whole, stimulus, *protocol.drop_modes);
  const core::ModalModel rendered = models.plate_of(protocol, stimulus)->model;
  REQUIRE(!unfelt.empty());
  std::size_t next = 0;
  Eigen::Index kept = 0;
  for (Eigen::Index i = 0; i < force.size(); ++i) {
    const double level_db = 20.0 * std::log10(force[i] / force.maxCoeff());
    CAPTURE(i, level_db);
    if (level_db < -25.0) {
      REQUIRE(next < unfelt.size());
      CHECK(unfelt[next].frequency_hz == whole->model.frequency_hz[i]);
      CHECK(unfelt[next++].level_db == Approx(level_db).margin(0.1));
    } else {
      REQUIRE(kept < rendered.frequency_hz.size());
      CHECK(rendered.damping_ratio[kept] == whole->model.damping_ratio[i]);
      CHECK(rendered.shape.col(kept++) == whole->model.shape.col(i));
    }
  }
  CHECK(next == unfelt.size());
  CHECK(kept == rendered.frequency_hz.size());
  const auto around = runner::unfelt_modes(*whole, stimulus, {25.0, 0.1});
  CHECK(around.size() < unfelt.size());
  CHECK(runner::describe({{143.2, -92.3}, {211.0, -HUGE_VAL}}) ==
        "143.2 Hz (-92 dB), 211 Hz (below -200 dB)");
}

TEST_CASE("an automatic mesh is asked for a tenth of the smallest difference that it could spoil",
          "[runner][stimuli][mesh_accuracy]") {
  const protocols::Protocol protocol =
      runner::shipped_protocol("protocols/recommended/forces.yaml");
  const double four_screws = GENERATE(1.05, 1.0001, 3.0);
  const auto find = [&](const protocols::PresentedStimulus& stimulus, double accuracy) {
    CHECK(accuracy == core::usual_accuracy);
    core::BodyModes body;
    const double unit = core::kappa_rad_per_m(1.0, *stimulus.material);
    // mdf at 100 Hz, the others far apart
    const double hz = stimulus.name.starts_with("mdf")       ? 100.0
                      : stimulus.name.starts_with("acrylic") ? 10.0
                                                             : 1.0;
    const bool has_four = stimulus.name.ends_with("four");
    body.kappa_rad_per_m = Eigen::ArrayXd::Constant(1, unit * hz * (has_four ? four_screws : 1.0));
    return std::make_shared<const core::BodyModes>(std::move(body));
  };
  const auto mesh = runner::automatic_mesh(protocol, find);
  REQUIRE((mesh && mesh->difference));
  CHECK(mesh->difference->relative ==
        Approx(four_screws > 2.0 ? 1.0 - 1.0 / 3.0 : 1.0 - 1.0 / four_screws));
  CHECK(mesh->accuracy == Approx(std::clamp(0.1 * mesh->difference->relative,
                                            runner::least_accuracy, core::usual_accuracy)));
  const auto none = [](const protocols::PresentedStimulus&, double) {
    return std::shared_ptr<const core::BodyModes>{};
  };
  CHECK(!runner::automatic_mesh(protocol, none));
}

TEST_CASE(
    "an automatic mesh is asked for the usual accuracy of one body, which is not solved for it",
    "[runner][stimuli][mesh_accuracy]") {
  protocols::Protocol protocol = runner::shipped_protocol("protocols/recommended/forces.yaml");
  const auto plate = protocol.stimuli.front().plate;
  std::erase_if(protocol.stimuli, [&](const auto& stimulus) { return stimulus.plate != plate; });
  REQUIRE(protocol.stimuli.size() > 1);
  int asked = 0;
  const auto find = [&](const protocols::PresentedStimulus&, double) {
    ++asked;
    return std::shared_ptr<const core::BodyModes>{};
  };
  const auto mesh = runner::automatic_mesh(protocol, find);
  CHECK(asked == 0);
  REQUIRE(mesh);
  CHECK(mesh->accuracy == core::usual_accuracy);
  CHECK(!mesh->difference);
}
