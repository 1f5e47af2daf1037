#pragma once
#include <ostream>
#include <string>

#include "runner/laboratory/reproduce/claims.hpp"
namespace tapstudy::runner {
// One self-contained page, and the same numbers for programs (reproduction.schema.json), without
// the figures. Neither computes anything.
void write_html(std::ostream& out, const Reproduction& reproduction);
void write_json(std::ostream& out, const Reproduction& reproduction);
// Prints every claim with its judgement to stdout.
void print(const Reproduction& reproduction);

// Creates the directory, so that output errors are found before the computation. Throws
// InvalidInput if it cannot be created or one of the files below already exists.
void create_reproduction_directory(const std::string& directory);
// reproduction.html and reproduction.json. Throws InvalidInput, and leaves neither, if one exists
// already or cannot be written.
void write_files(const std::string& directory, const Reproduction& reproduction);

// Words that every format shares.
inline constexpr const char* page_title = "The paper's claims, and what tapstudy gets";
inline constexpr const char* paper_title =
    "Haptic Rendering based on Finite Element Simulation of Vibration";
inline constexpr const char* introduction =
    "Each claim of \"Haptic Rendering based on Finite Element Simulation of Vibration\" is "
    "computed by the printed method and by the one that tapstudy recommends, where they differ. "
    "Below each claim are its numbers, and the command that shows them.";
inline constexpr const char* judging_rule =
    "A claim is true if it holds by every method, false if by none; else it depends on the method, "
    "or on an input that the paper does not give. It holds by a method if every measure keeps its "
    "limit. What repeats the paper's own numbers, or tells of this machine, has no limit and is "
    "only shown.";
inline constexpr const char* simulated_note =
    "What is said of people here is said of simulated observers, never of people.";
// The command line that makes the same again.
std::string command_of(const Reproduction& reproduction);
}  // namespace tapstudy::runner
