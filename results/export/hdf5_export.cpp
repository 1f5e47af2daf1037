#include <cmath>
#include <limits>
#include <unordered_set>

#include "results/export/csv_file.hpp"
#include "results/export/hdf5_file.hpp"
#include "results/export/study_export.hpp"
#include "results/export/study_tables.hpp"
namespace tapstudy::results {
namespace {
// One column of a table, as it is collected row by row. Equal texts are kept once.
class Values {
 public:
  void add(const Cell& cell) { std::visit(*this, cell); }
  void write(Hdf5File& file, const std::string& path, CellType type) const {
    if (type == CellType::text) {
      file.add_texts(path, texts_);
    } else if (type == CellType::real || has_missing_) {
      file.add_reals(path, reals_);
    } else {
      file.add_integers(path, integers_);
    }
  }
  void operator()(std::monostate /*missing*/) {
    has_missing_ = true;
    reals_.push_back(std::numeric_limits<double>::quiet_NaN());
    integers_.push_back(0);
    add_text(missing_in_csv);
  }
  void operator()(std::int64_t number) {
    reals_.push_back(static_cast<double>(number));
    integers_.push_back(number);
  }
  void operator()(double number) { reals_.push_back(number); }
  void operator()(const std::string& text) { add_text(text); }

 private:
  void add_text(const std::string& text) { texts_.push_back(pool_.insert(text).first->c_str()); }
  bool has_missing_{false};
  std::vector<double> reals_;
  std::vector<std::int64_t> integers_;
  std::unordered_set<std::string> pool_;
  std::vector<const char*> texts_;
};

void add_table(Hdf5File& file, const Table& table) {
  const std::string group = "/tables/" + table.name;
  file.add_group(group);
  file.describe(group, "description", table.description);
  std::vector<Values> values(table.columns.size());
  table.each_row([&](const Row& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      values[i].add(row[i]);
    }
  });
  std::vector<std::string> names;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Column& column = table.columns[i];
    const std::string path = group + "/" + column.name;
    values[i].write(file, path, column.type);
    file.describe(path, "unit", column.unit);
    file.describe(path, "description", column.description);
    names.push_back(column.name);
  }
  file.describe(group, "columns", names);
}

double number_in(const Cell& cell) {
  const auto* const integer = std::get_if<std::int64_t>(&cell);
  return integer != nullptr ? static_cast<double>(*integer) : std::get<double>(cell);
}

void add_trace(Hdf5File& file, const Table& trace, std::int64_t trial_id) {
  std::vector<double> numbers;
  trace.each_row([&](const Row& row) {
    for (const Cell& cell : row) {
      numbers.push_back(number_in(cell));
    }
  });
  std::vector<std::string> names;
  std::vector<std::string> units;
  std::vector<std::string> descriptions;
  for (const Column& column : trace.columns) {
    names.push_back(column.name);
    units.push_back(column.unit);
    descriptions.push_back(column.description);
  }
  const std::string path = "/traces/" + trace.name;
  file.add_matrix(path, numbers, trace.columns.size());
  file.describe(path, "description", trace.description);
  file.describe(path, "trial_id", trial_id);
  file.describe(path, "columns", names);
  file.describe(path, "units", units);
  file.describe(path, "descriptions", descriptions);
}
}  // namespace

void write_hdf5_file(const std::string& name, Store& store, const StudyExport& study) {
  Hdf5File file{name};
  file.describe("/", "title", study.provenance.title);
  file.describe("/", "protocol_sha256", study.provenance.protocol_sha256);
  file.describe("/", "program", study.provenance.program);
  file.describe("/", "missing_text", missing_in_csv);
  file.add_texts("/protocol", {study.protocol_text.c_str()});
  file.add_group("/tables");
  for (const Table& table : study.tables) {
    add_table(file, table);
  }
  file.add_group("/traces");
  for (const std::int64_t trial : study.trials) {
    add_trace(file, trace_table(store, trial), trial);
  }
  file.close();
}
}  // namespace tapstudy::results
