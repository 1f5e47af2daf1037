#include "runner/commands/shared_options.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/typed_input.hpp"
namespace tapstudy::runner {
std::uint64_t seed_from(const std::string& text, const std::string& option) {
  const auto seed = core::number_in<std::uint64_t>(text);
  if (!seed) {
    throw core::InvalidInput{
        fmt::format("{}: '{}' is not a whole number from 0 to 2^64 - 1", option, text)};
  }
  return *seed;
}

int planned_participants(const std::string& given, const protocols::Protocol& protocol) {
  constexpr int usual = 10;
  if (given.empty()) {
    return protocol.participants.value_or(usual);
  }
  const auto number = whole_number(given, 1, protocols::max_participants);
  if (!number) {
    throw core::InvalidInput{fmt::format("--participants: {} is not allowed (from 1 to {})", given,
                                         protocols::max_participants)};
  }
  return *number;
}

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
