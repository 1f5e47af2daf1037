#pragma once
#include <cstdint>
#include <functional>
namespace tapstudy::analysis {
// ln n!, n >= 0, from any thread: a table below 1024, Stirling's series above (to 1e-15, relative).
double log_factorial(std::int64_t n);

using RealFunction = std::function<double(double)>;

// The integral over [low, high], both finite, by adaptive Gauss-Kronrod quadrature (Boost.Math, 31
// points), to about ten digits for smooth functions.
double integral(const RealFunction& function, double low, double high);

// The root between two ends, at which function must differ in sign or vanish; to fourteen digits
// (Alefeld et al. 1995, algorithm 748, by Boost.Math). Throws InvalidInput if it does not.
double root(const RealFunction& function, double one_end, double other_end);

// The first and second derivative of the logarithm of the gamma function, x > 0 (Boost.Math).
double digamma(double x);
double trigamma(double x);

struct Minimum {
  double at{};
  double value{};
};
// The minimum between two ends of a function with one minimum, to six digits of its place (Brent
// 1973, by Boost.Math).
Minimum minimum(const RealFunction& function, double low, double high);
}  // namespace tapstudy::analysis
