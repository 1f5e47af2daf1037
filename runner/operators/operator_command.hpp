#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "results/rows.hpp"
namespace tapstudy::runner {
// What an operator can do during a session. The names are typed, and stored.
enum class OperatorAction {
  pause,
  resume,
  repeat,
  skip,
  correct,
  switch_to,
  note,
  end,
  exclude,
  include
};
enum class ActionText { none, optional, required };
struct ActionInfo {
  OperatorAction action;
  std::string_view name;
  ActionText text;
  std::string_view help;
};
std::span<const ActionInfo> operator_actions();
std::string_view name(OperatorAction action);

struct OperatorCommand {
  OperatorAction action{};
  std::string text{};
  std::optional<int> trial{};  // that is meant; refused if it is over
  results::GivenBy by{results::GivenBy::operator_of_session};
};
// "note the participant coughed", or with the trial that is meant, "skip @4 the string broke".
// Throws InvalidInput naming what is allowed.
OperatorCommand parse_operator_command(const std::string& line,
                                       std::span<const OperatorAction> offered = {});
}  // namespace tapstudy::runner
