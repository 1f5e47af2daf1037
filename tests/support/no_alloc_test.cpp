#include "support/no_alloc.hpp"

#include <Eigen/Core>
#include <memory>

#include "support/catch.hpp"
using namespace tapstudy::testing;

#if !TAPSTUDY_SANITIZED
TEST_CASE("the counter of allocations sees new, malloc and Eigen's arrays", "[realtime]") {
  const AllocationCount allocations;
  const auto by_new = std::make_unique<double>(1.0);
  const std::size_t after_new = allocations.count();
  const Eigen::ArrayXd by_eigen = Eigen::ArrayXd::Zero(100);
  const std::size_t after_eigen = allocations.count();
  CHECK(by_eigen.sum() + *by_new == 1.0);
  CHECK(after_new == 1);
  CHECK(after_eigen == 2);
}
#endif
