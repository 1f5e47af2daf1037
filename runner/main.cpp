#include <fmt/format.h>

#include <exception>

#include "core/error.hpp"
#include "device/device.hpp"
#include "results/store_error.hpp"
#include "runner/command_line.hpp"
#include "runner/exit_code.hpp"
#include "runner/logging.hpp"
namespace {
using tapstudy::runner::ExitCode;

ExitCode code_of(const std::exception& error) {
  if (dynamic_cast<const tapstudy::core::ModelError*>(&error) != nullptr) {
    return ExitCode::model_failed;
  }
  if (dynamic_cast<const tapstudy::device::DeviceError*>(&error) != nullptr) {
    return ExitCode::device_failed;
  }
  if (dynamic_cast<const tapstudy::results::StoreError*>(&error) != nullptr) {
    return ExitCode::store_failed;
  }
  if (dynamic_cast<const tapstudy::runner::Stopped*>(&error) != nullptr) {
    return ExitCode::stopped;
  }
  return ExitCode::wrong_input;
}
}  // namespace

int main(int argc, char** argv) {
  try {
    tapstudy::runner::set_up_logging();
    return static_cast<int>(tapstudy::runner::carry_out(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return static_cast<int>(code_of(error));
  }
}
