#include "results/export/table.hpp"

#include <algorithm>
#include <utility>
namespace tapstudy::results {
Table table_of(std::string name, std::string description, std::vector<Column> columns,
               std::vector<Row> rows) {
  return {std::move(name), std::move(description), std::move(columns),
          [kept = std::move(rows)](const RowSink& sink) { std::ranges::for_each(kept, sink); }};
}
}  // namespace tapstudy::results
