#include "runner/commands/command_documents.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "core/files/output_files.hpp"
namespace tapstudy::runner {
namespace {
std::string replaced(std::string text, char from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, 1, to);
  }
  return text;
}

// A hyphen that is typed is written \- in a manual page; a line must not begin with a dot or a
// quote, which would be a request.
std::string in_roff(const std::string& text) {
  const std::string escaped = replaced(replaced(text, '\\', "\\e"), '-', "\\-");
  return escaped.starts_with('.') || escaped.starts_with('\'') ? "\\&" + escaped : escaped;
}

std::string described(const OptionDefinition& option) {
  std::string text = option.help;
  if (!option.choices.empty()) {
    text += fmt::format("\nOne of: {}.", fmt::join(option.choices, ", "));
  }
  if (!option.default_value.empty()) {
    text += fmt::format("\nDefault: {}.", option.default_value);
  }
  if (option.is_repeatable && !option.names.empty()) {
    text += "\nMay be given several times.";
  }
  return text;
}

std::string command_synopsis(const CommandDefinition& command) {
  std::string text = in_roff(command.name);
  bool has_optional = false;
  for (const OptionDefinition& option : command.options) {
    const std::string value = fmt::format("\\fI{}\\fR", in_roff(option.value));
    if (option.names.empty()) {
      const std::string argument = value + (option.is_repeatable ? " ..." : "");
      text += option.is_required ? ' ' + argument : fmt::format(" [{}]", argument);
    } else if (option.is_required) {
      text += fmt::format(" {} {}", in_roff(option.names.front()), value);
    } else {
      has_optional = true;
    }
  }
  return text + (has_optional ? " [\\fIOPTION\\fR ...]" : "");
}

std::string tag_of(const OptionDefinition& option) {
  std::string tag;
  if (!option.names.empty()) {
    tag = fmt::format("\\fB{}\\fR", in_roff(fmt::format("{}", fmt::join(option.names, ", "))));
  }
  if (!option.value.empty()) {
    tag += fmt::format("{}\\fI{}\\fR", tag.empty() ? "" : " ", in_roff(option.value));
  }
  return tag;
}

std::string manual_page(const ProgramDefinition& program) {
  std::string text = fmt::format(
      ".TH {0} 1 \"\" \"{1}\"\n.SH NAME\n{0} \\- {2}\n.SH SYNOPSIS\n.B {0}\n\\fICOMMAND\\fR "
      "[\\fIARGUMENT\\fR ...]\n.SH COMMANDS\n",
      program.name, in_roff(program.version), in_roff(program.help));
  for (const CommandDefinition& command : program.commands) {
    text += fmt::format(".SS {} {}\n{}.\n", program.name, command_synopsis(command),
                        in_roff(command.help));
    for (const OptionDefinition& option : command.options) {
      text += fmt::format(".TP\n{}\n{}\n", tag_of(option), in_roff(described(option)));
    }
  }
  return text;
}

std::vector<std::string> command_names(const ProgramDefinition& program) {
  std::vector<std::string> names;
  for (const CommandDefinition& command : program.commands) {
    names.push_back(command.name);
  }
  return names;
}

std::string bash_completion(const ProgramDefinition& program) {
  std::string options;
  std::string values;
  for (const CommandDefinition& command : program.commands) {
    std::vector<std::string> names;
    for (const OptionDefinition& option : command.options) {
      names.insert(names.end(), option.names.begin(), option.names.end());
      for (const std::string& name : option.names) {
        if (!option.choices.empty()) {
          values += fmt::format("    '{} {}') words='{}' ;;\n", command.name, name,
                                fmt::join(option.choices, " "));
        }
      }
    }
    options += fmt::format("    '{}') words='{}' ;;\n", command.name, fmt::join(names, " "));
  }
  return fmt::format(
      R"(# bash completion of {0}, made from its own definitions
_{0}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} words=""
  case "${{COMP_WORDS[1]}} ${{COMP_WORDS[COMP_CWORD-1]}}" in
{1}  esac
  if [ "$COMP_CWORD" -eq 1 ]; then
    words='{2} --help --version'
  elif [[ $word == -* ]]; then
    case ${{COMP_WORDS[1]}} in
{3}    esac
  fi
  if [ -n "$words" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}}
complete -F _{0} {0}
)",
      program.name, values, fmt::join(command_names(program), " "), options);
}

// One specification of _arguments, inside single quotes.
std::string zsh_specification(const OptionDefinition& option, const std::string& name) {
  std::string help = replaced(replaced(option.help, '[', "\\["), ']', "\\]");
  help = replaced(replaced(help, '\'', "'\\''"), ':', "\\:");
  const std::string action =
      option.choices.empty() ? "_files" : fmt::format("({})", fmt::join(option.choices, " "));
  if (option.names.empty()) {
    return fmt::format("'{}:{}:{}'", option.is_repeatable ? "*" : "", option.value, action);
  }
  return fmt::format("'{}{}[{}]{}'", option.is_repeatable ? "*" : "", name, help,
                     option.value.empty() ? "" : fmt::format(":{}:{}", option.value, action));
}

std::string zsh_completion(const ProgramDefinition& program) {
  std::string commands;
  std::string options;
  for (const CommandDefinition& command : program.commands) {
    commands += fmt::format("    '{}:{}'\n", command.name, replaced(command.help, '\'', "'\\''"));
    options += fmt::format("    {})\n      _arguments", command.name);
    for (const OptionDefinition& option : command.options) {
      for (const std::string& name : option.names) {
        options += " \\\n        " + zsh_specification(option, name);
      }
      if (option.names.empty()) {
        options += " \\\n        " + zsh_specification(option, {});
      }
    }
    options += "\n      ;;\n";
  }
  return fmt::format(
      R"(#compdef {0}
# zsh completion of {0}, made from its own definitions
_{0}() {{
  local -a commands=(
{1}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{2}  esac
}}
_{0} "$@"
)",
      program.name, commands, options);
}
}  // namespace

void write_command_documents(const ProgramDefinition& program, const std::string& directory) {
  const std::filesystem::path folder{directory};
  core::write_all_or_none({{folder / (program.name + ".1"), manual_page(program)},
                           {folder / (program.name + ".bash"), bash_completion(program)},
                           {folder / ("_" + program.name), zsh_completion(program)}},
                          core::Existing::replaced);
}
}  // namespace tapstudy::runner
