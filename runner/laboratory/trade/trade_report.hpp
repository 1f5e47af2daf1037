#pragma once
#include <ostream>
#include <string>

#include "analysis/report/figures/figure.hpp"
#include "runner/laboratory/trade/stability.hpp"
#include "runner/laboratory/trade/trade.hpp"
namespace tapstudy::runner {
// Prints to stdout the reference, the front, the protocol's own setting, the cheapest one inside
// the tolerance, and the extremes. `directory` is where all settings were written, or empty.
void print(const Trade& trade, const Stability& stability, const std::string& directory);

std::string json_of(const Trade& trade, const Stability& stability);

void write_csv(std::ostream& out, const Trade& trade);
void write_csv(std::ostream& out, const Stability& stability);
// Error over cost of every setting: of the force with the front, of the worst frequency with the
// tolerance.
analysis::Figure figure_of(const Trade& trade);

// Creates the directory, so that output errors are found before the computation. Throws
// InvalidInput if it cannot be created or one of the files below already exists.
void create_trade_directory(const std::string& directory);

// trade.csv, trade.json, trade.svg and stability.csv. Throws InvalidInput if one exists already or
// cannot be written.
void write_files(const std::string& directory, const Trade& trade, const Stability& stability);
}  // namespace tapstudy::runner
