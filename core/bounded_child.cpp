#include "core/bounded_child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <new>

#include "core/error.hpp"
namespace tapstudy::core {
namespace {
enum class Ended : char { result = 'r', model_error = 'm', invalid_input = 'i', other = 'o' };

// Of this process now; 0 if unknown.
std::size_t memory_in_use_bytes() {
  std::size_t pages = 0;
  if (FILE* const file = std::fopen("/proc/self/statm", "re")) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg,cert-err34-c): 0 where it is not a number
    static_cast<void>(!std::fscanf(file, "%zu", &pages));
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void limit(int resource, std::size_t value) {
  const rlimit both{value, value};
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

void restrict_this_process(const ChildLimits& limits) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<std::size_t>(limits.processor_s));
  limit(RLIMIT_AS, memory_in_use_bytes() + limits.memory_bytes);
  alarm(static_cast<unsigned>(3 * limits.processor_s));  // one that waits uses no processor time
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGXCPU, SIGALRM, SIGPIPE}) {
    std::signal(signal, SIG_DFL);
  }
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);  // NOLINT: variadic in C
  dup2(nowhere, STDOUT_FILENO);                                 // the libraries' own messages
  dup2(nowhere, STDERR_FILENO);
}

std::string outcome_of(const std::function<std::string()>& act) {
  const auto tagged = [](Ended ended, const std::string& bytes) {
    return static_cast<char>(ended) + bytes;
  };
  try {
    return tagged(Ended::result, act());
  } catch (const ModelError& error) {
    return tagged(Ended::model_error, error.what());
  } catch (const InvalidInput& error) {
    return tagged(Ended::invalid_input, error.what());
  } catch (const std::bad_alloc&) {
    return tagged(Ended::other, "not enough memory");
  } catch (const std::exception& error) {
    return tagged(Ended::other, error.what());
  }
}

[[noreturn]] void run_child(int to_parent, const std::function<std::string()>& act,
                            const ChildLimits& limits) {
  restrict_this_process(limits);
  const std::string outcome = outcome_of(act);
  std::size_t written = 0;
  while (written < outcome.size()) {
    const ssize_t count = write(to_parent, outcome.data() + written, outcome.size() - written);
    if (count < 0) {
      break;
    }
    written += static_cast<std::size_t>(count);
  }
  _exit(0);
}

std::string all_from(int descriptor) {
  std::string all;
  std::array<char, 65536> bytes{};
  while (true) {
    const ssize_t count = read(descriptor, bytes.data(), bytes.size());
    if (count > 0) {
      all.append(bytes.data(), static_cast<std::size_t>(count));
    } else if (count == 0 || errno != EINTR) {
      return all;
    }
  }
}

const char* reason(int signal) {
  switch (signal) {
    case SIGXCPU:
    case SIGALRM:
    case SIGKILL:
      return "it took too long, or too much memory";
    default:
      return "the program that does it crashed on this input";
  }
}
}  // namespace

std::string in_bounded_child(const std::string& what, const std::function<std::string()>& act,
                             const ChildLimits& limits) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw ModelError{what + ": no pipe"};
  }
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    run_child(ends[1], act, limits);
  }
  close(ends[1]);
  const std::string outcome = child < 0 ? std::string{} : all_from(ends[0]);
  close(ends[0]);
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (child < 0 || WIFSIGNALED(status) || outcome.empty()) {
    throw ModelError{fmt::format(
        "{}: {}", what,
        child < 0 ? "no new process" : reason(WIFSIGNALED(status) ? WTERMSIG(status) : 0))};
  }
  const std::string bytes = outcome.substr(1);
  switch (static_cast<Ended>(outcome.front())) {
    case Ended::result:
      return bytes;
    case Ended::model_error:
      throw ModelError{bytes};
    case Ended::invalid_input:
      throw InvalidInput{bytes};
    default:
      throw ModelError{fmt::format("{}: {}", what, bytes)};
  }
}
}  // namespace tapstudy::core
