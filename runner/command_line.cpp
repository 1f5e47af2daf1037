#include "runner/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/error.hpp"
#include "runner/build_info.hpp"
#include "runner/commands/commands.hpp"
namespace tapstudy::runner {
namespace {
// An empty value, from an unset variable in a script, is not the same as no value.
void refuse_empty_values(CLI::App& app) {
  const CLI::Validator not_empty{[](const std::string& value) {
                                   return value.empty() ? std::string{"must not be empty"}
                                                        : std::string{};
                                 },
                                 ""};
  for (CLI::App* const command : app.get_subcommands({})) {
    for (CLI::Option* const option : command->get_options()) {
      if (option->get_items_expected_max() > 0) {
        option->check(not_empty);
      }
    }
  }
}
}  // namespace

CLI::Validator ends_in(const std::string& suffix) {
  return {[suffix](const std::string& name) {
            return name.ends_with(suffix) ? std::string{} : "must end in " + suffix;
          },
          ""};
}

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

ExitCode carry_out(int argc, const char* const* argv) {
  CLI::App app{"User studies of tapped virtual objects, from a YAML protocol to the report.",
               "tapstudy"};
  app.require_subcommand(1);
  app.set_version_flag("--version", fmt::format("tapstudy {} ({})", program_version(), git_hash()));
  add_check(app);
  add_run(app);
  add_simulate(app);
  add_report(app);
  add_modes(app);
  add_tap(app);
  add_trade(app);
  add_devices(app);
  add_doctor(app);
  add_calibrate(app);
  refuse_empty_values(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked_for_help) {
    return static_cast<ExitCode>(app.exit(asked_for_help));
  } catch (const CLI::ParseError& error) {
    throw core::InvalidInput{fmt::format("{} (tapstudy --help says more)", error.what())};
  }
  return ExitCode::done;
}
}  // namespace tapstudy::runner
