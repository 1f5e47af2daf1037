#include "core/process/bounded_child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
namespace tapstudy::core {
namespace {
enum class Ended : char { result = 'r', model_error = 'm', invalid_input = 'i', other = 'o' };
constexpr std::array default_signals{SIGSEGV, SIGABRT, SIGBUS,  SIGFPE,
                                     SIGILL,  SIGXCPU, SIGALRM, SIGPIPE};
constexpr const char* child_name = "tapstudy-child";
const ChildJob* all_jobs = nullptr;
bool is_served = false;

// Memory of this process now; 0 if unknown.
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
}

std::string outcome_of(const ChildJob& job, const std::string& input) {
  const auto tagged = [](Ended ended, const std::string& bytes) {
    return static_cast<char>(ended) + bytes;
  };
  try {
    return tagged(Ended::result, job(input));
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

// Redirects standard output, so that what libraries print there does not become part of the result.
int redirect_output() {
  const int result = dup(STDOUT_FILENO);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);  // NOLINT: variadic in C
  dup2(nowhere, STDOUT_FILENO);
  return result;
}

// A file in memory: unlike a pipe, it needs no reader to take what is written.
int file_holding(const std::string& bytes) {
  const int file = memfd_create("input of a child", MFD_CLOEXEC);
  if (file >= 0 && (!write_all(file, bytes) || lseek(file, 0, SEEK_SET) != 0)) {
    close(file);
    return -1;
  }
  return file;
}

// 0 or the error's number, as posix_spawn.
int start(const ChildJob& job, const ChildLimits& limits, int input, int output, pid_t& child) {
  posix_spawn_file_actions_t files{};
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes{};
  posix_spawnattr_init(&attributes);
  sigset_t signals{};
  sigemptyset(&signals);
  posix_spawnattr_setsigmask(&attributes, &signals);
  for (const int signal : default_signals) {
    sigaddset(&signals, signal);
  }
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::array words{std::string{child_name}, std::string{job.name()},
                   std::to_string(limits.processor_s), std::to_string(limits.memory_bytes)};
  std::array<char*, 5> pointers{words[0].data(), words[1].data(), words[2].data(), words[3].data()};
  const int error =
      posix_spawn(&child, "/proc/self/exe", &files, &attributes, pointers.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return error;
}

const char* reason(int signal) {
  switch (signal) {
    case SIGXCPU:
    case SIGALRM:
    case SIGKILL:
      return "it took too long, or too much memory";
    default:
      return "the helper process crashed on this input";
  }
}

// The child's output; throws ModelError if there is no whole one.
std::string output_of(const ChildJob& job, const std::string& input, const std::string& what,
                      const ChildLimits& limits) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw ModelError{what + ": cannot create a pipe"};
  }
  const int given = file_holding(input);
  pid_t child = 0;
  const bool is_started = given >= 0 && start(job, limits, given, ends[1], child) == 0;
  close(ends[1]);
  if (given >= 0) {
    close(given);
  }
  std::string output = is_started ? all_from(ends[0]) : std::string{};
  close(ends[0]);
  if (!is_started) {
    throw ModelError{what + ": cannot start a process"};
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status) || output.empty()) {
    throw ModelError{
        fmt::format("{}: {}", what, reason(WIFSIGNALED(status) ? WTERMSIG(status) : 0))};
  }
  return output;
}
}  // namespace

ChildJob::ChildJob(const char* name, Act act) noexcept : name_{name}, act_{act}, next_{all_jobs} {
  all_jobs = this;
}

const ChildJob* ChildJob::find(const std::string& name) {
  const ChildJob* job = all_jobs;
  while (job != nullptr && name != job->name_) {
    job = job->next_;
  }
  return job;
}

std::string in_bounded_child(const ChildJob& job, const std::string& input, const std::string& what,
                             const ChildLimits& limits) {
  if (!is_served) {
    throw std::logic_error{"main() does not begin with serve_if_child()"};
  }
  const std::string output = output_of(job, input, what, limits);
  const std::string bytes = output.substr(1);
  switch (static_cast<Ended>(output.front())) {
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

void serve_if_child(int count, char** words) {
  is_served = true;
  if (count != 4 || words[0] != std::string{child_name}) {
    return;
  }
  const ChildJob* const job = ChildJob::find(words[1]);
  if (job == nullptr) {
    _exit(1);
  }
  const int result = redirect_output();
  restrict_this_process({std::atoi(words[2]), std::strtoull(words[3], nullptr, 10)});
  write_all(result, outcome_of(*job, all_from(STDIN_FILENO)));
  _exit(0);
}
}  // namespace tapstudy::core
