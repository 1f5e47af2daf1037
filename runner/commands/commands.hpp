#pragma once
namespace CLI {
class App;
}
namespace tapstudy::runner {
// Each adds one command to the command line; the command runs when the line is parsed.
void add_check(CLI::App& app);
void add_run(CLI::App& app);
void add_simulate(CLI::App& app);
void add_report(CLI::App& app);
void add_modes(CLI::App& app);
void add_tap(CLI::App& app);
void add_trade(CLI::App& app);
}  // namespace tapstudy::runner
