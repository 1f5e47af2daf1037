#pragma once
#include <string>
namespace CLI {
class App;
class Validator;
}  // namespace CLI
namespace tapstudy::runner {
// Each adds one command to the command line; the command runs when the line is parsed.
void add_check(CLI::App& app);
void add_run(CLI::App& app);
void add_simulate(CLI::App& app);
void add_report(CLI::App& app);
void add_modes(CLI::App& app);
void add_tap(CLI::App& app);
void add_trade(CLI::App& app);
void add_devices(CLI::App& app);
void add_doctor(CLI::App& app);
void add_calibrate(CLI::App& app);

// A file's name must say what the file will hold.
CLI::Validator ends_in(const std::string& suffix);
// A number from low to high; what is no number is not.
CLI::Validator within(double low, double high);
}  // namespace tapstudy::runner
