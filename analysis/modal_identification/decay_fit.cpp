#include "analysis/modal_identification/decay_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/modal_identification/cut_exponential.hpp"
#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using Complex = std::complex<double>;
constexpr Eigen::Index smooth_terms = 4;
constexpr int max_steps = 60;

// Unknowns: for each pole Re ln z and Im ln z, times the length; then a and b of Re((a - j b) z^n)
// for each, then the nuisance terms. Complex values as two real ones each, below one another.
class DecayModel {
 public:
  DecayModel(const BandSpectrum& spectrum, Eigen::Index poles, const std::vector<double>& lines_hz)
      : spectrum_{spectrum},
        poles_{poles},
        length_{static_cast<double>(spectrum.length)},
        data_{stacked(spectrum.values)} {
    const Eigen::ArrayXcd q = (Complex{0.0, -1.0} * spectrum.rad_per_sample.cast<Complex>()).exp();
    const auto lines = static_cast<Eigen::Index>(lines_hz.size());
    nuisance_ = Eigen::MatrixXd{data_.size(), smooth_terms + 2 * lines};
    nuisance_.col(0) = stacked((1.0 / (1.0 - q)).matrix());
    for (int power = 0; power < 3; ++power) {
      nuisance_.col(power + 1) = stacked(q.pow(power).matrix());
    }
    for (Eigen::Index k = 0; k < lines; ++k) {
      const Complex log_z = log_of({lines_hz[static_cast<std::size_t>(k)], 0.0}, spectrum.rate_hz);
      set_pair(nuisance_, smooth_terms + 2 * k, cut_exponential(log_z, spectrum));
    }
  }

  struct State {
    Eigen::VectorXd logs;    // 2 a pole
    Eigen::VectorXd shares;  // 2 a pole and the nuisance terms
    Eigen::MatrixXd basis;
    Eigen::VectorXd residual;
    double sum_of_squares{};
  };

  State at(const Eigen::VectorXd& logs) const {
    State state{logs, {}, Eigen::MatrixXd{data_.size(), 2 * poles_ + nuisance_.cols()}, {}, 0.0};
    for (Eigen::Index k = 0; k < poles_; ++k) {
      set_pair(state.basis, 2 * k, cut_exponential(log_of_pole(logs, k), spectrum_));
    }
    state.basis.rightCols(nuisance_.cols()) = nuisance_;
    if (!state.basis.allFinite()) {  // a pole that grows beyond all bounds fits nothing
      state.shares = Eigen::VectorXd::Zero(state.basis.cols());
      state.residual = data_;
      state.sum_of_squares = std::numeric_limits<double>::infinity();
      return state;
    }
    const Eigen::RowVectorXd size = state.basis.colwise().norm().cwiseMax(1e-300);
    state.shares = core::least_squares(state.basis * size.cwiseInverse().asDiagonal(), data_)
                       .solution.cwiseQuotient(size.transpose());
    state.residual = data_ - state.basis * state.shares;
    state.sum_of_squares = state.residual.squaredNorm();
    return state;
  }

  // d model / d unknowns: poles, then shares
  Eigen::MatrixXd jacobian(const State& state) const {
    Eigen::MatrixXd result{data_.size(), 4 * poles_ + nuisance_.cols()};
    for (Eigen::Index k = 0; k < poles_; ++k) {
      const Complex share{state.shares[2 * k], -state.shares[2 * k + 1]};
      const CutExponential slopes =
          cut_exponential_slope(share, log_of_pole(state.logs, k), spectrum_);
      result.col(2 * k) = stacked(slopes.plus) / length_;
      result.col(2 * k + 1) = stacked(Complex{0.0, 1.0} * slopes.minus) / length_;
    }
    result.rightCols(2 * poles_ + nuisance_.cols()) = state.basis;
    return result;
  }

  Complex log_of_pole(const Eigen::VectorXd& logs, Eigen::Index k) const {
    return {logs[2 * k] / length_, logs[2 * k + 1] / length_};
  }
  Eigen::Index unknowns() const { return 4 * poles_ + nuisance_.cols(); }
  Eigen::Index poles() const { return poles_; }
  double length() const { return length_; }
  const Eigen::VectorXd& data() const { return data_; }

 private:
  static Eigen::VectorXd stacked(const Eigen::VectorXcd& values) {
    Eigen::VectorXd all{2 * values.size()};
    all << values.real(), values.imag();
    return all;
  }
  // The columns of cosine and sine.
  static void set_pair(Eigen::MatrixXd& columns, Eigen::Index first, const CutExponential& both) {
    columns.col(first) = stacked(both.plus);
    columns.col(first + 1) = stacked(Complex{0.0, -1.0} * both.minus);
  }

  const BandSpectrum& spectrum_;
  Eigen::Index poles_;
  double length_;
  Eigen::VectorXd data_;
  Eigen::MatrixXd nuisance_;
};

struct Normal {
  Eigen::MatrixXd matrix;  // J'J of columns of unit length
  Eigen::VectorXd slope;
  Eigen::VectorXd size;
};
Normal normal_equations(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residual) {
  const Eigen::VectorXd size = jacobian.colwise().norm().cwiseMax(1e-300).transpose();
  const Eigen::MatrixXd scaled = jacobian * size.cwiseInverse().asDiagonal();
  return {scaled.transpose() * scaled, scaled.transpose() * residual, size};
}

// Steps until the sum of squares settles. True if it did.
bool descend(const DecayModel& model, DecayModel::State& state) {
  double damping = 1e-3;
  for (int step = 0; step < max_steps; ++step) {
    const Normal normal = normal_equations(model.jacobian(state), state.residual);
    Eigen::MatrixXd damped = normal.matrix;
    damped.diagonal().array() += damping;
    const Eigen::VectorXd move =
        Eigen::LDLT<Eigen::MatrixXd>{damped}.solve(normal.slope).cwiseQuotient(normal.size);
    const Eigen::VectorXd pole_move = move.head(2 * model.poles());
    DecayModel::State next = model.at(state.logs + pole_move);
    if (!(next.sum_of_squares <= state.sum_of_squares)) {
      damping *= 8.0;
      if (damping > 1e8) {
        return true;  // no direction leads down
      }
      continue;
    }
    const double gain = state.sum_of_squares - next.sum_of_squares;
    const bool is_settled = gain <= 1e-7 * state.sum_of_squares;
    state = std::move(next);
    damping = std::max(damping / 5.0, 1e-12);
    if (is_settled) {
      return true;
    }
  }
  return false;
}

FittedMode mode_of(const DecayModel& model, const DecayModel::State& state,
                   const Eigen::MatrixXd& covariance, double rate_hz, Eigen::Index k) {
  const Complex log_z = model.log_of_pole(state.logs, k);
  const double a = state.shares[2 * k];
  const double b = state.shares[2 * k + 1];
  FittedMode mode;
  mode.pole = pole_of(log_z, rate_hz);
  mode.amplitude = std::hypot(a, b);
  mode.phase_rad = std::atan2(-b, a);
  const Eigen::Index row = 2 * k;
  const Eigen::Matrix2d of_log =
      covariance.block<2, 2>(row, row) / (model.length() * model.length());
  const double size = std::abs(log_z);
  const Eigen::Vector2d frequency_slope{log_z.real() / size, log_z.imag() / size};
  // d(-Re / |s|)
  const double cube = size * size * size;
  const Eigen::Vector2d ratio_slope{-log_z.imag() * log_z.imag() / cube,
                                    log_z.real() * log_z.imag() / cube};
  const auto error = [](const auto& slope, const auto& matrix) {
    return std::sqrt(std::max(0.0, slope.dot(matrix * slope)));
  };
  mode.frequency_error_hz = error(frequency_slope, of_log) * rate_hz / (2.0 * std::numbers::pi);
  mode.ratio_error = error(ratio_slope, of_log);
  mode.decay_error_per_s = std::sqrt(std::max(0.0, of_log(0, 0))) * rate_hz;
  const Eigen::Index share = 2 * model.poles() + 2 * k;
  const Eigen::Matrix2d of_share = covariance.block<2, 2>(share, share);
  const Eigen::Vector2d parts{a, b};
  const double amplitude = std::max(mode.amplitude, 1e-300);
  mode.amplitude_error = error(Eigen::Vector2d{a / amplitude, b / amplitude}, of_share);
  mode.phase_error_rad =
      error(Eigen::Vector2d{-b / amplitude, a / amplitude}, of_share) / amplitude;
  mode.significance = parts.dot(of_share.ldlt().solve(parts));
  return mode;
}
}  // namespace

DecayFit fit_decay(const BandSpectrum& spectrum, const std::vector<Pole>& start,
                   const std::vector<double>& lines_hz) {
  const DecayModel model{spectrum, static_cast<Eigen::Index>(start.size()), lines_hz};
  const double freedom = static_cast<double>(model.data().size() - model.unknowns());
  if (freedom < 1.0) {
    throw core::InvalidInput{"a decay is too short for so many modes"};
  }
  Eigen::VectorXd logs{2 * model.poles()};
  for (Eigen::Index k = 0; k < model.poles(); ++k) {
    const Complex log_z = log_of(start[static_cast<std::size_t>(k)], spectrum.rate_hz);
    logs.segment<2>(2 * k) << log_z.real() * model.length(), log_z.imag() * model.length();
  }
  DecayModel::State state = model.at(logs);
  DecayFit fit;
  fit.has_converged = start.empty() || descend(model, state);
  const Normal normal = normal_equations(model.jacobian(state), state.residual);
  const double variance = state.sum_of_squares / freedom;
  const Eigen::VectorXd scale = normal.size.cwiseInverse();
  const Eigen::MatrixXd inverse = core::pseudo_inverse(normal.matrix) * variance;
  const Eigen::MatrixXd covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
  for (Eigen::Index k = 0; k < model.poles(); ++k) {
    fit.modes.push_back(mode_of(model, state, covariance, spectrum.rate_hz, k));
  }
  // a bin's real and imaginary parts have half of N sigma^2 each
  fit.noise = std::sqrt(2.0 * variance / model.length());
  fit.explained = 1.0 - state.sum_of_squares / std::max(model.data().squaredNorm(), 1e-300);
  fit.degrees_of_freedom = freedom;
  const Eigen::VectorXd all = state.basis * state.shares;
  fit.fitted = all.head(all.size() / 2) + Complex{0.0, 1.0} * all.tail(all.size() / 2);
  return fit;
}
}  // namespace tapstudy::analysis
