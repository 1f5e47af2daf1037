#include <sstream>

#include "analysis/report/summary.hpp"
#include "analysis/report/writers.hpp"
#include "analysis/statistics/counts_csv.hpp"
#include "fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(data, size, [](const std::string& text) {
    std::istringstream stream{text};
    const auto counts = tapstudy::analysis::read_counts(stream, "counts.csv");
    const auto summary = tapstudy::analysis::summarise(counts.matrix, "counts", "", counts.mode);
    std::ostringstream out;
    tapstudy::analysis::write_text(out, summary);
    tapstudy::analysis::write_html(out, summary);
    tapstudy::analysis::write_json(out, summary);
  });
}
