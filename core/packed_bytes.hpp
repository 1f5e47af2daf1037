#pragma once
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
}  // namespace tapstudy::core
