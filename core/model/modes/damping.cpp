#include "core/model/modes/damping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
namespace tapstudy::core {
namespace {
RayleighDamping not_negative(const RayleighDamping& damping, const std::string& source) {
  if (damping.alpha_per_s < 0.0 || damping.beta_s < 0.0) {
    throw DampingError{
        fmt::format("{} give alpha {:.4g} 1/s and beta {:.4g} s (neither may be negative: modes "
                    "elsewhere would gain energy)",
                    source, damping.alpha_per_s, damping.beta_s)};
  }
  return damping;
}

Eigen::ArrayXd as_measured(const ModalDamping& damping, Eigen::Index modes) {
  const auto given = static_cast<Eigen::Index>(damping.ratios.size());
  if (given < modes && !damping.further_ratio) {
    throw DampingError{fmt::format(
        "{} modal ratios are given, {} modes lie inside the band (give one for each, or "
        "further_ratio for those beyond the list)",
        given, modes)};
  }
  Eigen::ArrayXd ratios = Eigen::ArrayXd::Constant(modes, damping.further_ratio.value_or(0.0));
  const Eigen::Index listed = std::min(given, modes);
  ratios.head(listed) = Eigen::Map<const Eigen::ArrayXd>{damping.ratios.data(), listed};
  return ratios;
}

// It is the lowest and the highest at once.
double ratio_of_only_mode(const TwoRatioDamping& ratios) {
  if (ratios.first_ratio != ratios.last_ratio) {
    throw DampingError{
        fmt::format("one mode lies inside the band, which cannot have both ratios {} and {} (make "
                    "them equal, or use ratio)",
                    ratios.first_ratio, ratios.last_ratio)};
  }
  return ratios.first_ratio;
}

RayleighDamping rayleigh_of(const Damping& damping, const Eigen::ArrayXd& omega_rad_s) {
  if (const auto* given = std::get_if<RayleighDamping>(&damping)) {
    return *given;
  }
  if (const auto* measured = std::get_if<FittedDamping>(&damping)) {
    return rayleigh_by_least_squares(*measured);
  }
  if (omega_rad_s.size() == 0) {
    return {};
  }
  return rayleigh_from_two_ratios(std::get<TwoRatioDamping>(damping), omega_rad_s[0],
                                  omega_rad_s[omega_rad_s.size() - 1]);
}
}  // namespace

RayleighDamping rayleigh_from_two_ratios(const TwoRatioDamping& ratios, double first_rad_s,
                                         double last_rad_s) {
  if (!(0.0 < first_rad_s && first_rad_s < last_rad_s)) {
    throw DampingError{"two damping ratios need two different frequencies inside the band"};
  }
  // eq. 13
  const double scale =
      2.0 * first_rad_s * last_rad_s / ((last_rad_s - first_rad_s) * (last_rad_s + first_rad_s));
  const RayleighDamping damping{
      scale * (last_rad_s * ratios.first_ratio - first_rad_s * ratios.last_ratio),
      scale * (ratios.last_ratio / first_rad_s - ratios.first_ratio / last_rad_s)};
  return not_negative(damping,
                      fmt::format("the ratios {} and {}", ratios.first_ratio, ratios.last_ratio));
}

Eigen::ArrayXd damping_ratios(const RayleighDamping& damping, const Eigen::ArrayXd& omega_rad_s) {
  return 0.5 * (damping.alpha_per_s / omega_rad_s + damping.beta_s * omega_rad_s);  // eq. 12
}

RayleighDamping rayleigh_by_least_squares(const FittedDamping& measured) {
  const auto count = static_cast<Eigen::Index>(measured.points.size());
  Eigen::MatrixX2d share{count, 2};
  Eigen::VectorXd ratio{count};
  for (Eigen::Index i = 0; i < count; ++i) {
    const FittedDamping::Point& point = measured.points[static_cast<std::size_t>(i)];
    const double omega = 2.0 * std::numbers::pi * point.frequency_hz;
    share.row(i) << 0.5 / omega, 0.5 * omega;
    ratio[i] = point.ratio;
  }
  // columns normalised, so that rank detection does not depend on the frequencies' magnitude
  const Eigen::RowVector2d size = share.colwise().norm();
  const LeastSquares fit = least_squares(share * size.cwiseInverse().asDiagonal(), ratio);
  if (fit.rank < 2) {
    throw DampingError{"a fit needs ratios at two different frequencies at least"};
  }
  const Eigen::Vector2d solution = fit.solution.cwiseQuotient(size.transpose());
  return not_negative({solution[0], solution[1]},
                      fmt::format("the {} ratios fitted", measured.points.size()));
}

Eigen::ArrayXd damping_ratios_due_to(const Damping& damping, const Eigen::ArrayXd& omega_rad_s,
                                     const Eigen::ArrayXd& kinetic_share,
                                     const Eigen::ArrayXd& strain_share) {
  if (std::holds_alternative<ModalDamping>(damping)) {
    throw DampingError{
        "modal ratios are those of a body's own modes, which it has no more in contact with others "
        "(give coefficients, measured ratios or one ratio)"};
  }
  if (const auto* stated = std::get_if<RayleighDamping>(&damping)) {
    return kinetic_share * damping_ratios({stated->alpha_per_s, 0.0}, omega_rad_s) +
           strain_share * damping_ratios({0.0, stated->beta_s}, omega_rad_s);
  }
  return strain_share * damp(damping, omega_rad_s).ratios;
}

DampedModes damp(const Damping& damping, const Eigen::ArrayXd& omega_rad_s) {
  if (const auto* modal = std::get_if<ModalDamping>(&damping)) {
    return {std::nullopt, as_measured(*modal, omega_rad_s.size())};
  }
  if (const auto* constant = std::get_if<ConstantDamping>(&damping)) {
    return {std::nullopt, Eigen::ArrayXd::Constant(omega_rad_s.size(), constant->ratio)};
  }
  if (const auto* ratios = std::get_if<TwoRatioDamping>(&damping);
      ratios != nullptr && omega_rad_s.size() == 1) {
    return {std::nullopt, Eigen::ArrayXd::Constant(1, ratio_of_only_mode(*ratios))};
  }
  const RayleighDamping rayleigh = rayleigh_of(damping, omega_rad_s);
  return {rayleigh, damping_ratios(rayleigh, omega_rad_s)};
}
}  // namespace tapstudy::core
