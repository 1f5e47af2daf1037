#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "results/store.hpp"
namespace tapstudy::results {
using TakeChunk = std::function<void(std::int64_t trial_id, std::span<const core::TraceSample>)>;

// Every trace of a study in one pass, trials by id, each in order of time: one chunk (4096 ticks)
// is held at a time. Throws StoreError if a chunk cannot be decoded.
void each_trace_chunk(Store& store, const TakeChunk& take);

// The samples of a row of trace_chunk, whose columns from this one on are codec, ticks and bytes.
// Throws StoreError, naming `what` they are, if they are of another codec or cannot be decoded.
std::vector<core::TraceSample> decoded_chunk(Statement& row, int column, const std::string& what);
}  // namespace tapstudy::results
