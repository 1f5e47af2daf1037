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
constexpr std::size_t words = 14;  // time and thirteen numbers
constexpr std::size_t flags = 5;
constexpr std::size_t bytes_per_tick = words * sizeof(Word) + flags;
constexpr int compression_level = 1;

struct Packed {
  std::array<Word, words> word;
  std::array<std::uint8_t, flags> flag;
};

Packed packed(const TraceSample& s) {
  const auto bits = [](double x) { return std::bit_cast<Word>(x); };
  return {{static_cast<Word>(s.t_ns), bits(s.position_m[0]), bits(s.position_m[1]),
           bits(s.position_m[2]), bits(s.velocity_m_s[0]), bits(s.velocity_m_s[1]),
           bits(s.velocity_m_s[2]), bits(s.penetration_m), bits(s.penalty_n), bits(s.vibration_n),
           bits(s.sinusoid_n), bits(s.force_n[0]), bits(s.force_n[1]), bits(s.force_n[2])},
          {s.alternative, static_cast<std::uint8_t>(s.touching),
           static_cast<std::uint8_t>(s.struck), static_cast<std::uint8_t>(s.saturated),
           static_cast<std::uint8_t>(s.fault)}};
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
          p.flag[0],
          p.flag[1] != 0,
          p.flag[2] != 0,
          p.flag[3] != 0,
          static_cast<core::TickFault>(p.flag[4])};
}

Word difference(std::size_t column, Word now, Word before) {
  return column == 0 ? now - before : now ^ before;
}
Word restored(std::size_t column, Word change, Word before) {
  return column == 0 ? before + change : before ^ change;
}
std::byte byte_of(Word word, std::size_t place) {
  return static_cast<std::byte>(word >> (8 * place));
}

void shuffle_words(const Packed& change, std::size_t tick, std::size_t ticks,
                   std::vector<std::byte>& planes) {
  for (std::size_t column = 0; column < words; ++column) {
    for (std::size_t place = 0; place < sizeof(Word); ++place) {
      planes[(column * sizeof(Word) + place) * ticks + tick] = byte_of(change.word[column], place);
    }
  }
  for (std::size_t column = 0; column < flags; ++column) {
    planes[(words * sizeof(Word) + column) * ticks + tick] =
        static_cast<std::byte>(change.flag[column]);
  }
}
}  // namespace

std::vector<std::byte> encode_trace(std::span<const TraceSample> samples) {
  std::vector<std::byte> planes(samples.size() * bytes_per_tick);
  Packed before{};
  for (std::size_t tick = 0; tick < samples.size(); ++tick) {
    const Packed now = packed(samples[tick]);
    Packed change = now;
    for (std::size_t column = 0; column < words; ++column) {
      change.word[column] = difference(column, now.word[column], before.word[column]);
    }
    shuffle_words(change, tick, samples.size(), planes);
    before = now;
  }
  std::vector<std::byte> bytes(ZSTD_compressBound(planes.size()));
  const std::size_t size = ZSTD_compress(bytes.data(), bytes.size(), planes.data(), planes.size(),
                                         compression_level);
  if (ZSTD_isError(size) != 0U) {
    throw StoreError{std::string{"trace: compression failed: "} + ZSTD_getErrorName(size)};
  }
  bytes.resize(size);
  return bytes;
}

std::vector<TraceSample> decode_trace(std::span<const std::byte> bytes, std::size_t ticks) {
  std::vector<std::byte> planes(ticks * bytes_per_tick);
  const std::size_t size =
      ZSTD_decompress(planes.data(), planes.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(size) != 0U || size != planes.size()) {
    throw StoreError{"trace: a chunk does not hold the ticks that it should"};
  }
  const auto plane = [&](std::size_t index, std::size_t tick) {
    return std::to_integer<Word>(planes[index * ticks + tick]);
  };
  std::vector<TraceSample> samples;
  samples.reserve(ticks);
  Packed now{};
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    for (std::size_t column = 0; column < words; ++column) {
      Word change = 0;
      for (std::size_t place = 0; place < sizeof(Word); ++place) {
        change |= plane(column * sizeof(Word) + place, tick) << (8 * place);
      }
      now.word[column] = restored(column, change, now.word[column]);
    }
    for (std::size_t column = 0; column < flags; ++column) {
      now.flag[column] = static_cast<std::uint8_t>(plane(words * sizeof(Word) + column, tick));
    }
    samples.push_back(unpacked(now));
  }
  return samples;
}
}  // namespace tapstudy::results
