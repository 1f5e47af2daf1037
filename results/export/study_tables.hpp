#pragma once
#include <map>
#include <string>
#include <vector>

#include "results/export/table.hpp"
#include "results/store.hpp"
namespace tapstudy::results {
// The tables of a study that its store alone yields: sessions, trials, answers, alternatives,
// visits, events, session_events, questionnaires, operator_actions. All participants of all modes
// are in them, excluded ones and practice too; columns say which. Alternatives have a column for
// each axis that was varied, with the unit given here. Their rows are read from the store when they
// are asked for, and it must live as long. Throws StoreError, also when rows are read.
std::vector<Table> study_tables(Store& store, const std::map<std::string, std::string>& axis_units);

// A row of a SELECT of these columns.
Row row_from(Statement& statement, const std::vector<Column>& columns);
// Trials of which ticks are stored; of a real plate there are none.
std::vector<std::int64_t> trials_with_traces(Store& store);
// Every tick of a trial; columns as in trace_format.md. A NaN is where a device reports nothing.
std::vector<Column> trace_columns();
Table trace_table(Store& store, std::int64_t trial_id);
}  // namespace tapstudy::results
