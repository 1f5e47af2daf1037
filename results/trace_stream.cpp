#include "results/trace_stream.hpp"

#include <fmt/format.h>

#include "results/trace_codec.hpp"
namespace tapstudy::results {
void each_trace_chunk(Store& store, const TakeChunk& take) {
  store.each_row("SELECT trial_id, ticks, bytes FROM trace_chunk ORDER BY trial_id, first_tick",
                 [&](Statement& row) {
                   const std::int64_t trial_id = row.integer(0);
                   take(trial_id,
                        decode_trace(row.bytes(2), static_cast<std::size_t>(row.integer(1)),
                                     fmt::format("trace of trial {}", trial_id)));
                 });
}
}  // namespace tapstudy::results
