#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runner/commands/command_documents.hpp"
#include "runner/terminal/process_exit.hpp"
namespace CLI {  // NOLINT(readability-identifier-naming): as the library calls itself
class App;
}  // namespace CLI
namespace tapstudy::runner {
enum class Need { required, optional };

// One command: its arguments and options are described once and bound to variables, which must
// outlive the parsing. Hides CLI11, whose header adds seconds to each compilation.
class Command {
 public:
  void argument(const std::string& name, std::string& value, const std::string& help,
                Need need = Need::required);
  // All remaining arguments.
  void arguments(const std::string& name, std::vector<std::string>& values,
                 const std::string& help);
  void option(const std::string& name, std::string& value, const std::string& help,
              Need need = Need::optional);
  // A file, or where there is none of that name the one that is installed with the program.
  // Required if it is positional.
  void shipped_file(const std::string& name, std::string& value, const std::string& help);
  // "--name" alone sets `alone`, "--name VALUE" the value.
  void option_with_or_without_value(const std::string& name, std::string& value,
                                    const std::string& alone, const std::string& help);
  // An option that may be given several times, with one value each.
  void repeatable(const std::string& name, std::vector<std::string>& values,
                  const std::string& help);
  // An option with one or more values after it.
  void list(const std::string& name, std::vector<std::string>& values, const std::string& help);
  // Help shows the default.
  void option_with_default(const std::string& name, std::string& value, const std::string& help);
  void option_with_default(const std::string& name, int& value, const std::string& help);
  void number(const std::string& name, double& value, const std::string& help);
  void number_within(const std::string& name, double& value, double low, double high,
                     const std::string& help);
  // A file name that must have the given extension.
  void file(const std::string& name, std::string& value, const std::string& ending,
            const std::string& help, Need need = Need::optional);
  // Required if it is positional.
  void one_of(const std::string& name, std::string& value, const std::vector<std::string>& allowed,
              const std::string& help);
  void flag(const std::string& name, bool& value, const std::string& help);
  // Sets the action to run after parsing.
  void on_run(std::function<void()> run);

 private:
  friend class CommandParser;
  explicit Command(CLI::App& app) : app_{&app} {}
  CLI::App* app_;
};

class CommandParser {
 public:
  CommandParser(const std::string& description, const std::string& name,
                const std::string& version);
  ~CommandParser();
  CommandParser(const CommandParser& other) = delete;
  CommandParser& operator=(const CommandParser& other) = delete;
  CommandParser(CommandParser&& other) = delete;
  CommandParser& operator=(CommandParser&& other) = delete;

  Command add(const std::string& name, const std::string& help);
  // Runs the command given. Throws InvalidInput for an invalid command line, and whatever the
  // command throws.
  ExitCode parse(int argc, const char* const* argv);
  ProgramDefinition definition() const;

 private:
  std::unique_ptr<CLI::App> app_;
  std::string version_;
};

// Each adds one command to the command line.
void add_check(CommandParser& line);
void add_run(CommandParser& line);
void add_simulate(CommandParser& line);
void add_merge(CommandParser& line);
void add_report(CommandParser& line);
void add_push(CommandParser& line);
void add_pull(CommandParser& line);
void add_schedule(CommandParser& line);
void add_export(CommandParser& line);
void add_amend(CommandParser& line);
void add_redact(CommandParser& line);
void add_repair(CommandParser& line);
void add_verify(CommandParser& line);
void add_modes(CommandParser& line);
void add_tap(CommandParser& line);
void add_trade(CommandParser& line);
void add_reproduce(CommandParser& line);
void add_identify(CommandParser& line);
void add_devices(CommandParser& line);
void add_doctor(CommandParser& line);
void add_calibrate(CommandParser& line);
void add_calibrate_actuator(CommandParser& line);
void add_schema(CommandParser& line);

// Parses and runs one command line. Throws what the command throws.
ExitCode run_command_line(int argc, const char* const* argv);
}  // namespace tapstudy::runner
