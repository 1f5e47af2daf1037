#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "results/export/bids_sidecars.hpp"
#include "results/store.hpp"
namespace tapstudy::results {
// Of one session, the changes of its state while it was at one block, as an _events.tsv. What
// belongs to no trial (instructions, a pause) is of the block that follows, at the end of the last.
// Onsets are from the session's begin. Why a session stopped or faulted is left out.
struct BlockEvents {
  std::string participant;
  std::int64_t session{};
  std::string block;
  std::string table;
};
std::vector<BlockEvents> events_of_blocks(Store& store);
std::vector<DescribedColumn> event_columns();
}  // namespace tapstudy::results
