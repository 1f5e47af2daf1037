#include "runner/commands/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "protocols/yaml/problems.hpp"
#include "runner/build_info/build_info.hpp"
#include "runner/commands/key_reference.hpp"
namespace tapstudy::runner {
namespace {
// Rejects empty values, e.g. from an unset variable in a script.
void refuse_empty_values(CLI::App& app) {
  const CLI::Validator not_empty{[](const std::string& value) {
                                   return value.empty() ? std::string{"must not be empty"}
                                                        : std::string{};
                                 },
                                 ""};
  for (CLI::App* const command : app.get_subcommands({})) {
    for (CLI::Option* const option : command->get_options()) {
      if (option->get_items_expected_min() > 0) {
        option->check(not_empty);
      }
    }
  }
}

CLI::Validator ends_in(const std::string& ending) {
  return {[ending](const std::string& name) {
            return name.ends_with(ending) ? std::string{} : "must end in " + ending;
          },
          ""};
}

// The installed program stands in bin, what it ships in share/tapstudy beside it.
std::string file_or_shipped(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  const fs::path shipped = program.parent_path().parent_path() / "share/tapstudy" / name;
  return !fs::exists(name, none) && fs::is_regular_file(shipped, none) ? shipped.string() : name;
}

// Also rejects NaN, which separate comparisons with each bound would accept.
CLI::Validator within(double low, double high) {
  return {[low, high](const std::string& text) {
            double value = 0.0;
            const bool is_number = CLI::detail::lexical_cast(text, value);
            return is_number && value >= low && value <= high
                       ? std::string{}
                       : fmt::format("{} is not allowed (from {} to {})", text, low, high);
          },
          ""};
}
}  // namespace

void Command::argument(const std::string& name, std::string& value, const std::string& help,
                       Need need) {
  app_->add_option(name, value, help)->required(need == Need::required);
}

void Command::arguments(const std::string& name, std::vector<std::string>& values,
                        const std::string& help) {
  app_->add_option(name, values, help);
}

void Command::option(const std::string& name, std::string& value, const std::string& help,
                     Need need) {
  app_->add_option(name, value, help)->required(need == Need::required);
}

void Command::shipped_file(const std::string& name, std::string& value, const std::string& help) {
  app_->add_option(name, value, help)->required(!name.starts_with('-'))->transform(file_or_shipped);
}

void Command::option_with_or_without_value(const std::string& name, std::string& value,
                                           const std::string& alone, const std::string& help) {
  app_->add_option_function<std::vector<std::string>>(
          name,
          [&value, alone](const std::vector<std::string>& values) {
            const bool is_alone = values.empty() || values.front().empty();
            value = is_alone ? alone : values.front();
          },
          help)
      ->expected(0, 1);
}

void Command::repeatable(const std::string& name, std::vector<std::string>& values,
                         const std::string& help) {
  app_->add_option(name, values, help)->allow_extra_args(false);
}

void Command::list(const std::string& name, std::vector<std::string>& values,
                   const std::string& help) {
  app_->add_option(name, values, help);
}

void Command::option_with_default(const std::string& name, std::string& value,
                                  const std::string& help) {
  app_->add_option(name, value, help)->capture_default_str();
}

void Command::option_with_default(const std::string& name, int& value, const std::string& help) {
  app_->add_option(name, value, help)->capture_default_str();
}

void Command::number(const std::string& name, double& value, const std::string& help) {
  app_->add_option(name, value, help);
}

void Command::number_within(const std::string& name, double& value, double low, double high,
                            const std::string& help) {
  app_->add_option(name, value, help)->check(within(low, high))->capture_default_str();
}

void Command::file(const std::string& name, std::string& value, const std::string& ending,
                   const std::string& help, Need need) {
  app_->add_option(name, value, help)->required(need == Need::required)->check(ends_in(ending));
}

void Command::one_of(const std::string& name, std::string& value,
                     const std::vector<std::string>& allowed, const std::string& help) {
  app_->add_option(name, value, help)
      ->required(!name.starts_with('-'))
      ->check(CLI::IsMember(allowed));
}

void Command::flag(const std::string& name, bool& value, const std::string& help) {
  app_->add_flag(name, value, help);
}

void Command::on_run(std::function<void()> run) {
  app_->callback(std::move(run));
}

CommandParser::CommandParser(const std::string& description, const std::string& name,
                             const std::string& version)
    : app_{std::make_unique<CLI::App>(description, name)}, version_{version} {
  app_->require_subcommand(1);
  app_->set_version_flag("--version", version);
}

CommandParser::~CommandParser() = default;

Command CommandParser::add(const std::string& name, const std::string& help) {
  return Command{*app_->add_subcommand(name, help)};
}

namespace {
// CLI11 only says that a command is missing.
void check_command(const CLI::App& app, int argc, const char* const* argv) {
  if (argc < 2 || std::string_view{argv[1]}.starts_with('-')) {
    return;
  }
  std::vector<std::string> commands;
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(command->get_name());
  }
  const std::string given = argv[1];
  if (std::ranges::find(commands, given) == commands.end()) {
    throw core::InvalidInput{fmt::format("'{}' is not a command (one of: {}{})", given,
                                         fmt::join(commands, ", "),
                                         protocols::did_you_mean(given, commands))};
  }
}
}  // namespace

namespace {
// CLI11 keeps the members of a set only as a part of the type's name: "TEXT:{csv,hdf5}".
std::vector<std::string> choices_in(const std::string& type) {
  const auto open = type.find('{');
  const auto close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) {
    return {};
  }
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

OptionDefinition definition_of(const CLI::Option& option) {
  OptionDefinition definition;
  for (const std::string& name : option.get_snames()) {
    definition.names.push_back("-" + name);
  }
  for (const std::string& name : option.get_lnames()) {
    definition.names.push_back("--" + name);
  }
  const std::string type = option.get_type_name();
  if (option.get_positional()) {
    definition.value = option.get_name(true);
  } else if (option.get_items_expected_max() > 0) {
    definition.value = type.substr(0, type.find(':'));
  }
  definition.choices = choices_in(type);
  definition.help = option.get_description();
  definition.default_value = option.get_default_str();
  definition.is_required = option.get_required();
  definition.is_repeatable = option.get_items_expected_max() > 1;
  return definition;
}
}  // namespace

ProgramDefinition CommandParser::definition() const {
  ProgramDefinition program{app_->get_name(), app_->get_description(), version_, {}};
  for (const CLI::App* const command :
       std::as_const(*app_).get_subcommands([](const CLI::App*) { return true; })) {
    CommandDefinition definition{command->get_name(), command->get_description(), {}};
    for (const CLI::Option* const option : command->get_options()) {
      definition.options.push_back(definition_of(*option));
    }
    program.commands.push_back(definition);
  }
  return program;
}

ExitCode CommandParser::parse(int argc, const char* const* argv) {
  refuse_empty_values(*app_);
  check_command(*app_, argc, argv);
  try {
    app_->parse(argc, argv);
  } catch (const CLI::Success& asked_for_help) {
    return static_cast<ExitCode>(app_->exit(asked_for_help));
  } catch (const CLI::ParseError& error) {
    const auto chosen = app_->get_subcommands();
    throw core::InvalidInput{
        fmt::format("{} (see tapstudy {}--help)", error.what(),
                    chosen.empty() ? std::string{} : chosen.front()->get_name() + " ")};
  }
  return ExitCode::done;
}

ExitCode run_command_line(int argc, const char* const* argv) {
  CommandParser line{"User studies of tapped virtual objects, from a YAML protocol to the report.",
                     "tapstudy", fmt::format("tapstudy {} ({})", program_version(), git_hash())};
  add_check(line);
  add_run(line);
  add_simulate(line);
  add_merge(line);
  add_report(line);
  add_push(line);
  add_pull(line);
  add_schedule(line);
  add_export(line);
  add_amend(line);
  add_redact(line);
  add_repair(line);
  add_verify(line);
  add_modes(line);
  add_tap(line);
  add_trade(line);
  add_reproduce(line);
  add_identify(line);
  add_devices(line);
  add_doctor(line);
  add_calibrate(line);
  add_calibrate_actuator(line);
  add_schema(line);
  if (argc == 3 && std::string_view{argv[1]} == "--documents") {  // for the build: not in --help
    write_command_documents(line.definition(), argv[2]);
    write_key_documents(argv[2]);
    return ExitCode::done;
  }
  return line.parse(argc, argv);
}
}  // namespace tapstudy::runner
