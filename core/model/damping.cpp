#include "core/model/damping.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
namespace tapstudy::core {
RayleighDamping rayleigh_from_two_ratios(const TwoRatioDamping& ratios, double first_rad_s,
                                         double last_rad_s) {
  if (!(0.0 < first_rad_s && first_rad_s < last_rad_s)) {
    throw ModelError{"damping: two damping ratios need two different frequencies inside the band"};
  }
  const double scale =
      2.0 * first_rad_s * last_rad_s / ((last_rad_s - first_rad_s) * (last_rad_s + first_rad_s));
  const RayleighDamping damping{
      scale * (last_rad_s * ratios.first_ratio - first_rad_s * ratios.last_ratio),
      scale * (ratios.last_ratio / first_rad_s - ratios.first_ratio / last_rad_s)};
  if (damping.alpha_per_s < 0.0 || damping.beta_s < 0.0) {
    throw ModelError{fmt::format(
        "damping: the ratios {} and {} give alpha {:.4g} 1/s and beta {:.4g} s (neither may be "
        "negative: modes outside the two would gain energy)",
        ratios.first_ratio, ratios.last_ratio, damping.alpha_per_s, damping.beta_s)};
  }
  return damping;
}

Eigen::ArrayXd damping_ratios(const RayleighDamping& damping, const Eigen::ArrayXd& omega_rad_s) {
  return 0.5 * (damping.alpha_per_s / omega_rad_s + damping.beta_s * omega_rad_s);
}

RayleighDamping rayleigh_of(const Damping& damping, const Eigen::ArrayXd& omega_rad_s) {
  if (const auto* given = std::get_if<RayleighDamping>(&damping)) {
    return *given;
  }
  if (omega_rad_s.size() == 0) {
    return {};
  }
  return rayleigh_from_two_ratios(std::get<TwoRatioDamping>(damping), omega_rad_s[0],
                                  omega_rad_s[omega_rad_s.size() - 1]);
}
}  // namespace tapstudy::core
