#include "results/trace_codec.hpp"

#include <zstd.h>

#include <array>
#include <bit>
#include <cstring>

#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
using core::TraceSample;
using Word = std::uint64_t;
constexpr std::size_t words = 19;  // time and eighteen numbers
constexpr std::size_t flags = 5;
constexpr std::size_t bytes_per_tick = words * sizeof(Word) + flags;
constexpr int compression_level = 1;

struct Packed {
  std::array<Word, words> word;
  std::array<std::uint8_t, flags> flag;
};

Packed packed(const TraceSample& s) {
  const auto bits = [](double x) { return std::bit_cast<Word>(x); };
  return {
      {static_cast<Word>(s.t_ns), bits(s.position_m[0]), bits(s.position_m[1]),
       bits(s.position_m[2]), bits(s.velocity_m_s[0]), bits(s.velocity_m_s[1]),
       bits(s.velocity_m_s[2]), bits(s.penetration_m), bits(s.penalty_n), bits(s.vibration_n),
       bits(s.sinusoid_n), bits(s.force_n[0]), bits(s.force_n[1]), bits(s.force_n[2]),
       bits(s.achieved_n[0]), bits(s.achieved_n[1]), bits(s.achieved_n[2]), bits(s.pose_residual_m),
       bits(s.closure_margin)},
      {s.alternative, static_cast<std::uint8_t>(s.touching), static_cast<std::uint8_t>(s.struck),
       static_cast<std::uint8_t>(s.saturated), static_cast<std::uint8_t>(s.fault)}};
}

TraceSample unpacked(const Packed& p) {
  const auto number = [&](std::size_t i) { return std::bit_cast<double>(p.word.at(i)); };
  return {static_cast<std::int64_t>(p.word[0]),
          {number(1), number(2), number(3)},
          {number(4), number(5), number(6)},
          number(7),
          number(8),
          number(9),
          number(10),
          {number(11), number(12), number(13)},
          {number(14), number(15), number(16)},
          number(17),
          number(18),
          p.flag[0],
          p.flag[1] != 0,
          p.flag[2] != 0,
          p.flag[3] != 0,
          static_cast<core::TickFault>(p.flag[4])};
}

// The columns side by side: for each, all lowest bytes, then all second lowest, and so on.
class Planes {
 public:
  explicit Planes(std::size_t ticks) : ticks_{ticks}, bytes_(ticks * bytes_per_tick) {}
  explicit Planes(std::size_t ticks, std::vector<std::byte> bytes)
      : ticks_{ticks}, bytes_{std::move(bytes)} {}
  std::span<std::byte> of_word(std::size_t column, std::size_t place) {
    return plane(column * sizeof(Word) + place);
  }
  std::span<std::byte> of_flag(std::size_t column) { return plane(words * sizeof(Word) + column); }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::span<std::byte> plane(std::size_t index) {
    return std::span{bytes_}.subspan(index * ticks_, ticks_);
  }
  std::size_t ticks_;
  std::vector<std::byte> bytes_;
};

// What a column's words change by from tick to tick: time by subtraction, numbers by exclusive or.
std::vector<Word> changes(const std::vector<Packed>& samples, std::size_t column) {
  std::vector<Word> changes;
  changes.reserve(samples.size());
  Word before = 0;
  for (const Packed& sample : samples) {
    const Word now = sample.word[column];
    changes.push_back(column == 0 ? now - before : now ^ before);
    before = now;
  }
  return changes;
}

std::vector<std::byte> compressed(const std::vector<std::byte>& plain) {
  std::vector<std::byte> bytes(ZSTD_compressBound(plain.size()));
  const std::size_t size =
      ZSTD_compress(bytes.data(), bytes.size(), plain.data(), plain.size(), compression_level);
  if (ZSTD_isError(size) != 0U) {
    throw StoreError{std::string{"trace: compression failed: "} + ZSTD_getErrorName(size)};
  }
  bytes.resize(size);
  return bytes;
}

// The chunk itself says how large it is: a damaged row must not ask for all memory there is.
std::vector<std::byte> decompressed(std::span<const std::byte> bytes, std::size_t size) {
  if (ZSTD_getFrameContentSize(bytes.data(), bytes.size()) != size) {
    throw StoreError{"trace: a chunk does not hold the ticks that it should"};
  }
  std::vector<std::byte> plain(size);
  const std::size_t found = ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(found) != 0U || found != size) {
    throw StoreError{"trace: a chunk does not hold the ticks that it should"};
  }
  return plain;
}
}  // namespace

std::vector<std::byte> encode_trace(std::span<const TraceSample> samples) {
  std::vector<Packed> rows;
  rows.reserve(samples.size());
  for (const TraceSample& sample : samples) {
    rows.push_back(packed(sample));
  }
  Planes planes{samples.size()};
  for (std::size_t column = 0; column < words; ++column) {
    const std::vector<Word> column_changes = changes(rows, column);
    for (std::size_t place = 0; place < sizeof(Word); ++place) {
      const std::span<std::byte> plane = planes.of_word(column, place);
      for (std::size_t tick = 0; tick < rows.size(); ++tick) {
        plane[tick] = static_cast<std::byte>(column_changes[tick] >> (8 * place));
      }
    }
  }
  for (std::size_t column = 0; column < flags; ++column) {
    const std::span<std::byte> plane = planes.of_flag(column);
    for (std::size_t tick = 0; tick < rows.size(); ++tick) {
      plane[tick] = static_cast<std::byte>(rows[tick].flag[column]);
    }
  }
  return compressed(planes.bytes());
}

std::vector<TraceSample> decode_trace(std::span<const std::byte> bytes, std::size_t ticks) {
  Planes planes{ticks, decompressed(bytes, ticks * bytes_per_tick)};
  std::vector<Packed> rows(ticks);
  for (std::size_t column = 0; column < words; ++column) {
    for (std::size_t place = 0; place < sizeof(Word); ++place) {
      const std::span<const std::byte> plane = planes.of_word(column, place);
      for (std::size_t tick = 0; tick < ticks; ++tick) {
        rows[tick].word[column] |= std::to_integer<Word>(plane[tick]) << (8 * place);
      }
    }
    for (std::size_t tick = 1; tick < ticks; ++tick) {
      Word& now = rows[tick].word[column];
      const Word before = rows[tick - 1].word[column];
      now = column == 0 ? before + now : before ^ now;
    }
  }
  for (std::size_t column = 0; column < flags; ++column) {
    const std::span<const std::byte> plane = planes.of_flag(column);
    for (std::size_t tick = 0; tick < ticks; ++tick) {
      rows[tick].flag[column] = std::to_integer<std::uint8_t>(plane[tick]);
    }
  }
  std::vector<TraceSample> samples;
  samples.reserve(ticks);
  for (const Packed& row : rows) {
    samples.push_back(unpacked(row));
  }
  return samples;
}
}  // namespace tapstudy::results
