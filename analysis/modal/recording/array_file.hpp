#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "analysis/modal/recording/recording.hpp"
namespace tapstudy::analysis {
inline constexpr std::size_t max_array_values = 100'000'000;

// A real matrix of numbers in a file that holds several.
struct NamedArray {
  std::string name;  // "acc"; within a structure or group "hammer.acc" or "hammer/acc"
  std::size_t rows{};
  std::size_t columns{};
  std::size_t size() const { return rows * columns; }
  bool is_vector() const { return rows == 1 || columns == 1; }
  std::size_t channels() const { return std::min(rows, columns); }
};

struct ArrayFile {
  std::string path;
  char separator{};  // between the name of a structure and that of an array in it
  std::vector<NamedArray> arrays;
  std::string not_searched;  // in words: what of the file is not among the arrays
  std::function<std::vector<double>(const NamedArray&)> read;  // column after column
};

// A vector, or of a matrix one channel along its longer side ("acc:2"). The rate is that of a
// vector of as many times (time_unit_of its name), or of a scalar of one of the usual names
// of a rate (fs, rate, sampling_rate_hz ...) or an interval (dt, sample_interval ...) in seconds:
// the nearest in the structures around the array, else the only one there is. Throws InvalidInput
// as read_recording says.
Recording recording_in(const ArrayFile& file, const ReadingOptions& options);
}  // namespace tapstudy::analysis
