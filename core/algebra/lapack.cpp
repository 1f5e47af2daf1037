#include "core/algebra/lapack.hpp"

#include <fmt/format.h>
#include <lapacke.h>

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/algebra/blas.hpp"
#include "core/algebra/dense_solvers.hpp"
#include "core/error.hpp"
namespace tapstudy::core {
namespace {
lapack_int as_lapack_int(Eigen::Index size) {
  return static_cast<lapack_int>(size);
}

constexpr const char* eigenproblem = "the dense eigenvalue solver";

// LAPACK: info > 0 indicates where the routine failed, info < 0 an argument that is not a number.
void check(lapack_int info, const char* problem, const char* routine) {
  if (info != 0) {
    throw ModelError{
        fmt::format("{} failed (LAPACK {}, info {})", problem, routine, static_cast<int>(info))};
  }
}
}  // namespace

// Divide and conquer: with all vectors several times quicker than the QR iteration of dsyev.
EigenPairs symmetric_eigenpairs(Eigen::MatrixXd A) {
  EigenPairs pairs{Eigen::VectorXd{A.rows()}, std::move(A)};
  const lapack_int n = as_lapack_int(pairs.values.size());
  if (n > 0) {
    check(
        LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', n, pairs.vectors.data(), n, pairs.values.data()),
        eigenproblem, "dsyevd");
  }
  return pairs;
}

EigenPairs symmetric_eigenpairs(Eigen::MatrixXd A, Eigen::MatrixXd B) {
  EigenPairs pairs{Eigen::VectorXd{A.rows()}, std::move(A)};
  const lapack_int n = as_lapack_int(pairs.values.size());
  constexpr lapack_int a_x_is_lambda_b_x = 1;
  if (n > 0) {
    check(LAPACKE_dsygv(LAPACK_COL_MAJOR, a_x_is_lambda_b_x, 'V', 'L', n, pairs.vectors.data(), n,
                        B.data(), n, pairs.values.data()),
          eigenproblem, "dsygv");
  }
  return pairs;
}

namespace {
// The lower half of A becomes the reflectors' vectors; their factors are returned. OpenBLAS' dsymv,
// whose results lie in both arrays here, reads some numbers beyond them.
Eigen::VectorXd to_tridiagonal(Eigen::MatrixXd& A, Eigen::VectorXd& diagonal,
                               Eigen::VectorXd& beside) {
  constexpr lapack_int read_ahead = 16;
  const lapack_int n = as_lapack_int(A.rows());
  Eigen::VectorXd factors = Eigen::VectorXd::Zero(n + read_ahead);
  const auto reduce = [&](double* work, lapack_int size) {
    check(LAPACKE_dsytrd_work(LAPACK_COL_MAJOR, 'L', n, A.data(), n, diagonal.data(), beside.data(),
                              factors.data(), work, size),
          eigenproblem, "dsytrd");
  };
  double wanted = 0.0;
  reduce(&wanted, -1);
  Eigen::VectorXd work = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(wanted) + read_ahead);
  reduce(work.data(), static_cast<lapack_int>(wanted));
  return factors;
}
}  // namespace

// One tridiagonal matrix for both: its eigenvalues, and the vectors of some by inverse iteration,
// take a small part of the time that all vectors take.
EigenPairs largest_eigenpairs(Eigen::MatrixXd A, Eigen::Index count) {
  const lapack_int n = as_lapack_int(A.rows());
  EigenPairs pairs{Eigen::VectorXd{A.rows()}, Eigen::MatrixXd{A.rows(), count}};
  if (n == 0 || count == 0) {
    return n == 0 ? pairs : EigenPairs{symmetric_eigenpairs(std::move(A)).values, pairs.vectors};
  }
  const Eigen::MatrixXd whole = A;
  Eigen::VectorXd diagonal{n};
  Eigen::VectorXd beside = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd reflectors = to_tridiagonal(A, diagonal, beside);
  pairs.values = diagonal;
  Eigen::VectorXd of_values = beside;
  check(LAPACKE_dsterf(n, pairs.values.data(), of_values.data()), eigenproblem, "dsterf");
  const lapack_int wanted = as_lapack_int(count);
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(n);  // dstein's W, of which it uses the first
  largest.head(count) = pairs.values.tail(count);
  const std::vector<lapack_int> one_block(static_cast<std::size_t>(n), 1);
  std::vector<lapack_int> ends(static_cast<std::size_t>(n), n);  // of blocks
  std::vector<lapack_int> failed(static_cast<std::size_t>(count));
  if (LAPACKE_dstein(LAPACK_COL_MAJOR, n, diagonal.data(), beside.data(), wanted, largest.data(),
                     one_block.data(), ends.data(), pairs.vectors.data(), n, failed.data()) != 0) {
    EigenPairs all = symmetric_eigenpairs(whole);
    return {std::move(all.values), all.vectors.rightCols(count)};
  }
  check(LAPACKE_dormtr(LAPACK_COL_MAJOR, 'L', 'L', 'N', n, wanted, A.data(), n, reflectors.data(),
                       pairs.vectors.data(), n),
        eigenproblem, "dormtr");
  return pairs;
}

Eigen::VectorXcd eigenvalues(Eigen::MatrixXd A) {
  const lapack_int n = as_lapack_int(A.rows());
  Eigen::VectorXd real{A.rows()};
  Eigen::VectorXd imaginary{A.rows()};
  if (n > 0) {
    check(LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, A.data(), n, real.data(), imaginary.data(),
                        nullptr, 1, nullptr, 1),
          eigenproblem, "dgeev");
  }
  Eigen::VectorXcd values{A.rows()};
  values.real() = real;
  values.imag() = imaginary;
  return values;
}

namespace {
// Where it has one beyond doubt: by Cholesky's factors of the matrix with a unit diagonal.
std::optional<Eigen::MatrixXd> inverse_of(const Eigen::MatrixXd& A) {
  constexpr double dependent = 1e-9;  // what is left of a column of unit length, squared
  const lapack_int n = as_lapack_int(A.rows());
  const Eigen::VectorXd per_size = A.diagonal().cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = per_size.asDiagonal() * A * per_size.asDiagonal();
  if (n == 0 || !scaled.allFinite() ||
      LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, scaled.data(), n) != 0 ||
      !(scaled.diagonal().array().square().minCoeff() > dependent) ||
      LAPACKE_dpotri(LAPACK_COL_MAJOR, 'L', n, scaled.data(), n) != 0) {
    return std::nullopt;
  }
  const Eigen::MatrixXd inverse = scaled.selfadjointView<Eigen::Lower>();
  return per_size.asDiagonal() * inverse * per_size.asDiagonal();
}
}  // namespace

Eigen::MatrixXd pseudo_inverse(Eigen::MatrixXd A) {
  if (std::optional<Eigen::MatrixXd> inverse = inverse_of(A)) {
    return std::move(*inverse);
  }
  const EigenPairs pairs = symmetric_eigenpairs(std::move(A));
  const double largest = pairs.values.size() > 0 ? pairs.values.cwiseAbs().maxCoeff() : 0.0;
  const double negligible =
      static_cast<double>(pairs.values.size()) * std::numeric_limits<double>::epsilon() * largest;
  const Eigen::VectorXd inverses =
      pairs.values.unaryExpr([&](double value) { return value > negligible ? 1.0 / value : 0.0; });
  return pairs.vectors * inverses.asDiagonal() * pairs.vectors.transpose();
}

namespace {
// Corrected seminormal equations (Björck 1987), with Cholesky's factors of A'A for those of A: as
// exact as orthogonal factors while the columns are far from dependent, and several times quicker.
std::optional<Eigen::VectorXd> by_normal_equations(const Eigen::MatrixXd& A,
                                                   const Eigen::MatrixXd& gram_of_a,
                                                   const Eigen::VectorXd& b) {
  constexpr double dependent = 1e-8;  // what is left of a column of unit length, squared
  const Eigen::VectorXd per_size = gram_of_a.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = per_size.asDiagonal() * gram_of_a * per_size.asDiagonal();
  const SymmetricFactors factors{scaled};
  if (!scaled.allFinite() || !factors.succeeded() || !(factors.pivots().minCoeff() > dependent)) {
    return std::nullopt;
  }
  const auto solved = [&](const Eigen::VectorXd& of) -> Eigen::VectorXd {
    return per_size.cwiseProduct(factors.solve(per_size.cwiseProduct(A.transpose() * of)));
  };
  const Eigen::VectorXd solution = solved(b);
  return solution + solved(b - A * solution);
}

LeastSquares by_orthogonal_factors(Eigen::MatrixXd A, Eigen::VectorXd b) {
  const lapack_int rows = as_lapack_int(A.rows());
  const lapack_int columns = as_lapack_int(A.cols());
  std::vector<lapack_int> pivots(static_cast<std::size_t>(columns), 0);
  const double least_share = static_cast<double>(rows) * std::numeric_limits<double>::epsilon();
  lapack_int rank = 0;
  check(LAPACKE_dgelsy(LAPACK_COL_MAJOR, rows, columns, 1, A.data(), rows, b.data(), rows,
                       pivots.data(), least_share, &rank),
        "the least-squares fit", "dgelsy");
  return {b.head(columns), static_cast<int>(rank)};
}
}  // namespace

LeastSquares least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& gram,
                           const Eigen::VectorXd& b) {
  if (const std::optional<Eigen::VectorXd> solution = by_normal_equations(A, gram, b)) {
    return {*solution, static_cast<int>(A.cols())};
  }
  const Eigen::VectorXd size = A.colwise().norm().cwiseMax(1e-300).transpose();
  const LeastSquares found = by_orthogonal_factors(A * size.cwiseInverse().asDiagonal(), b);
  return {found.solution.cwiseQuotient(size), found.rank};
}

LeastSquares least_squares(Eigen::MatrixXd A, Eigen::VectorXd b) {
  const std::optional<Eigen::VectorXd> solution = by_normal_equations(A, gram(A), b);
  return solution ? LeastSquares{*solution, static_cast<int>(A.cols())}
                  : by_orthogonal_factors(std::move(A), std::move(b));
}
}  // namespace tapstudy::core
