#include "analysis/statistics/sign_test.hpp"
namespace tapstudy::analysis {
SignTest sign_test(const std::vector<double>& differences) {
  SignTest test;
  for (const double difference : differences) {
    test.above.trials += difference != 0.0 ? 1 : 0;
    test.above.successes += difference > 0.0 ? 1 : 0;
  }
  test.p = test.above.trials == 0 ? 1.0 : binomial_p_at_least(test.above, 0.5);
  return test;
}
}  // namespace tapstudy::analysis
