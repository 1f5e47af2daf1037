#include "runner/console/page_json.hpp"

#include <nlohmann/json.hpp>
namespace tapstudy::runner {
namespace {
const char* name(protocols::AnswerKind value) {
  using enum protocols::AnswerKind;
  switch (value) {
    case option:
      return "option";
    case number:
      return "number";
    case setting:
      return "setting";
    case order:
      return "order";
    case line:
      return "line";
  }
  return "";
}
}  // namespace

Json progress_json(const TrialProgress& progress) {
  return {{"done", progress.done},
          {"total", progress.total},
          {"is_practice", progress.is_practice},
          {"is_open_ended", progress.is_open_ended},
          {"elapsed_s", progress.elapsed_s},
          {"left_s", progress.left_s ? Json(*progress.left_s) : Json{}}};
}

Json answers_json(const protocols::Answers& answers) {
  Json labels = Json::array();
  for (const protocols::Option& option : answers.options) {
    labels.push_back(option.label);
  }
  return {{"kind", name(answers.kind)},
          {"options", labels},
          {"keys", answers.keys},
          {"settings", answers.settings},
          {"low", answers.ends.low},
          {"high", answers.ends.high},
          {"modulus", answers.modulus ? Json(*answers.modulus) : Json{}}};
}
}  // namespace tapstudy::runner
