#include "analysis/modal/response/residue_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/modal/decay/decay_fit.hpp"
#include "analysis/modal/response/modal_basis.hpp"
#include "core/algebra/blas.hpp"
#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using Complex = std::complex<double>;
constexpr double least_noise = 1e-5;  // of a response's root mean square

// One state of the poles, and all that follows from it linearly.
class Projection {
 public:
  Projection(const FrequencyResponses& responses, const Eigen::MatrixXd& measured,
             std::vector<Complex> poles)
      : poles_{std::move(poles)},
        basis_{modal_basis(responses.frequency_hz, responses.kind, poles_)},
        orthonormal_{basis_.columns},
        explained_{core::inner_products(orthonormal_.Q, measured)},
        residual_{measured} {
    core::subtract_combination(orthonormal_.Q, explained_, residual_);
  }

  const std::vector<Complex>& poles() const { return poles_; }
  const ModalBasis& basis() const { return basis_; }
  const Eigen::MatrixXd& residual() const { return residual_; }
  const Eigen::MatrixXd& inverse_of_r() {
    if (inverse_of_r_.size() == 0) {
      inverse_of_r_ = orthonormal_.inverse_of_r();
    }
    return inverse_of_r_;
  }
  // Of the basis's columns, a column for each response.
  Eigen::MatrixXd coefficients() { return inverse_of_r() * explained_; }
  Eigen::MatrixXd fitted() const { return orthonormal_.Q * explained_; }
  double weighted_squares(const Eigen::VectorXd& weights) const {
    return residual_.colwise().squaredNorm() * weights;
  }
  // What of the slopes the columns do not explain.
  Eigen::MatrixXd projected_slopes() const {
    Eigen::MatrixXd slopes = basis_.slopes;
    core::subtract_combination(orthonormal_.Q, core::inner_products(orthonormal_.Q, slopes),
                               slopes);
    return slopes;
  }

 private:
  std::vector<Complex> poles_;
  ModalBasis basis_;
  OrthonormalBasis orthonormal_;
  Eigen::MatrixXd explained_;
  Eigen::MatrixXd residual_;
  Eigen::MatrixXd inverse_of_r_;
};

// dH / d(Re p, Im p) of one response by the projected slopes: a 2 x 2 block a mode.
Eigen::Matrix2d block_of(const Eigen::MatrixXd& coefficients, Eigen::Index mode,
                         Eigen::Index response) {
  const double real = coefficients(2 * mode, response);
  const double imaginary = coefficients(2 * mode + 1, response);
  Eigen::Matrix2d block;
  block << real, -imaginary, imaginary, real;
  return block;
}

struct Step {
  Eigen::MatrixXd information;  // of the poles' parts, in units of the basis
  Eigen::VectorXd gradient;
};

Step step_of(Projection& at, const Eigen::VectorXd& weights) {
  const Eigen::MatrixXd slopes = at.projected_slopes();
  const Eigen::MatrixXd coefficients = at.coefficients();
  const Eigen::MatrixXd gram = core::inner_products(slopes, slopes);
  const Eigen::MatrixXd towards = core::inner_products(slopes, at.residual());
  const auto modes = std::ssize(at.poles());
  Step step{Eigen::MatrixXd::Zero(2 * modes, 2 * modes), Eigen::VectorXd::Zero(2 * modes)};
  for (Eigen::Index response = 0; response < weights.size(); ++response) {
    for (Eigen::Index k = 0; k < modes; ++k) {
      const Eigen::Matrix2d left = weights[response] * block_of(coefficients, k, response);
      step.gradient.segment<2>(2 * k) += left.transpose() * towards.col(response).segment<2>(2 * k);
      for (Eigen::Index l = 0; l < modes; ++l) {
        const Eigen::Matrix2d of_gram = gram.block<2, 2>(2 * k, 2 * l);
        step.information.block<2, 2>(2 * k, 2 * l) +=
            left.transpose() * of_gram * block_of(coefficients, l, response);
      }
    }
  }
  return step;
}

// (information + damping * its diagonal)^-1, by correlations.
Eigen::MatrixXd damped_inverse(const Eigen::MatrixXd& information, double damping) {
  const Eigen::VectorXd per_size =
      information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd correlations = per_size.asDiagonal() * information * per_size.asDiagonal();
  correlations.diagonal().array() += damping;
  return per_size.asDiagonal() * core::pseudo_inverse(correlations) * per_size.asDiagonal();
}

std::vector<Complex> moved(const Projection& at, const Eigen::VectorXd& step) {
  std::vector<Complex> poles = at.poles();
  for (std::size_t k = 0; k < poles.size(); ++k) {
    const auto first = static_cast<Eigen::Index>(2 * k);
    poles[k] += Complex{step[first], step[first + 1]} * at.basis().unit_rad_per_s;
  }
  return poles;
}

// Levenberg-Marquardt steps until one gains no more than this share of the squares.
Projection descended(const FrequencyResponses& responses, const Eigen::MatrixXd& measured,
                     Projection at, const Eigen::VectorXd& weights, double settled_share) {
  constexpr int most_steps = 60;
  constexpr double most_damping = 1e4;
  double damping = 1e-4;
  for (int i = 0; i < most_steps && damping < most_damping; ++i) {
    const Step step = step_of(at, weights);
    const double before = at.weighted_squares(weights);
    for (; damping < most_damping; damping *= 10.0) {
      Projection next{responses, measured,
                      moved(at, damped_inverse(step.information, damping) * step.gradient)};
      const double after = next.weighted_squares(weights);
      if (after < before) {
        at = std::move(next);
        damping = std::max(1e-8, 0.1 * damping);
        if (before - after <= settled_share * before) {
          return at;
        }
        break;
      }
    }
  }
  return at;
}

// The variance of a real value of each response.
Eigen::VectorXd noise_variance(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& measured,
                               double unknowns) {
  const auto values = static_cast<double>(measured.rows());
  const Eigen::VectorXd of_residual =
      residual.colwise().squaredNorm().transpose() / std::max(1.0, values - unknowns);
  const Eigen::VectorXd floor =
      measured.colwise().squaredNorm().transpose() * (least_noise * least_noise / values);
  return of_residual.cwiseMax(1e-6 * floor);
}

// Sums over responses of the weighted derivative times the residual, a row a line.
Eigen::MatrixXd scores_of(Projection& at, const Eigen::VectorXd& weights) {
  const Eigen::MatrixXd slopes = at.projected_slopes();
  const Eigen::MatrixXd coefficients = at.coefficients();
  const Eigen::Index lines = slopes.rows() / 2;
  const auto modes = std::ssize(at.poles());
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(lines, 2 * modes);
  for (Eigen::Index response = 0; response < weights.size(); ++response) {
    const Eigen::VectorXd weighted = weights[response] * at.residual().col(response);
    for (Eigen::Index k = 0; k < modes; ++k) {
      const Eigen::MatrixXd derivative =
          weighted.asDiagonal() *
          (slopes.middleCols<2>(2 * k) * block_of(coefficients, k, response));
      scores.middleCols<2>(2 * k) += derivative.topRows(lines) + derivative.bottomRows(lines);
    }
  }
  return scores;
}

Eigen::MatrixXd robust_covariance(const Eigen::MatrixXd& scores, const Eigen::MatrixXd& inverse,
                                  double degrees_share) {
  constexpr Eigen::Index neighbours = 2;
  Eigen::MatrixXd sum = scores.transpose() * scores;
  for (Eigen::Index lag = 1; lag <= neighbours; ++lag) {
    const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(neighbours + 1);
    const Eigen::Index rows = scores.rows() - lag;
    const Eigen::MatrixXd lagged = scores.topRows(rows).transpose() * scores.bottomRows(rows);
    sum += weight * (lagged + lagged.transpose());
  }
  return degrees_share * inverse * sum * inverse;
}

double bandwidth_hz(const Complex& pole) {
  return -pole.real() / std::numbers::pi;
}
double damped_hz(const Complex& pole) {
  return pole.imag() / (2.0 * std::numbers::pi);
}

// Lines within so many hertz of a pole, at least `fewest` if there are as many.
std::vector<Eigen::Index> lines_near(const Eigen::ArrayXd& frequency_hz, double at_hz,
                                     double within_hz, Eigen::Index fewest) {
  const auto* const begin = frequency_hz.data();
  const auto* const end = begin + frequency_hz.size();
  Eigen::Index first = std::lower_bound(begin, end, at_hz - within_hz) - begin;
  Eigen::Index last = std::upper_bound(begin, end, at_hz + within_hz) - begin;
  const Eigen::Index missing = std::max<Eigen::Index>(0, fewest - (last - first));
  first = std::max<Eigen::Index>(0, first - missing / 2);
  last = std::min(frequency_hz.size(), std::max(last + missing / 2, first + fewest));
  std::vector<Eigen::Index> lines;
  for (Eigen::Index i = first; i < last; ++i) {
    lines.push_back(i);
  }
  return lines;
}

class Evaluation {
 public:
  Evaluation(const FrequencyResponses& responses, const Eigen::MatrixXd& measured, Projection& at)
      : responses_{responses}, measured_{measured}, at_{at}, coefficients_{at.coefficients()} {}

  void set_linear(ResidueFit& fit) {
    fit.poles = at_.poles();
    const auto modes = std::ssize(fit.poles);
    const double unit = at_.basis().unit_rad_per_s;
    const int derivative = static_cast<int>(responses_.kind);
    const double per_unit = std::pow(unit, 1 - derivative);
    fit.residues.resize(modes, coefficients_.cols());
    fit.residue_errors.resize(modes, coefficients_.cols());
    const Eigen::Index lines = measured_.rows() / 2;
    const Eigen::MatrixXd fitted = at_.fitted();
    fit.fitted = fitted.topRows(lines).cast<Complex>() +
                 Complex{0.0, 1.0} * fitted.bottomRows(lines).cast<Complex>();
    for (Eigen::Index k = 0; k < modes; ++k) {
      for (Eigen::Index i = 0; i < coefficients_.cols(); ++i) {
        fit.residues(k, i) =
            per_unit * Complex{coefficients_(2 * k, i), coefficients_(2 * k + 1, i)};
      }
      set_significance(k, per_unit, fit);
    }
  }

  void set_errors(const Eigen::VectorXd& weights, ResidueFit& fit) {
    const Eigen::MatrixXd inverse = damped_inverse(step_of(at_, weights).information, 0.0);
    const double values = static_cast<double>(measured_.rows());
    const double unknowns = static_cast<double>(at_.basis().columns.cols());
    const Eigen::MatrixXd robust = robust_covariance(scores_of(at_, weights), inverse,
                                                     values / std::max(1.0, values - unknowns));
    const double unit = at_.basis().unit_rad_per_s;
    for (std::size_t k = 0; k < fit.poles.size(); ++k) {
      const auto first = static_cast<Eigen::Index>(2 * k);
      const auto errors = [&](const Eigen::MatrixXd& covariance) {
        const Eigen::Matrix2d of_pole = covariance.block<2, 2>(first, first) * unit * unit;
        return errors_of_pole(fit.poles[k], of_pole, 1.0);
      };
      const Pole bound = errors(inverse);
      const Pole observed = errors(robust);
      fit.errors.push_back({std::max(bound.frequency_hz, observed.frequency_hz),
                            std::max(bound.damping_ratio, observed.damping_ratio)});
      const auto near = lines_near(responses_.frequency_hz, damped_hz(fit.poles[k]),
                                   bandwidth_hz(fit.poles[k]), 1);
      constexpr double parameters = 4.0;  // of a mode: pole and residue
      fit.degrees_of_freedom.push_back(
          std::max(2.0, 2.0 * static_cast<double>(near.size()) - parameters));
    }
  }

 private:
  // The residual's values near a mode, less what the poles there take: two of each response, and
  // two that all responses share.
  double degrees_near(const std::vector<Eigen::Index>& near) const {
    const double low_hz = responses_.frequency_hz[near.front()];
    const double high_hz = responses_.frequency_hz[near.back()];
    const auto poles = std::ranges::count_if(at_.poles(), [&](const Complex& pole) {
      return damped_hz(pole) >= low_hz && damped_hz(pole) <= high_hz;
    });
    const double of_pole = 2.0 + 2.0 / static_cast<double>(coefficients_.cols());
    return std::max(2.0,
                    2.0 * static_cast<double>(near.size()) - of_pole * static_cast<double>(poles));
  }
  // The variance of a real value of the residual near a mode.
  double variance_near(const std::vector<Eigen::Index>& near, double degrees,
                       Eigen::Index response) const {
    const Eigen::Index lines = measured_.rows() / 2;
    double sum = 0.0;
    for (const Eigen::Index line : near) {
      sum += at_.residual()(line, response) * at_.residual()(line, response) +
             at_.residual()(lines + line, response) * at_.residual()(lines + line, response);
    }
    const double floor = least_noise * least_noise * measured_.col(response).squaredNorm() /
                         static_cast<double>(measured_.rows());
    return std::max(sum / degrees, floor);
  }

  void set_significance(Eigen::Index mode, double per_unit, ResidueFit& fit) {
    constexpr double bandwidths = 2.0;
    constexpr Eigen::Index fewest_lines = 16;
    const Complex pole = fit.poles[static_cast<std::size_t>(mode)];
    const auto near = lines_near(responses_.frequency_hz, damped_hz(pole),
                                 bandwidths * bandwidth_hz(pole), fewest_lines);
    const double degrees = degrees_near(near);
    const auto rows = at_.inverse_of_r().middleRows<2>(2 * mode);
    const Eigen::Matrix2d covariance = rows * rows.transpose();  // for a variance of 1
    const double determinant =
        covariance(0, 0) * covariance(1, 1) - covariance(0, 1) * covariance(1, 0);
    Eigen::Matrix2d information;
    information << covariance(1, 1), -covariance(0, 1), -covariance(1, 0), covariance(0, 0);
    information /= std::max(determinant, 1e-300);
    double chi_squared = 0.0;
    double energy = 0.0;
    for (Eigen::Index i = 0; i < coefficients_.cols(); ++i) {
      const Eigen::Vector2d part = coefficients_.col(i).segment<2>(2 * mode);
      const double variance = variance_near(near, degrees, i);
      // Chi-squared of two degrees of freedom has the tail exp(-x / 2), F of 2 and n degrees
      // (1 + 2 F / n)^(-n / 2).
      chi_squared += degrees * std::log1p(part.dot(information * part) / (variance * degrees));
      energy += (at_.basis().columns.middleCols<2>(2 * mode) * part).squaredNorm() /
                measured_.col(i).squaredNorm();
      fit.residue_errors(mode, i) = per_unit * std::sqrt(variance * covariance.trace() / 2.0);
    }
    fit.significance.push_back(chi_squared);
    fit.shares.push_back(energy / static_cast<double>(coefficients_.cols()));
  }

  const FrequencyResponses& responses_;
  const Eigen::MatrixXd& measured_;
  Projection& at_;
  Eigen::MatrixXd coefficients_;
};
}  // namespace

ResidueFit fit_residues(const FrequencyResponses& responses, std::vector<Complex> poles,
                        Fitting fitting) {
  const Eigen::MatrixXd measured = stacked(responses.values);
  const auto unknowns = static_cast<double>(2 * std::ssize(poles) + residual_columns);
  if (static_cast<double>(measured.rows()) <= unknowns + static_cast<double>(2 * poles.size())) {
    throw core::InvalidInput{fmt::format(
        "{} poles cannot be told from {} frequencies: take a narrower band, or a finer resolution",
        poles.size(), responses.frequency_hz.size())};
  }
  const bool is_rough = fitting == Fitting::rough;
  Eigen::VectorXd weights = measured.colwise().squaredNorm().transpose().cwiseInverse();
  Projection at = descended(responses, measured, {responses, measured, std::move(poles)}, weights,
                            is_rough ? 1e-2 : 1e-4);
  constexpr int reweighted = 2;
  for (int round = 0; round < (is_rough ? 0 : reweighted); ++round) {
    weights = noise_variance(at.residual(), measured, unknowns).cwiseInverse();
    at = descended(responses, measured, std::move(at), weights, round == 0 ? 1e-4 : 1e-8);
  }
  ResidueFit fit;
  Evaluation evaluation{responses, measured, at};
  evaluation.set_linear(fit);
  if (!is_rough) {
    evaluation.set_errors(noise_variance(at.residual(), measured, unknowns).cwiseInverse(), fit);
  }
  return fit;
}
}  // namespace tapstudy::analysis
