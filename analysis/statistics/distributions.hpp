#pragma once
// Distribution functions, by Boost.Math. Every function throws core::InvalidInput for a probability
// outside [0, 1] and degrees of freedom that are not above 0.
namespace tapstudy::analysis {
double normal_density(double z);
double normal_cdf(double z);
// -infinity at 0, infinity at 1
double normal_quantile(double probability);
// P(X >= x); 1 for x <= 0
double chi_squared_p(double x, double degrees_of_freedom);
double chi_squared_quantile(double probability, double degrees_of_freedom);
// P(F >= f) of Fisher's F
double f_p(double f, double numerator_freedom, double denominator_freedom);
// probability in (0, 1)
double f_quantile(double probability, double numerator_freedom, double denominator_freedom);
// Quantile of the gamma distribution with scale 1; probability in (0, 1), shape above 0
double gamma_quantile(double probability, double shape);
// probability in [0, 1], both shapes above 0
double beta_quantile(double probability, double first_shape, double second_shape);
// probability in (0, 1)
double t_quantile(double probability, double degrees_of_freedom);
// Of t whose numerator has this mean; probability in (0, 1)
double noncentral_t_quantile(double probability, double degrees_of_freedom, double noncentrality);
// The two-sided probability of a statistic at least as far from 0.
double normal_two_sided_p(double z);
}  // namespace tapstudy::analysis
