#include "analysis/recordings/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <utility>

#include "analysis/recordings/csv_recording.hpp"
#include "analysis/recordings/sound_file.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::array<std::pair<const char*, Quantity>, 3> quantities{
    {{"acceleration", Quantity::acceleration},
     {"velocity", Quantity::velocity},
     {"displacement", Quantity::displacement}}};

std::string lower_case_ending(const std::string& file) {
  std::string ending = std::filesystem::path{file}.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}
}  // namespace

Quantity quantity_from(const std::string& word) {
  for (const auto& [text, quantity] : quantities) {
    if (word == text) {
      return quantity;
    }
  }
  throw core::InvalidInput{
      fmt::format("'{}' is not a quantity (acceleration, velocity or displacement)", word)};
}

const char* name(Quantity quantity) {
  return std::ranges::find(quantities, quantity, &std::pair<const char*, Quantity>::second)->first;
}

Recording read_recording(const std::string& file, const ReadingOptions& options) {
  const std::string ending = lower_case_ending(file);
  if (ending != ".csv" && ending != ".txt" && ending != ".tsv") {
    return read_sound_file(file, options);
  }
  std::ifstream text{file};
  if (!text) {
    throw core::InvalidInput{file + ": cannot be read"};
  }
  return read_csv_recording(text, file, options);
}
}  // namespace tapstudy::analysis
