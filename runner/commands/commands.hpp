#pragma once
#include "runner/commands/command_parser.hpp"
namespace tapstudy::runner {
// Each adds one command to the command line.
void add_check(CommandParser& line);
void add_run(CommandParser& line);
void add_simulate(CommandParser& line);
void add_report(CommandParser& line);
void add_export(CommandParser& line);
void add_amend(CommandParser& line);
void add_redact(CommandParser& line);
void add_verify(CommandParser& line);
void add_modes(CommandParser& line);
void add_tap(CommandParser& line);
void add_trade(CommandParser& line);
void add_reproduce(CommandParser& line);
void add_identify(CommandParser& line);
void add_devices(CommandParser& line);
void add_doctor(CommandParser& line);
void add_calibrate(CommandParser& line);
}  // namespace tapstudy::runner
