#include "runner/commands/axis_settings.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/number_in.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
protocols::AxisValues parsed(const std::vector<std::string>& settings) {
  protocols::AxisValues values;
  for (const std::string& setting : settings) {
    const auto sign = setting.find('=');
    const std::string name = setting.substr(0, sign);
    const auto value =
        core::number_in<double>(sign == std::string::npos ? "" : setting.substr(sign + 1));
    if (name.empty() || !value) {
      throw core::InvalidInput{fmt::format("--set: '{}' is not NAME=NUMBER", setting)};
    }
    if (!values.emplace(name, *value).second) {
      throw core::InvalidInput{fmt::format("--set: '{}' is set twice", name)};
    }
  }
  return values;
}
}  // namespace

protocols::PresentedStimulus member_set_to(const std::vector<std::string>& settings,
                                           const protocols::Protocol& protocol,
                                           const protocols::Stimulus& stimulus) {
  const protocols::AxisValues asked = parsed(settings);
  try {
    const protocols::PresentedStimulus member = stimulus_at(protocol, stimulus, asked);
    for (const auto& [name, value] : asked) {
      if (member.values.at(name) != value) {
        warn(fmt::format("{} is presented at {}, the nearest value of its table to {}", name,
                         member.values.at(name), value));
      }
    }
    return member;
  } catch (const core::InvalidInput& error) {
    throw core::InvalidInput{fmt::format("--set: {}", error.what())};
  }
}
}  // namespace tapstudy::runner
