#include "core/model/modes/shifted_factor.hpp"

#include <dmumps_c.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "core/error.hpp"
namespace tapstudy::core {
namespace {
// MUMPS numbers its controls from 1 and acts by job numbers.
constexpr int icntl_error_stream = 0;
constexpr int icntl_diagnostics = 1;
constexpr int icntl_statistics = 2;
constexpr int icntl_print_level = 3;
constexpr int icntl_ordering = 6;
constexpr int icntl_scaling = 7;
constexpr int icntl_workspace_percent = 13;
constexpr int ordering_by_minimum_fill = 2;
constexpr int ordering_by_pord = 4;
constexpr Eigen::Index small_size = 30'000;
constexpr int icntl_blocks = 14;
constexpr int job_begin = -1;
constexpr int job_end = -2;
constexpr int job_analyse = 1;
constexpr int job_factorise = 2;
constexpr int job_solve = 3;
constexpr int symmetric_indefinite = 2;
constexpr int use_comm_world = -987654;
constexpr int infog_status = 0;
constexpr int infog_detail = 1;
constexpr int infog_negative_pivots = 11;
constexpr int infog_estimated_megabytes = 15;
constexpr int status_workspace_small = -9;
constexpr int status_workspace_small_too = -8;
constexpr int status_singular = -10;
constexpr std::array<int, 5> statuses_without_memory{-5, -7, -13, status_workspace_small,
                                                     status_workspace_small_too};
constexpr int max_workspace_percent = 640;

double machine_megabytes() {
  return 1e-6 * static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
         static_cast<double>(sysconf(_SC_PAGESIZE));
}
}  // namespace

struct ShiftedFactor::Mumps {
  DMUMPS_STRUC_C id{};
  std::vector<int> rows;     // from 1
  std::vector<int> columns;  // from 1
  std::vector<double> values;
  std::vector<int> blocks;  // from 1

  Mumps(const SparseMatrix& lower, const std::vector<int>& first_of_block) {
    const auto entries = static_cast<std::size_t>(lower.nonZeros());
    rows.reserve(entries);
    columns.reserve(entries);
    values.reserve(entries);
    for (Eigen::Index column = 0; column < lower.outerSize(); ++column) {
      for (SparseMatrix::InnerIterator entry{lower, column}; entry; ++entry) {
        rows.push_back(static_cast<int>(entry.row()) + 1);
        columns.push_back(static_cast<int>(entry.col()) + 1);
        values.push_back(entry.value());
      }
    }
    id.par = 1;
    id.sym = symmetric_indefinite;
    id.comm_fortran = use_comm_world;
    run(job_begin);
    id.icntl[icntl_error_stream] = 0;  // errors are reported below
    id.icntl[icntl_diagnostics] = 0;
    id.icntl[icntl_statistics] = 0;
    id.icntl[icntl_print_level] = 0;
    // Scotch, the default, is randomised: factors and modes would differ in their last digits.
    // Nested dissection takes longer than minimum fill, but pays off for large models.
    id.icntl[icntl_ordering] =
        lower.rows() < small_size ? ordering_by_minimum_fill : ordering_by_pord;
    id.icntl[icntl_scaling] = 0;  // all stiffness entries have the same unit
    if (!first_of_block.empty()) {
      std::ranges::transform(first_of_block, std::back_inserter(blocks),
                             [](int first) { return first + 1; });
      id.icntl[icntl_blocks] = 1;
      id.nblk = static_cast<int>(blocks.size()) - 1;
      id.blkptr = blocks.data();
    }
    id.n = static_cast<int>(lower.rows());
    id.nnz = static_cast<MUMPS_INT8>(values.size());
    id.irn = rows.data();
    id.jcn = columns.data();
    id.a = values.data();
  }
  ~Mumps() { run(job_end); }
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;
  Mumps(Mumps&&) = delete;
  Mumps& operator=(Mumps&&) = delete;

  int run(int job) {
    id.job = job;
    dmumps_c(&id);
    return id.infog[infog_status];
  }
  void check(int status, const char* what) const {
    if (std::ranges::count(statuses_without_memory, status) > 0) {
      throw ModelError{
          fmt::format("modes: {} degrees of freedom: {} ran out of memory (choose larger "
                      "elements)",
                      id.n, what)};
    }
    if (status < 0) {
      throw ModelError{
          fmt::format("modes: {} failed (MUMPS {}, {})", what, status, id.infog[infog_detail])};
    }
  }
  void analyse() {
    check(run(job_analyse), "ordering");
    const double needed = id.infog[infog_estimated_megabytes];
    if (needed > 0.8 * machine_megabytes()) {
      throw ModelError{fmt::format(
          "modes: {} degrees of freedom would take {:.1f} GB to solve, this machine has {:.1f} GB "
          "(choose larger elements)",
          id.n, 1e-3 * needed, 1e-3 * machine_megabytes())};
    }
  }
  void factorise() {
    int status = run(job_factorise);
    while ((status == status_workspace_small || status == status_workspace_small_too) &&
           id.icntl[icntl_workspace_percent] < max_workspace_percent) {
      id.icntl[icntl_workspace_percent] *= 2;
      status = run(job_factorise);
    }
    if (status == status_singular) {
      throw ModelError{
          "modes: a natural frequency coincides with the band limit (move "
          "band_limit_hz)"};
    }
    check(status, "factorising");
  }
};

ShiftedFactor::ShiftedFactor(const StiffnessAndMass& matrices, double sigma)
    : sigma_{sigma},
      mumps_{std::make_unique<Mumps>(matrices.K - sigma * matrices.M, matrices.first_of_node)} {
  mumps_->analyse();
  mumps_->factorise();
}

ShiftedFactor::~ShiftedFactor() = default;

int ShiftedFactor::eigenvalues_below() const {
  return mumps_->id.infog[infog_negative_pivots];
}

void ShiftedFactor::solve_in_place(Eigen::MatrixXd& columns) const {
  mumps_->id.rhs = columns.data();
  mumps_->id.nrhs = static_cast<int>(columns.cols());
  mumps_->id.lrhs = static_cast<int>(columns.rows());
  mumps_->check(mumps_->run(job_solve), "solving");
}
}  // namespace tapstudy::core
