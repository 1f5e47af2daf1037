#pragma once
#include <optional>

#include "analysis/rank_tests/friedman.hpp"
#include "analysis/tables/cells.hpp"
namespace tapstudy::analysis {
// "friedman": one row, none without a test.
ReportTable friedman_table(const std::optional<FriedmanTest>& test, std::size_t participants);
}  // namespace tapstudy::analysis
