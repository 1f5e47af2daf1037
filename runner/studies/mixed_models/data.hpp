#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "protocols/protocol.hpp"
#include "results/export/table.hpp"
#include "results/rows.hpp"
#include "results/store/store.hpp"
namespace tapstudy::runner {
// Fewer do not tell how people differ; the script of R says the same.
inline constexpr std::size_t fewest_modelled_participants = 5;

// What mixed models are fitted to: how often each participant gave each answer in each condition of
// a block (right or wrong, where neither procedures choose what is presented; or a step of a
// rating), and participants' thresholds and other ratios of blocks that measure the same. Sessions
// in which a block is done again are one block. Columns besides the answers are predictors: group,
// session, condition, technique, factor_NAME; missing where a block has no such predictor. nullopt
// where there is nothing to fit: no such block, or too few participants.
std::optional<results::Table> mixed_models_data(
    const protocols::Protocol& protocol, const std::vector<results::AnswerRow>& answers,
    const std::vector<std::shared_ptr<const analysis::BlockSummary>>& blocks,
    const std::vector<results::SessionRow>& sessions);
// The same of a store, for the participants that its report would be of.
std::optional<results::Table> stored_mixed_models_data(results::Store& store,
                                                       const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
