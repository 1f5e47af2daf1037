#include "runner/recordings/speeds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "analysis/statistics/csv_rows.hpp"
#include "core/error.hpp"
#include "core/number_in.hpp"
namespace tapstudy::runner {
namespace {
constexpr double max_speed_m_s = 100.0;

double speed_in(const std::string& cell, const std::string& file, int line) {
  const auto value = core::number_in<double>(cell);
  if (!value || !(*value > 0.0 && *value < max_speed_m_s)) {
    throw core::InvalidInput{fmt::format("{}:{}: '{}' is not a speed (above 0, below {} m/s)", file,
                                         line, cell, max_speed_m_s)};
  }
  return *value;
}
}  // namespace

std::vector<double> read_speeds(const std::string& file) {
  std::ifstream text{file};
  if (!text) {
    throw core::InvalidInput{file + ": cannot be read"};
  }
  const std::vector<analysis::CsvRow> rows = analysis::read_csv(text, file).rows;
  const auto column = [&]() -> std::size_t {
    if (!rows.empty()) {
      const auto& header = rows.front().cells;
      const auto found = std::ranges::find(header, "speed_m_s");
      if (found != header.end()) {
        return static_cast<std::size_t>(found - header.begin());
      }
    }
    throw core::InvalidInput{file + ":1: has no column speed_m_s"};
  }();
  std::vector<double> speeds;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].cells.size() <= column) {
      throw core::InvalidInput{fmt::format("{}:{}: has no speed", file, rows[i].line)};
    }
    speeds.push_back(speed_in(rows[i].cells[column], file, rows[i].line));
  }
  return speeds;
}
}  // namespace tapstudy::runner
