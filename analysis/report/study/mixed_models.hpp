#pragma once
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/sections.hpp"
namespace tapstudy::analysis {
// A line of mixed_models.csv, as mixed_models.R writes it: a coefficient, a test of several, how
// far participants differ, or why there is no model.
struct MixedModelRow {
  std::string block;
  std::string model;  // its kind
  std::string term;   // empty: the row is of the whole model
  std::optional<double> estimate{};
  std::optional<double> standard_error{};
  std::optional<double> statistic{};
  std::optional<double> p{};
  std::string test{};
  std::string note{};  // of the model, at its first row
};

// The table `mixed_models` of a report; its CSV file can be read again by read_mixed_models.
// nullopt without rows.
std::optional<ReportSection> mixed_models_section(const std::vector<MixedModelRow>& rows);
// By the names of columns. Throws InvalidInput with file and line for what is no such table.
std::vector<MixedModelRow> read_mixed_models(std::istream& text, const std::string& file);
}  // namespace tapstudy::analysis
