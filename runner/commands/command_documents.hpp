#pragma once
#include <string>
#include <vector>
namespace tapstudy::runner {
// What the definitions of a command line say of themselves.
struct OptionDefinition {
  std::vector<std::string> names;    // "--json"; none: a positional argument
  std::string value;                 // the name of what it takes; empty: a flag
  std::vector<std::string> choices;  // empty: anything
  std::string help;
  std::string default_value;
  bool is_required{};
  bool is_repeatable{};
};
struct CommandDefinition {
  std::string name;
  std::string help;
  std::vector<OptionDefinition> options;
};
struct ProgramDefinition {
  std::string name;
  std::string help;
  std::string version;
  std::vector<CommandDefinition> commands;
};

// The manual page tapstudy.1 and completion for bash (tapstudy.bash) and zsh (_tapstudy), in an
// existing directory. Throws InvalidInput if one cannot be written.
void write_command_documents(const ProgramDefinition& program, const std::string& directory);
}  // namespace tapstudy::runner
