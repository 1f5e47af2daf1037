#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
namespace tapstudy::core {
// Values as bytes for another process of this same program: neither portable nor for files.
class PackedBytes {
 public:
  template <class Values>
  void put(const Values& values) {
    using Value = std::remove_cv_t<std::remove_pointer_t<decltype(values.data())>>;
    static_assert(std::is_trivially_copyable_v<Value>);
    const auto count = static_cast<std::int64_t>(values.size());
    append(&count, sizeof count);
    append(values.data(), values.size() * sizeof(Value));
  }
  std::string take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t size) {
    if (size > 0) {
      bytes_.append(static_cast<const char*>(data), size);
    }
  }
  std::string bytes_;
};

// Reads them back in the same order. Throws std::out_of_range where they end too early.
class UnpackedBytes {
 public:
  explicit UnpackedBytes(const std::string& bytes) : bytes_{bytes} {}
  template <class Values>  // one with resize(), as std::vector and std::string
  Values get() {
    std::int64_t count = 0;
    copy(&count, sizeof count);
    Values values;
    if (count < 0 || static_cast<std::size_t>(count) > bytes_.size()) {
      throw std::out_of_range{"packed bytes"};
    }
    values.resize(static_cast<std::size_t>(count));
    copy(values.data(), values.size() * sizeof(*values.data()));
    return values;
  }

 private:
  void copy(void* to, std::size_t size) {
    if (size > bytes_.size() - at_) {
      throw std::out_of_range{"packed bytes"};
    }
    if (size > 0) {
      std::memcpy(to, bytes_.data() + at_, size);
    }
    at_ += size;
  }
  const std::string& bytes_;
  std::size_t at_{0};
};

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
