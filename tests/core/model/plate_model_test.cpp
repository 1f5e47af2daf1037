#include "core/model/plate_model.hpp"

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
using namespace tapstudy;
using core::build_plate_model;

namespace {
// Natural frequencies below 300 Hz of the paper's plate on the same TetGen switches, computed with
// SciPy (eigsh on independently assembled T4 matrices), to the nearest hertz.
struct Reference {
  const char* name;
  int corners;
  core::Material material;
  std::vector<int> hz;
};
}  // namespace

TEST_CASE("the paper's coarse plates have the natural frequencies that SciPy finds",
          "[core][model]") {
  const std::vector<Reference> references{
      {"MDF, two adjacent", 2, testing::mdf(), {58, 248}},
      {"MDF, three", 3, testing::mdf(), {159}},
      {"MDF, four", 4, testing::mdf(), {274}},
      {"acrylic, two adjacent", 2, testing::acrylic(), {48, 203, 256}},
      {"acrylic, three", 3, testing::acrylic(), {131, 295}},
      {"acrylic, four", 4, testing::acrylic(), {228}}};
  for (const Reference& reference : references) {
    INFO(reference.name);
    const auto plate =
        build_plate_model(testing::paper_plate(reference.corners, reference.material));
    CHECK(plate.body.modes.report.nodes == 172);
    std::vector<int> rounded;
    for (const double hz : plate.modal.frequency_hz) {
      rounded.push_back(static_cast<int>(std::lround(hz)));
    }
    CHECK(rounded == reference.hz);
    CHECK(plate.body.modes.report.worst_residual < 1e-8);
  }
}

TEST_CASE("a body that was solved up to a lower band is refused, not used with modes missing",
          "[core][model]") {
  core::PlateSpec plate = testing::paper_plate(2, testing::mdf());
  plate.band_limit_hz = 100.0;
  const core::BodyModes body = core::solve_body(core::body_of(plate)).modes;
  CHECK_NOTHROW(core::model_of(body, plate.material, 100.0));
  CHECK_THROWS_AS(core::model_of(body, plate.material, 300.0), core::ModelError);
  core::Material softer = plate.material;
  softer.youngs_modulus_pa *= 0.25;  // every frequency at half
  CHECK_THROWS_AS(core::model_of(body, softer, 100.0), core::ModelError);
  CHECK_NOTHROW(core::model_of(body, softer, 50.0));
}
