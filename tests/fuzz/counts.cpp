#include <sstream>

#include "analysis/report/answer_tables/answer_table.hpp"
#include "analysis/report/answer_tables/counts_csv.hpp"
#include "analysis/report/summary.hpp"
#include "analysis/report/writers.hpp"
#include "fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(data, size, [](const std::string& text) {
    std::istringstream stream{text};
    const auto csv = tapstudy::analysis::read_csv(stream, "counts.csv");
    const bool are_answers =
        !csv.rows.empty() && tapstudy::analysis::has_answers(csv.rows.front().cells);
    const auto summary =
        are_answers
            ? tapstudy::analysis::summarise(
                  tapstudy::analysis::read_answers({{"answers.csv", csv}}, {}), "answers", "")
            : tapstudy::analysis::summarise(tapstudy::analysis::read_counts(csv, "counts.csv"),
                                            "counts", "", tapstudy::analysis::modes_in(csv));
    std::ostringstream out;
    tapstudy::analysis::write_text(out, summary);
    tapstudy::analysis::write_html(out, summary);
    tapstudy::analysis::write_json(out, summary);
  });
}
