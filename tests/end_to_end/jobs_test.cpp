#include "support/catch.hpp"
#include "support/processes.hpp"
using namespace tapstudy;

namespace {
void run_jobs(const std::string& by) {
  const auto result = testing::run_script("jobs/jobs_test.py", {by});
  INFO(result.standard_error);
  CHECK(result.exit_code == 0);
}
}  // namespace

TEST_CASE("a job array of Slurm whose task was killed is sent again and makes one study",
          "[end_to_end][slurm][waits]") {
  run_jobs("slurm");
}

TEST_CASE("jobs of GNU parallel of which one was killed make one study", "[end_to_end][shares]") {
  run_jobs("parallel");
}
