#include "analysis/modal/response/residue_shapes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace tapstudy::analysis {
namespace {
using Complex = std::complex<double>;
}

Eigen::VectorXcd shape_of(const Eigen::VectorXcd& residues, const ResponseGrid& grid) {
  const auto outputs = std::ssize(grid.columns);
  const auto inputs = std::ssize(grid.columns.front());
  Eigen::MatrixXcd matrix(outputs, inputs);
  for (Eigen::Index o = 0; o < outputs; ++o) {
    matrix.row(o) = residues(grid.columns[static_cast<std::size_t>(o)]).transpose();
  }
  // power iteration for the first singular vectors, from the input that shows most of the mode
  Eigen::Index strongest = 0;
  matrix.colwise().squaredNorm().maxCoeff(&strongest);
  Eigen::VectorXcd shape = matrix.col(strongest);
  constexpr int iterations = 50;
  for (int i = 0; i < iterations && inputs > 1; ++i) {
    const Eigen::VectorXcd input = matrix.adjoint() * shape;
    shape = matrix * input / input.norm();
  }
  Eigen::Index largest = 0;
  shape.cwiseAbs().maxCoeff(&largest);
  // the phase in which the sum of squares is real and positive
  const Complex squares = shape.array().square().sum();
  shape *= std::polar(1.0 / std::abs(shape[largest]), -0.5 * std::arg(squares));
  return shape[largest].real() < 0.0 ? Eigen::VectorXcd{-shape} : shape;
}

double phase_collinearity(const Eigen::VectorXcd& shape) {
  const double real = shape.real().squaredNorm();
  const double imaginary = shape.imag().squaredNorm();
  const double both = shape.real().dot(shape.imag());
  const double sum = real + imaginary;
  return sum > 0.0 ? ((real - imaginary) * (real - imaginary) + 4.0 * both * both) / (sum * sum)
                   : 1.0;
}

namespace {
// Frequencies, in words, of the modes whose residues of one response are imaginary beyond doubt.
struct SignsOfResidues {
  std::vector<std::string> negative;
  std::vector<std::string> positive;
};

SignsOfResidues signs_of_residues(const ResidueFit& fit, Eigen::Index response) {
  constexpr double errors = 3.0;
  SignsOfResidues signs;
  for (std::size_t mode = 0; mode < fit.poles.size(); ++mode) {
    const auto row = static_cast<Eigen::Index>(mode);
    const Complex residue = fit.residues(row, response);
    if (std::abs(residue.imag()) > errors * fit.residue_errors(row, response) &&
        std::abs(residue.imag()) > std::abs(residue.real())) {
      (residue.imag() < 0.0 ? signs.negative : signs.positive)
          .push_back(fmt::format("{:.5g}", std::abs(fit.poles[mode]) / (2.0 * std::numbers::pi)));
    }
  }
  return signs;
}

// Empty: all is as it must be.
std::string remark_on_driving_point(const ResponsePair& places, const SignsOfResidues& signs) {
  if (signs.positive.empty()) {
    return "";
  }
  if (signs.negative.empty()) {
    return fmt::format(
        "driving point {}: motion and force have opposite signs in all modes (is one of the "
        "sensors turned round?)",
        name(places));
  }
  const bool is_positive_rare = signs.positive.size() <= signs.negative.size();
  return fmt::format(
      "driving point {}: the residues at {} Hz have another sign than those of the other modes, "
      "which the motion where the force acts cannot have: is it the same place?",
      name(places), fmt::join(is_positive_rare ? signs.positive : signs.negative, ", "));
}
}  // namespace

void add_driving_point_remarks(const ResidueFit& fit, ResponseModes& found) {
  for (std::size_t pair = 0; pair < found.measured.pairs.size(); ++pair) {
    const ResponsePair& places = found.measured.pairs[pair];
    if (places.response == places.reference) {
      const std::string remark =
          remark_on_driving_point(places, signs_of_residues(fit, static_cast<Eigen::Index>(pair)));
      if (!remark.empty()) {
        found.remarks.push_back(remark);
      }
    }
  }
}
}  // namespace tapstudy::analysis
