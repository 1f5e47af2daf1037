#include "core/random/rng.hpp"

#include <cmath>
namespace tapstudy::core {
namespace {
std::uint64_t mixed(std::uint64_t x) noexcept {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}
}  // namespace

double Rng::uniform() noexcept {
  const std::uint64_t high = (*this)() >> 5U;
  const std::uint64_t low = (*this)() >> 6U;
  constexpr double two_to_minus_53 = 1.0 / 9007199254740992.0;
  return static_cast<double>((high << 26U) + low) * two_to_minus_53;
}

double Rng::normal() noexcept {
  for (;;) {
    const double u = 2.0 * uniform() - 1.0;
    const double v = 2.0 * uniform() - 1.0;
    const double s = u * u + v * v;
    if (s > 0.0 && s < 1.0) {
      return u * std::sqrt(-2.0 * std::log(s) / s);
    }
  }
}

double Rng::log_normal(double median, double spread) noexcept {
  return median * std::exp(spread * normal());
}

std::uint64_t derived_seed(std::uint64_t seed, Purpose purpose, std::uint64_t index) noexcept {
  return mixed(mixed(mixed(seed) ^ static_cast<std::uint64_t>(purpose)) ^ index);
}
}  // namespace tapstudy::core
