#include "support/built_paths.hpp"
namespace tapstudy::testing {
std::string source_directory() {
  return TAPSTUDY_SOURCE_DIR;
}
std::string tapstudy_program() {
  return TAPSTUDY_PROGRAM;
}
std::string bridge_program() {
  return TAPSTUDY_BRIDGE;
}
std::string serial_board_program() {
  return TAPSTUDY_SERIAL_BOARD;
}
std::string dhd_program() {
  return TAPSTUDY_DHD;
}
std::string openhaptics_program() {
  return TAPSTUDY_OPENHAPTICS;
}
std::string inverse3_program() {
  return TAPSTUDY_INVERSE3;
}
std::string lab_program() {
  return TAPSTUDY_LAB;
}
std::string stalling_player_program() {
  return TAPSTUDY_STALLING_PLAYER;
}
std::string lsl_stand_in() {
  return TAPSTUDY_LSL;
}
}  // namespace tapstudy::testing
