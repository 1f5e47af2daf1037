#pragma once
#include <complex>
#include <string>
#include <vector>
namespace tapstudy::analysis {
// Function types of a data set 58.
inline constexpr int time_response = 1;
inline constexpr int auto_spectrum = 2;
inline constexpr int cross_spectrum = 3;
inline constexpr int frequency_response = 4;
inline constexpr int coherence = 6;

// One function of a data set 58 or 58b, whose layout the University of Cincinnati documents.
struct DataSet58 {
  int line{};  // of the file, of its number
  int function_type{};
  std::string response;   // node and direction, "12+Z"; empty: not stated
  std::string reference;  // likewise
  int value_type{};       // 2 and 4: real, single and double; 5 and 6: complex
  std::size_t values{};
  bool is_even{};
  double first{};      // abscissa
  double increment{};  // likewise
  // Specific data types: 8 displacement, 11 velocity, 12 acceleration, 13 excitation force ...
  int numerator{};
  int denominator{};
  std::string unit;             // of the ordinate, "g"; empty or "NONE": not stated
  std::vector<double> samples;  // real values at even steps, of function type 1 alone
  std::vector<std::complex<double>> complex_samples;  // likewise, of function type 4
};

// All data sets 58 and 58b of a universal file, text or bytes of either order. Throws InvalidInput,
// with file and line: unreadable, a record without one of its numbers, data cut off.
std::vector<DataSet58> read_data_sets_58(const std::string& file);
}  // namespace tapstudy::analysis
