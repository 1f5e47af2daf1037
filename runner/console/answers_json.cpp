#include "runner/console/answers_json.hpp"

#include <array>
#include <nlohmann/json.hpp>
namespace tapstudy::runner {
nlohmann::ordered_json answers_json(const protocols::Answers& answers) {
  using Json = nlohmann::ordered_json;
  constexpr std::array kinds{"option", "number", "setting", "order", "line"};
  Json labels = Json::array();
  for (const protocols::Option& option : answers.options) {
    labels.push_back(option.label);
  }
  return {{"kind", kinds.at(static_cast<std::size_t>(answers.kind))},
          {"options", labels},
          {"settings", answers.settings},
          {"low", answers.ends.low},
          {"high", answers.ends.high},
          {"modulus", answers.modulus ? Json(*answers.modulus) : Json{}}};
}
}  // namespace tapstudy::runner
