#include <fmt/format.h>
#include <fmt/ostream.h>

#include "analysis/report/writers.hpp"
namespace tapstudy::analysis {
void write_csv(std::ostream& out, const ConfusionMatrix& matrix) {
  const std::vector<std::string> factors = factors_of(matrix);
  out << "stimulus";
  for (const std::string& factor : factors) {
    out << ',' << factor;
  }
  for (const Item& response : matrix.responses) {
    out << ',' << response.name;
  }
  out << '\n';
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    out << matrix.stimuli[i].name;
    for (const std::string& factor : factors) {
      out << ',' << matrix.stimuli[i].factors.at(factor);
    }
    for (const int count : matrix.counts[i]) {
      out << ',' << count;
    }
    out << '\n';
  }
}

void write_csv(std::ostream& out, const ChoiceSummary& choice) {
  out << "stimulus,chosen,choices,visits,dwell_s\n";
  for (const AlternativeResult& result : choice.alternatives) {
    fmt::print(out, "{},{},{},{},{:.3f}\n", result.item.name, result.chosen.successes,
               result.chosen.trials, result.visits, result.dwell_s);
  }
}
}  // namespace tapstudy::analysis
