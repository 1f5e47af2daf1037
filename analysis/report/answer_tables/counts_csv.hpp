#pragma once
#include <cstddef>
#include <set>
#include <string>

#include "analysis/statistics/confusion_matrix.hpp"
#include "analysis/statistics/csv_rows.hpp"
namespace tapstudy::analysis {
// A confusion matrix from a table of counts, one row per stimulus, counts below the responses:
//   stimulus[,factor:NAME…],RESPONSE,RESPONSE,…
// Factors are marked, with their levels below; a response that is no stimulus is one of `others`.
// Throws InvalidInput with file:line, for names that read alike, and, unless they are said to be
// counts, where rows, columns or all numbers add up to 100, as percentages do, or one is the sum of
// others.
ConfusionMatrix read_counts(const CsvText& csv, const std::string& file, bool are_counts = false,
                            const std::set<std::string>& others = {});
// Which of the two a table's rows stand for, where its corner does not say "stimulus".
enum class MatrixRows { stimuli, responses };
// The same table with that corner and stimuli as rows. R's write.table leaves the corner out.
// Throws InvalidInput where the corner says the contrary.
CsvText as_matrix(CsvText csv, MatrixRows rows);
// Of the participants whose answers a table holds, where a comment says it: "# mode: pilot, real".
std::set<std::string> modes_in(const CsvText& csv);
inline constexpr std::size_t max_classes = 200;  // stimuli or responses
inline constexpr const char* factor_mark = "factor:";
inline constexpr const char* mode_mark = "# mode: ";
}  // namespace tapstudy::analysis
