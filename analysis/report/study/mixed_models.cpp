#include "analysis/report/study/mixed_models.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "analysis/statistics/csv_rows.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
// The keys of the table's columns, in order; the script writes the same.
constexpr std::array<const char*, 9> keys_of_models{
    "block", "model", "term", "estimate", "standard_error", "statistic", "p", "test", "note"};

Cell number_or_nothing(const std::optional<double>& value) {
  return value ? number(*value) : Cell{"", {std::monostate{}}};
}

Cell probability_or_nothing(const std::optional<double>& p) {
  return p ? probability(p) : Cell{"", {std::monostate{}}};
}

// As the script names it; people read "a × b" of an interaction, where a line may be broken.
Cell term_cell(const std::string& term) {
  std::string shown;
  for (std::size_t i = 0; i < term.size(); ++i) {
    const bool is_interaction = term[i] == ':' && i + 1 < term.size() && term[i + 1] != ' ';
    shown += is_interaction ? std::string{" × "} : std::string{term[i]};
  }
  return {shown, {term}};
}

ReportTable table_of_models(const std::vector<MixedModelRow>& rows) {
  constexpr std::array headings{"block",     "",  "term", "estimate", "standard error",
                                "statistic", "p", "test", ""};
  ReportTable table{"mixed_models", "Coefficients", {}};
  for (std::size_t i = 0; i < keys_of_models.size(); ++i) {
    table.columns.push_back(column(headings.at(i), keys_of_models.at(i)));
  }
  for (const MixedModelRow& row : rows) {
    table.rows.push_back({word(row.block), word(row.model), term_cell(row.term),
                          number_or_nothing(row.estimate), number_or_nothing(row.standard_error),
                          number_or_nothing(row.statistic), probability_or_nothing(row.p),
                          word(row.test), word(row.note)});
  }
  return table;
}

constexpr const char* how_models_were_fitted =
    "Fitted by R (mixed_models.R, which `export` writes beside its tables); exploratory, not "
    "adjusted for their number. Right answers: logistic, by lme4's glmer with Laplace's "
    "approximation; ratings in steps: cumulative logistic, by ordinal's clmm; thresholds and other "
    "ratios: linear, of natural logarithms, by lme4's lmer. Coefficients of a predictor sum to "
    "zero "
    "over its values: \"material=mdf\" is how far mdf lies from the mean of all materials. "
    "Participants differ in their mean and in every effect that varies within them; where that "
    "cannot be estimated, the note of a model says what is left of it.";

// The notes of models, each once, below the table.
void add_notes(const std::vector<MixedModelRow>& rows, ReportSection& section) {
  for (const MixedModelRow& row : rows) {
    if (!row.note.empty()) {
      section.remarks.emplace_back((row.block.empty() ? "" : row.block + ", " + row.model + ": ") +
                                   row.note + ".");
    }
  }
}

// The places of the columns in a file.
std::array<std::size_t, keys_of_models.size()> places_of_columns(const CsvText& csv,
                                                                 const std::string& file) {
  std::array<std::size_t, keys_of_models.size()> places{};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::vector<std::string> none;
    const std::vector<std::string>& header = csv.rows.empty() ? none : csv.rows.front().cells;
    const auto found = std::ranges::find(header, keys_of_models.at(i));
    if (found == header.end()) {
      throw core::InvalidInput{file + ": has no column '" + keys_of_models.at(i) + "'"};
    }
    places.at(i) = static_cast<std::size_t>(found - header.begin());
  }
  return places;
}

bool is_missing_cell(const std::string& cell) {
  return cell.empty() || cell == "NA";
}
}  // namespace

std::optional<ReportSection> mixed_models_section(const std::vector<MixedModelRow>& rows) {
  if (rows.empty()) {
    return std::nullopt;
  }
  ReportSection section{"Mixed models", {table_of_models(rows)}};
  section.name = study_sections::mixed_models;
  section.is_detail = true;
  add_notes(rows, section);
  section.remarks.emplace_back(how_models_were_fitted);
  return section;
}

std::vector<MixedModelRow> read_mixed_models(std::istream& text, const std::string& file) {
  const CsvText csv = read_csv(text, file);
  const auto places = places_of_columns(csv, file);
  std::vector<MixedModelRow> rows;
  for (std::size_t i = 1; i < csv.rows.size(); ++i) {
    const CsvRow& line = csv.rows[i];
    const auto cell = [&](std::size_t column) {
      const std::size_t place = places.at(column);
      if (place >= line.cells.size()) {
        throw core::InvalidInput{csv.place(file, line.line) + ": has too few cells"};
      }
      return is_missing_cell(line.cells[place]) ? std::string{} : line.cells[place];
    };
    const auto number_at = [&](std::size_t column) -> std::optional<double> {
      const std::string written = cell(column);
      const auto value = csv.number(written);
      if (!written.empty() && !value) {
        throw core::InvalidInput{csv.place(file, line.line) + ": '" + written + "' is no number"};
      }
      return value;
    };
    rows.push_back({cell(0), cell(1), cell(2), number_at(3), number_at(4), number_at(5),
                    number_at(6), cell(7), cell(8)});
  }
  return rows;
}
}  // namespace tapstudy::analysis
