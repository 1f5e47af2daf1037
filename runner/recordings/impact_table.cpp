#include "runner/recordings/impact_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "analysis/statistics/csv_rows.hpp"
#include "core/error.hpp"
#include "core/number_in.hpp"
namespace tapstudy::runner {
namespace {
constexpr double max_speed_m_s = 100.0;
constexpr double max_distance_m = 10.0;

class ImpactTable {
 public:
  explicit ImpactTable(const std::string& file) : file_{file} {
    std::ifstream text{file};
    if (!text) {
      throw core::InvalidInput{file + ": cannot be read"};
    }
    text_ = analysis::read_csv(text, file);
  }

  // of_number: whether a number can be one of this column's; what: how it is called.
  template <class OfNumber>
  std::vector<double> column(const std::string& name, OfNumber of_number,
                             const std::string& what) const {
    const std::size_t place = place_of(name);
    std::vector<double> values;
    for (std::size_t i = 1; i < text_.rows.size(); ++i) {
      const auto& cells = text_.rows[i].cells;
      const auto value = place < cells.size() ? text_.number(cells[place]) : std::nullopt;
      if (!value || !of_number(*value)) {
        throw core::InvalidInput{fmt::format("{}:{}: '{}' is not {}", file_, text_.rows[i].line,
                                             place < cells.size() ? cells[place] : "", what)};
      }
      values.push_back(*value);
    }
    return values;
  }

 private:
  std::size_t place_of(const std::string& name) const {
    if (!text_.rows.empty()) {
      const auto& header = text_.rows.front().cells;
      const auto found = std::ranges::find(header, name);
      if (found != header.end()) {
        return static_cast<std::size_t>(found - header.begin());
      }
    }
    throw core::InvalidInput{fmt::format("{}:1: has no column {}", file_, name)};
  }

  std::string file_;
  analysis::CsvText text_;
};
}  // namespace

std::vector<double> read_speeds(const std::string& file) {
  return ImpactTable{file}.column(
      "speed_m_s", [](double value) { return value > 0.0 && value < max_speed_m_s; },
      fmt::format("a speed (above 0, below {} m/s)", max_speed_m_s));
}

std::vector<Eigen::Vector2d> read_places(const std::string& file) {
  const ImpactTable table{file};
  const auto is_near = [](double value) { return std::abs(value) <= max_distance_m; };
  const std::string what = fmt::format("a coordinate (within {} m)", max_distance_m);
  const std::vector<double> x_m = table.column("x_m", is_near, what);
  const std::vector<double> y_m = table.column("y_m", is_near, what);
  std::vector<Eigen::Vector2d> places_m;
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    places_m.emplace_back(x_m[i], y_m[i]);
  }
  return places_m;
}
}  // namespace tapstudy::runner
