#include "analysis/paired/paired_counts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
// Reached from the first item by steps (i, j) that are not 0.
std::vector<bool> reached(const Eigen::MatrixXi& steps) {
  std::vector<bool> is_reached(static_cast<std::size_t>(steps.rows()), false);
  is_reached[0] = true;
  std::vector<Eigen::Index> open{0};
  while (!open.empty()) {
    const Eigen::Index from = open.back();
    open.pop_back();
    for (Eigen::Index to = 0; to < steps.cols(); ++to) {
      const auto place = static_cast<std::size_t>(to);
      if (steps(from, to) != 0 && !is_reached[place]) {
        is_reached[place] = true;
        open.push_back(to);
      }
    }
  }
  return is_reached;
}

std::vector<std::size_t> places(const std::vector<bool>& is_member, bool wanted) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < is_member.size(); ++i) {
    if (is_member[i] == wanted) {
      found.push_back(i + 1);
    }
  }
  return found;
}

void refuse_groups(const std::vector<std::size_t>& beating,
                   const std::vector<std::size_t>& beaten) {
  if (!beating.empty() && !beaten.empty()) {
    throw core::NotEstimable{fmt::format(
        "comparisons do not connect the items: of items {}, none was ever preferred to any of "
        "items {}, so no scale holds both; leave a group out or collect more comparisons",
        fmt::join(beaten, ", "), fmt::join(beating, ", "))};
  }
}

bool is_count_matrix(const Eigen::MatrixXi& counts, Eigen::Index items) {
  return counts.rows() == items && counts.cols() == items && (counts.array() >= 0).all() &&
         (counts.diagonal().array() == 0).all();
}
}  // namespace

void check_comparisons(const PairedCounts& counts, TiesConnect ties) {
  const Eigen::Index items = counts.items();
  if (items < 2 || !is_count_matrix(counts.wins, items)) {
    throw core::InvalidInput{
        "comparisons are a square matrix of counts of at least 0 with a diagonal of 0, of two "
        "items or more"};
  }
  const bool has_ties = counts.ties.size() != 0;
  if (has_ties &&
      (!is_count_matrix(counts.ties, items) || counts.ties != counts.ties.transpose())) {
    throw core::InvalidInput{
        "ties are a symmetric matrix of counts of at least 0 with a diagonal of 0, of as many "
        "items as the comparisons"};
  }
  Eigen::MatrixXi steps = counts.wins;
  if (has_ties && ties == TiesConnect::yes) {
    steps += counts.ties;
  }
  const std::vector<bool> below_first = reached(steps);
  refuse_groups(places(below_first, false), places(below_first, true));
  const std::vector<bool> above_first = reached(steps.transpose());
  refuse_groups(places(above_first, true), places(above_first, false));
}
}  // namespace tapstudy::analysis
