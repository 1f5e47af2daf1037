#include "results/rows.hpp"

#include "results/store_error.hpp"
namespace tapstudy::results {
std::string to_text(Mode mode) {
  switch (mode) {
    case Mode::real:
      return "real";
    case Mode::pilot:
      return "pilot";
    case Mode::simulated:
      return "simulated";
  }
  return "";
}

Mode mode_from(const std::string& text) {
  for (const Mode mode : {Mode::real, Mode::pilot, Mode::simulated}) {
    if (to_text(mode) == text) {
      return mode;
    }
  }
  throw StoreError{"session.mode: '" + text + "' is none of real, pilot, simulated"};
}
}  // namespace tapstudy::results
