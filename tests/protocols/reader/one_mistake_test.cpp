// One mistake in a protocol is one problem: nothing that only follows from it is told.
#include <algorithm>

#include "core/error.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::replaced;

namespace {
const char* const study = R"(format: tapstudy/1
title: Taps
finger: {mass_kg: 0.058, stiffness_n_per_m: 300, damping_n_s_per_m: 3}
rendering: {rate_hz: 1000, penalty_stiffness_n_per_m: 3000, band_limit_hz: 300}
placement: {origin_m: [0, 0, 0], lateral_scale: 0.1}
materials:
  light: {youngs_modulus_pa: 3.2e9, density_kg_per_m3: 1180, poissons_ratio: 0.35, damping: {alpha_per_s: 120, beta_s: 8.5e-5}}
  heavy: {youngs_modulus_pa: 2.5e9, density_kg_per_m3: 2000, poissons_ratio: 0.25, damping: {ratio: 0.02}}
plates:
  two: {size_m: [0.6, 0.6, 0.05], mesh: {order: 1}, fixations: [{region: vertex, at_m: [-0.3, -0.3]}, {region: vertex, at_m: [0.3, -0.3]}]}
tapping_points_m: {P1: [0.0, 0.0]}
stimuli:
  one: {plate: two, material: light, technique: fem, factors: {material: light, technique: fem}}
  other: {plate: two, material: heavy, technique: none, factors: {material: heavy, technique: none}}
blocks:
  - {name: which, task: identification, question: "Which?", stimuli: [one, other], repetitions: 3, keys: [f, j]}
  - {name: how, task: rating, question: "How?", stimuli: [one, other], steps: 5, low: low, high: high}
hypotheses:
  - {name: h, statement: s, block: how, claim: rated_highest, stimulus: one}
simulation: {observer: {reference: one}}
sessions: [{name: d1, blocks: [which, how]}, {name: d2, blocks: [which]}]
)";

std::string answer_to(const std::string& text) {
  try {
    protocols::parse_protocol(text, "study.yaml");
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}
}  // namespace

TEST_CASE("one mistake in a protocol is one problem", "[protocols][problems]") {
  REQUIRE(answer_to(study) == "accepted");
  struct Mistake {
    const char* from;
    const char* to;
    const char* said;
  };
  const auto [from, to, said] = GENERATE(values<Mistake>({
      // numbers
      {"mass_kg: 0.058", "mass_kg: 0,058", "finger.mass_kg: 0,058 is not a number (decimals take"},
      {"lateral_scale: 0.1", "lateral_scale: 1,5", "lateral_scale: 1,5 is not a number"},
      {"rate_hz: 1000", "rate_hz: 1000 Hz",
       "rate_hz: '1000 Hz' is not a number (the number stands alone, in the "},
      {"rate_hz: 1000", "rate_hz: 1kHz", "in the unit that the key states)"},
      {"size_m: [0.6, 0.6, 0.05]", "size_m: [60cm, 0.6, 0.05]", "size_m[0]: '60cm' is not a num"},
      {"steps: 5", "steps: five", "blocks[1].steps: 'five' is not a whole number"},
      {"repetitions: 3", "repetitions: 3x", "blocks[0].repetitions: '3x' is not a whole number"},
      {"repetitions: 3", "repetitions: 0b10",
       "blocks[0].repetitions: '0b10' is not a whole number (from 1 to 1000)"},
      {"repetitions: 3", "explore: {min_contacts: 30, max_seconds: 1}",
       "explore.max_seconds: is too short: nobody taps 30 times in 1 s"},
      // keys
      {"plate: two, material: heavy,", "<<: {plate: two}, material: heavy,",
       "stimuli.other.<<: merges of mappings (<<) are not read"},
      {"stimuli:\n", "stimuli:\n  <<: {more: {plate: two}}\n",
       "stimuli: merges of mappings (<<) are not read"},
      {"\"How?\"", "' '", "blocks[1].question: ' ' holds nothing but blanks"},
      {"steps: 5, low: low", "steps: 5, low: {en: low, ja: \u3000}",
       "blocks[1].low.ja: '\u3000' holds nothing but blanks"},
      {"keys: [f, j]", "keys: [f, J]", "blocks[0].keys[1]: 'J' is not a known letter (one of"},
      {"blocks:\n", "block:\n", "block: is not a known key"},
      {"task: identification", "tusk: identification", "tusk: is not a known key"},
      {"steps: 5, low: low", "steps: 5, lov: low", "lov: is not a known key"},
      {"plates:\n", "plate:\n", "plate: is not a known key"},
      {"damping: {alpha_per_s", "damping: {ratio: 0.1, alpha_per_s",
       "damping.alpha_per_s: stands beside ratio: one of them says it"},
      {"keys: [f, j]", "keys: [f, f]", "blocks[0].keys[1]: 'f' is listed twice"},
      {"task: rating, question", "task: rating, practice: true, question",
       "hypotheses[0].block: is practice, which no report tests"},
      {"hypotheses:\n",
       "forms_before: [f]\nforms: {f: {title: F, items: [{name: a, kind: single_choice, question: "
       "Q, "
       "options: [x, ' X']}]}}\nhypotheses:\n",
       "options: the answers 'x' and ' X' have the same label"},
      {"hypotheses:\n",
       "forms_before: [f]\nforms: {f: {title: F, items: [{name: a, kind: single_choice, question: "
       "Q, "
       "options: [x, y], ends_session: [y, x]}]}}\nhypotheses:\n",
       "ends_session: names every answer: nobody could take part"},
      // words that decide which keys there are
      {"task: rating", "task: ratting", "blocks[1].task: 'ratting' is not a known task"},
      {"claim: rated_highest", "claim: rated_best", "hypotheses[0].claim: 'rated_best' is not"},
      // names that other sections have
      {"d1, blocks: [which, how]", "d1, blocks: [which]", "block 'how' is in none of them"},
      {"blocks: [which, how]", "blocks: [which, hov]", "sessions[0].blocks[1]: 'hov' is not"},
      {"claim: rated_highest, stimulus: one", "claim: interaction, factors: [material, shape]",
       "hypotheses[0].factors[1]: 'shape' is not a known factor"},
      {"stimuli: [one, other], repetitions", "stimuli: [onne, other], repetitions",
       "blocks[0].stimuli[0]: 'onne' is not a known stimulus"},
  }));
  const std::string answer = answer_to(replaced(study, from, to));
  CAPTURE(to, answer);
  CHECK_THAT(answer, Contains(said));
  CHECK_THAT(answer, !Contains("write "));
  CHECK(std::count(answer.begin(), answer.end(), '\n') == 0);
}

TEST_CASE("a name that is used in several places is not known in each of them, and no more",
          "[protocols][problems]") {
  const std::string answer = answer_to(replaced(study, "\n  one: {", "\n  won: {"));
  CAPTURE(answer);
  CHECK(std::count(answer.begin(), answer.end(), '\n') == 3);
  CHECK_THAT(answer, Contains("blocks[0].stimuli[0]: 'one' is not a known stimulus") &&
                         Contains("blocks[1].stimuli[0]: 'one'") &&
                         Contains("observer.reference: 'one'") &&
                         Contains("hypotheses[0].stimulus: 'one'"));
}

TEST_CASE("mistakes that have nothing to do with one another are told together",
          "[protocols][problems]") {
  const std::string answer =
      answer_to(replaced(replaced(replaced(replaced(study, "mass_kg: 0.058", "mass_kg: 0,058"),
                                           "task: rating", "task: ratting"),
                                  "lateral_scale", "latteral_scale"),
                         "band_limit_hz: 300", "band_limit_hz: 600"));
  CAPTURE(answer);
  CHECK_THAT(answer, Contains("finger.mass_kg") && Contains("blocks[1].task") &&
                         Contains("placement.latteral_scale") &&
                         Contains("band_limit_hz: is not below half of rate_hz"));
}
