#include "results/trace_stream.hpp"

#include <fmt/format.h>

#include "results/trace_codec.hpp"
namespace tapstudy::results {
std::vector<core::TraceSample> decoded_chunk(Statement& row, int column, const std::string& what) {
  const std::string codec = row.text(column);
  if (codec != trace_codec) {
    throw StoreError{
        fmt::format("{} is encoded as '{}' (this program reads {})", what, codec, trace_codec)};
  }
  return decode_trace(row.bytes(column + 2), static_cast<std::size_t>(row.integer(column + 1)),
                      what);
}

void each_trace_chunk(Store& store, const TakeChunk& take) {
  store.each_row(
      "SELECT trial_id, codec, ticks, bytes FROM trace_chunk ORDER BY trial_id, first_tick",
      [&](Statement& row) {
        const std::int64_t trial_id = row.integer(0);
        take(trial_id, decoded_chunk(row, 1, fmt::format("trace of trial {}", trial_id)));
      });
}
}  // namespace tapstudy::results
