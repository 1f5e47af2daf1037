// Which motions of a body nothing resists.
#include "core/model/elements/rigid_motions.hpp"

#include <cmath>

#include "support/catch.hpp"
using namespace tapstudy;

TEST_CASE("motions that nothing resists are counted beside those that thousands of nodes resist",
          "[core][model]") {
  for (const double nodes : {1.0, 1e2, 1e4, 1e6}) {
    Eigen::MatrixXd resisting(12, 9);
    for (Eigen::Index i = 0; i < resisting.size(); ++i) {
      resisting(i) = std::sin(1.0 + 7.3 * static_cast<double>(i * i));
    }
    const Eigen::MatrixXd sum = nodes * resisting * resisting.transpose();
    CAPTURE(nodes);
    CHECK(core::unresisted(sum) == 3);
  }
}

TEST_CASE("a screw's head resists all motions of a large plate", "[core][model]") {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Identity(6, 6);
  sum.bottomRightCorner(3, 3) *= 1e-5;  // a lever of 3 mm on a plate of a metre
  CHECK(core::unresisted(sum) == 0);
}
