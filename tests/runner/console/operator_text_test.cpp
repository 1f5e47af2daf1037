#include "runner/console/operator_text.hpp"

#include "support/catch.hpp"

using namespace tapstudy;

namespace {
runner::DeskView desk_with(const protocols::Block& block) {
  runner::DeskView desk;
  runner::TrialInView view;
  view.trial.number = 3;
  view.trial.block = block.name;
  view.trial.alternatives = {{"mdf_two"}, {"acrylic_two"}};
  view.prompt.number = 3;
  view.prompt.total = 8;
  view.prompt.block = &block;
  view.prompt.alternative_labels = {"A", "B"};
  view.attempt = 2;
  desk.trial = view;
  desk.current = 1;
  desk.last_answer = runner::AnswerInView{view.trial, {}, "mdf_two"};
  desk.last_answer->trial.number = 2;
  desk.force = runner::ForceState::on;
  return desk;
}

std::string status(bool is_blind) {
  protocols::Block block;
  block.name = "control";
  runner::SessionInView session;
  session.participant_id = "P01";
  session.mode = "pilot";
  session.device = "simulated hand";
  session.is_blind = is_blind;
  session.state = "exploring";
  session.has_participant_page = true;
  session.masking = runner::MaskingInView{true, -20.0, 3};
  return runner::status_text(session, desk_with(block), {12345, 2, 4});
}
}  // namespace

TEST_CASE("the operator's terminal says what the operator's page shows", "[runner][console]") {
  const std::string text = status(false);
  for (const char* part : {"P01 (pilot), exploring", "trial 3 of 8, 'control', attempt 2",
                           "A mdf_two; B acrylic_two (felt)", "last answer: trial 2, mdf_two",
                           "contacts: 4", "late ticks: 2 of 12345", "simulated hand: force on",
                           "masking noise: playing, -20.0 dB FS, 3 underruns"}) {
    CHECK_THAT(text, Contains(part));
  }
}

TEST_CASE("a blind operator's terminal names no stimulus", "[runner][console]") {
  CHECK_THAT(status(true), Contains("presented: A; B (felt)"));
  CHECK_THAT(status(true), !Contains("mdf") && !Contains("acrylic"));
}

TEST_CASE("a live line has the extremes of its steps in newtons, millimetres and milliseconds",
          "[runner][console]") {
  runner::LiveView::Steps steps;
  for (int i = 0; i < 100; ++i) {
    core::Vec3 lowest_m = core::Vec3::Zero();
    lowest_m[core::normal_axis] = i == 99 ? 0.099 : 0.101;
    steps.steps.push_back({i == 50 ? 3.0 : 1.0, lowest_m, i == 7 ? 0.004 : 0.001});
  }
  const std::string line = runner::live_line(steps, {0, 1, 2}, 0.1);
  CHECK_THAT(line, Contains("▁▁▁▁▁▁▁▁▁▁▁▁█▁▁▁▁▁▁▁▁▁▁▁▁ up to 3.00 N"));
  CHECK_THAT(line, Contains("-1.0 to 1.0 mm, contacts 2, late 1, longest interval 4.0 ms"));
  CHECK_THAT(runner::live_line({}, {}, 0.0), Contains("at rest"));
}
