#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// Items on an interval scale whose mean is 0.
struct PreferenceScale {
  Eigen::VectorXd values;
  Eigen::MatrixXd covariance;       // by the information; rows and columns sum to 0
  std::vector<Interval> intervals;  // 95 %, values +- 1.96 standard errors
  double log_likelihood{};          // without multinomial coefficients
};

struct ScaleDifference {
  double value{};
  double standard_error{};
  Interval interval;  // 95 %
  double p{};         // two-sided, by Wald's test of no difference
};
// values[i] - values[j]. Throws InvalidInput unless i and j are two different items.
ScaleDifference difference(const PreferenceScale& scale, Eigen::Index i, Eigen::Index j);

// A log-likelihood with its score and information at a point.
struct LikelihoodAt {
  double value{};
  Eigen::VectorXd score;
  Eigen::MatrixXd information;
};
using ScaleLikelihood = std::function<LikelihoodAt(const Eigen::VectorXd&)>;

struct ScaleMaximum {
  Eigen::VectorXd at;
  Eigen::MatrixXd covariance;
  double log_likelihood{};
};
// The maximum of a concave likelihood of `items` scale values, which only their differences
// determine, and any further parameters after them: Newton's method with halved steps, values
// centred. The covariance is the inverse of the information among centred values.
ScaleMaximum maximise_scale(const ScaleLikelihood& likelihood, Eigen::Index items,
                            Eigen::Index parameters);

// With the intervals of the first `items` parameters.
PreferenceScale scale_of(const ScaleMaximum& maximum, Eigen::Index items);
}  // namespace tapstudy::analysis
