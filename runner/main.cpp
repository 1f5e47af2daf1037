#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <system_error>

#include "core/algebra/blas.hpp"
#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "core/process/bounded_child.hpp"
#include "device/device.hpp"
#include "results/store_error.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/process_exit.hpp"
namespace {
using tapstudy::runner::ExitCode;

ExitCode code_of(const std::exception& error) {
  if (dynamic_cast<const tapstudy::core::ModelError*>(&error) != nullptr) {
    return ExitCode::model_failed;
  }
  if (dynamic_cast<const tapstudy::device::DeviceError*>(&error) != nullptr) {
    return ExitCode::device_failed;
  }
  if (dynamic_cast<const tapstudy::results::StoreError*>(&error) != nullptr ||
      dynamic_cast<const tapstudy::core::WritingFailed*>(&error) != nullptr) {
    return ExitCode::store_failed;
  }
  if (dynamic_cast<const tapstudy::runner::Stopped*>(&error) != nullptr) {
    return ExitCode::stopped;
  }
  const bool is_of_input = dynamic_cast<const tapstudy::core::Error*>(&error) != nullptr ||
                           dynamic_cast<const std::system_error*>(&error) != nullptr;
  return is_of_input ? ExitCode::wrong_input : ExitCode::internal_error;
}
// Not by errno: much may have happened since the write that failed.
bool has_reader_gone() {
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  return poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

// Detects output that did not reach its file or pipe.
void check_results_arrived() {
  std::cout.flush();
  if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw tapstudy::results::StoreError{
        has_reader_gone() ? "standard output: the reader closed the pipe"
                          : "standard output: writing failed (is the disk full?)"};
  }
}
// Else a file or a socket opened later would take the place of a closed one, and be written to.
void open_standard_descriptors() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the way of the C library
    if (fcntl(descriptor, F_GETFD) < 0) {
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg)
      static_cast<void>(open("/dev/null", descriptor == 0 ? O_RDONLY : O_WRONLY));
    }
  }
}

// A file that may grow no further, and a reader that has gone, are errors of writing, not the end.
void survive_failed_writing() {
  for (const int signal : {SIGXFSZ, SIGPIPE}) {
    struct sigaction ignored {};
    ignored.sa_handler = SIG_IGN;
    sigaction(signal, &ignored, nullptr);
  }
}
}  // namespace

int main(int argc, char** argv) {
  tapstudy::core::serve_if_child(argc, argv);
  open_standard_descriptors();
  survive_failed_writing();
  tapstudy::core::use_one_blas_thread();
  try {
    tapstudy::runner::set_up_logging();
    const ExitCode code = tapstudy::runner::run_command_line(argc, argv);
    check_results_arrived();
    return static_cast<int>(code);
  } catch (const std::exception& error) {
    const bool lacks_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
    // where standard error is closed, nothing more can be done
    std::fputs(lacks_memory ? "not enough memory" : error.what(), stderr);
    std::fputs("\n", stderr);
    return static_cast<int>(code_of(error));
  }
}
