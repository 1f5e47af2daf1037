// A study whose protocol asks for the repair of a surface: what it keeps of that, and says.
#include <fmt/format.h>

#include <filesystem>

#include "core/error.hpp"
#include "core/model/shape/shape.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "results/store/store.hpp"
#include "runner/commands/check_models.hpp"
#include "runner/session/engine/open_study.hpp"
#include "runner/studies/simulated_study.hpp"
#include "runner/studies/stored_study.hpp"
#include "runner/studies/study_summary.hpp"
#include "runner/studies/study_verification.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
constexpr const char* study_text = R"(format: tapstudy/1
title: One body
finger: {mass_kg: 0.058, stiffness_n_per_m: 300, damping_n_s_per_m: 3}
rendering: {rate_hz: 1000, band_limit_hz: 300, penalty_stiffness_n_per_m: 3000}
placement: {origin_m: [0, 0, 0], lateral_scale: 1}
materials:
  rubber: {youngs_modulus_pa: 2.0e7, density_kg_per_m3: 610, poissons_ratio: 0.25, damping: {ratio: 0.02}}
plates:
  body:
    surface: {file: body.off, metres_per_unit: 0.001, repair: {largest_hole_m: 2}}
    fixations: []
tapping_points_m: {middle: [0, 0]}
stimuli:
  one: {plate: body, material: rubber, technique: none}
  other: {plate: body, material: rubber, technique: none}
blocks:
  - {name: main, task: identification, question: "Which?", stimuli: [one, other], order: listed, explore: {min_contacts: 0}}
)";

// A tetrahedron without its bottom.
std::string open_tetrahedron(int deep_mm) {
  return fmt::format(
      "OFF\n4 3 0\n200 0 -{0}\n-100 173 -{0}\n-100 -173 -{0}\n0 0 0\n3 0 1 3\n3 1 2 3\n3 2 0 3\n",
      deep_mm);
}
// 1/3 of base times height.
constexpr double tetrahedron_m3 = 0.3 * 0.346 / 2.0 * 0.1 / 3.0;

struct Files {
  testing::TempDirectory directory;
  std::string protocol = directory / "study.yaml";
  std::string study = directory / "study";
  Files() {
    testing::write(protocol, study_text);
    testing::write(directory / "body.off", open_tetrahedron(100));
  }
  protocols::Protocol read() const { return protocols::read_protocol(protocol); }
};

double stored_volume_m3(results::Store& store) {
  return core::volume_m3(
      std::get<core::Solid>(runner::stored_protocol(store).plates.at("body")->shape).surface());
}
}  // namespace

TEST_CASE("a repaired surface is told, stored with its study, and stands in the report",
          "[runner][surface]") {
  const Files files;
  const protocols::Protocol protocol = files.read();
  REQUIRE(protocol.surfaces.size() == 2);
  const std::string& name = protocol.surfaces[1].file;
  CHECK_THAT(name, Contains("body.off repaired (") && Contains("largest_hole_m 2"));
  CHECK_THAT(runner::describe_surfaces(protocol),
             Contains(name) && Contains("holes filled: 1") && Contains("before: none"));
  runner::simulate({files.protocol, files.study, 1, 3, false}, protocol);
  std::filesystem::remove(files.directory / "body.off");
  results::Store store = results::Store::open_existing(files.study);
  CHECK(stored_volume_m3(store) == Approx(tetrahedron_m3).epsilon(1e-9));
  CHECK(runner::stored_protocol(store).surfaces[1].changes == protocol.surfaces[1].changes);
  CHECK(runner::verification_of(store, files.study).is_sound());
  const auto summary = runner::summary_of_study({{files.study, &store}}, results::Mode::simulated);
  const auto row = std::ranges::find(summary.provenance, "surface " + name,
                                     &std::pair<std::string, std::string>::first);
  REQUIRE(row != summary.provenance.end());
  CHECK_THAT(row->second, Contains("holes filled: 1") && Contains("largest distance"));
}

TEST_CASE("a study goes on with the repair and the surface that it began with only",
          "[runner][surface]") {
  const Files files;
  runner::simulate({files.protocol, files.study, 1, 3, false}, files.read());
  CHECK_NOTHROW(runner::open_study(files.study, files.read(), files.protocol));
  testing::write(files.protocol,
                 testing::replaced(study_text, "{largest_hole_m: 2}", "{largest_hole_m: 3}"));
  CHECK_THROWS_WITH(runner::open_study(files.study, files.read(), files.protocol),
                    Contains("differs in plates.body.surface.repair.largest_hole_m ("));
  testing::write(files.protocol, study_text);
  testing::write(files.directory / "body.off", open_tetrahedron(110));
  CHECK_THROWS_WITH(runner::open_study(files.study, files.read(), files.protocol),
                    Contains("'body.off' is not the file that the study began with"));
  // the same file, of which another program or version makes another surface
  testing::write(files.directory / "body.off", open_tetrahedron(100));
  protocols::Protocol otherwise = files.read();
  otherwise.surfaces[1].sha256 = "another";
  CHECK_THROWS_WITH(runner::open_study(files.study, otherwise, files.protocol),
                    Contains("repaired (") && Contains("is not the file"));
}
