#pragma once
#include <string>
namespace tapstudy::testing {
// Where the sources are, and the programs that were built with these tests. Only built_paths.cpp
// depends on it, so that a compiler cache serves every checkout.
std::string source_directory();
std::string tapstudy_program();
std::string bridge_program();
std::string serial_board_program();
std::string dhd_program();
std::string openhaptics_program();
std::string inverse3_program();
std::string lab_program();
std::string stalling_player_program();
std::string lsl_stand_in();
}  // namespace tapstudy::testing
