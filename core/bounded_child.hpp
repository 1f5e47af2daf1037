#pragma once
#include <cstddef>
#include <string>
namespace tapstudy::core {
struct ChildLimits {
  int processor_s{60};
  std::size_t memory_bytes{4'000'000'000};  // more than the process has when it starts
};

// Foreign code that may crash or hang on bad input: bytes to bytes. An object at namespace scope,
// so that the process that is started for it finds it by its name.
class ChildJob {
 public:
  using Act = std::string (*)(const std::string& input);
  ChildJob(const char* name, Act act) noexcept;
  const char* name() const { return name_; }
  static const ChildJob* find(const std::string& name);
  std::string operator()(const std::string& input) const { return act_(input); }

 private:
  const char* name_;
  Act act_;
  const ChildJob* next_;
};

// Runs `job` in a process of its own, with limits on time and memory, and returns the bytes that it
// made; an Error that it throws arrives here as the same type. Throws ModelError, beginning with
// `what`, if the process was killed, whatever it was killed by.
// The process is this program started anew: a fork of one with several threads could wait for ever
// for a lock that another thread held.
std::string in_bounded_child(const ChildJob& job, const std::string& input, const std::string& what,
                             const ChildLimits& limits = {});

// First in main() of every program that uses the above; does not return in a child.
void serve_if_child(int count, char** words);
}  // namespace tapstudy::core
