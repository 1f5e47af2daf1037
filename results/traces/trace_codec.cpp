#include "results/traces/trace_codec.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "results/compression.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
using core::TraceSample;
static_assert(std::endian::native == std::endian::little, "records are copied byte for byte");
constexpr std::size_t words = 20;  // time and nineteen numbers
constexpr std::size_t flags = 7;
constexpr std::size_t record_bytes = 168;
static_assert(words * sizeof(double) + flags <= record_bytes);

using Record = std::array<std::byte, record_bytes>;

Record packed(const TraceSample& s) {
  const std::array<double, words - 1> numbers{
      s.position_m[0],   s.position_m[1],   s.position_m[2],  s.velocity_m_s[0], s.velocity_m_s[1],
      s.velocity_m_s[2], s.penetration_m,   s.penalty_n,      s.vibration_n,     s.sinusoid_n,
      s.force_n[0],      s.force_n[1],      s.force_n[2],     s.achieved_n[0],   s.achieved_n[1],
      s.achieved_n[2],   s.pose_residual_m, s.closure_margin, s.motor_voltage_v};
  const std::array<std::uint8_t, flags> flag{s.alternative,
                                             static_cast<std::uint8_t>(s.touching),
                                             static_cast<std::uint8_t>(s.impact),
                                             static_cast<std::uint8_t>(s.saturated),
                                             static_cast<std::uint8_t>(s.fault),
                                             s.missed_replies,
                                             static_cast<std::uint8_t>(s.late)};
  Record record{};
  std::memcpy(record.data(), &s.t_ns, sizeof s.t_ns);
  std::memcpy(record.data() + sizeof s.t_ns, numbers.data(), sizeof numbers);
  std::memcpy(record.data() + sizeof s.t_ns + sizeof numbers, flag.data(), sizeof flag);
  return record;
}

TraceSample unpacked(const Record& record) {
  std::int64_t t_ns{};
  std::array<double, words - 1> n{};
  std::array<std::uint8_t, flags> flag{};
  std::memcpy(&t_ns, record.data(), sizeof t_ns);
  std::memcpy(n.data(), record.data() + sizeof t_ns, sizeof n);
  std::memcpy(flag.data(), record.data() + sizeof t_ns + sizeof n, sizeof flag);
  return {t_ns,
          {n[0], n[1], n[2]},
          {n[3], n[4], n[5]},
          n[6],
          n[7],
          n[8],
          n[9],
          {n[10], n[11], n[12]},
          {n[13], n[14], n[15]},
          n[16],
          n[17],
          n[18],
          flag[0],
          flag[1] != 0,
          flag[2] != 0,
          flag[3] != 0,
          static_cast<core::TickFault>(flag[4]),
          flag[5],
          flag[6] != 0};
}

constexpr std::size_t block = 8;  // bytes of a word, and words of a block
using Block = std::array<std::uint64_t, block>;

// Exchanges byte j of word i with byte i of word j: halves of the block, then quarters, then single
// bytes change sides (Warren, Hacker's Delight, section 7-3).
void transpose_block(Block& words_of_block) {
  constexpr std::array<std::uint64_t, 3> low_bytes{0x00000000FFFFFFFF, 0x0000FFFF0000FFFF,
                                                   0x00FF00FF00FF00FF};
  std::size_t apart = block / 2;
  for (const std::uint64_t low : low_bytes) {
    const std::size_t bits = 8 * apart;
    for (std::size_t i = 0; i < block; ++i) {
      if ((i & apart) != 0) {
        continue;
      }
      std::uint64_t& upper = words_of_block[i];
      std::uint64_t& lower = words_of_block[i + apart];
      const std::uint64_t differing = ((upper >> bits) ^ lower) & low;
      lower ^= differing;
      upper ^= differing << bits;
    }
    apart /= 2;
  }
}

// The matrix of bytes with rows and columns exchanged: a byte at a time takes most of the time of
// reading and writing traces.
void transpose(const std::byte* from, std::size_t rows, std::size_t columns, std::byte* to) {
  const std::size_t whole_rows = rows - rows % block;
  const std::size_t whole_columns = columns - columns % block;
  Block words_of_block{};
  for (std::size_t column = 0; column < whole_columns; column += block) {
    for (std::size_t row = 0; row < whole_rows; row += block) {
      for (std::size_t i = 0; i < block; ++i) {
        std::memcpy(&words_of_block[i], from + (row + i) * columns + column, block);
      }
      transpose_block(words_of_block);
      for (std::size_t i = 0; i < block; ++i) {
        std::memcpy(to + (column + i) * rows + row, &words_of_block[i], block);
      }
    }
  }
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = row < whole_rows ? whole_columns : 0; column < columns; ++column) {
      to[column * rows + row] = from[row * columns + column];
    }
  }
}
}  // namespace

std::vector<std::byte> encode_trace(std::span<const TraceSample> samples) {
  thread_local std::vector<Record> records;  // kept, as the compression's room is
  thread_local std::vector<std::byte> rows;
  records.clear();
  for (const TraceSample& sample : samples) {
    records.push_back(packed(sample));
  }
  rows.resize(samples.size() * record_bytes);
  transpose(std::as_bytes(std::span{records}).data(), samples.size(), record_bytes, rows.data());
  return compressed(rows);
}

std::vector<TraceSample> decode_trace(std::span<const std::byte> bytes, std::size_t ticks,
                                      const std::string& what) {
  const std::vector<std::byte> rows = decompressed(bytes, ticks * record_bytes, what);
  std::vector<Record> records(ticks);
  transpose(rows.data(), record_bytes, ticks, std::as_writable_bytes(std::span{records}).data());
  std::vector<TraceSample> samples;
  samples.reserve(ticks);
  for (const Record& record : records) {
    samples.push_back(unpacked(record));
  }
  return samples;
}

namespace {
using core::ActuatorPeriod;
constexpr std::size_t period_bytes = 32;
using PeriodRecord = std::array<std::byte, period_bytes>;

PeriodRecord packed(const ActuatorPeriod& p) {
  PeriodRecord record{};
  std::byte* to = record.data();
  const auto put = [&](const auto& value) {
    std::memcpy(to, &value, sizeof value);
    to += sizeof value;
  };
  put(p.heard_at_ns);
  put(p.frame_ns);
  put(p.filled_at_ns);
  put(p.ticks);
  put(p.samples);
  put(static_cast<std::uint8_t>(p.follows_gap));
  put(static_cast<std::uint8_t>(p.is_heard));
  return record;
}

ActuatorPeriod unpacked(const PeriodRecord& record) {
  const std::byte* from = record.data();
  const auto take = [&](auto& value) {
    std::memcpy(&value, from, sizeof value);
    from += sizeof value;
  };
  ActuatorPeriod p{};
  std::uint8_t follows_gap{};
  std::uint8_t is_heard{};
  take(p.heard_at_ns);
  take(p.frame_ns);
  take(p.filled_at_ns);
  take(p.ticks);
  take(p.samples);
  take(follows_gap);
  take(is_heard);
  p.follows_gap = follows_gap != 0;
  p.is_heard = is_heard != 0;
  return p;
}
}  // namespace

std::vector<std::byte> encode_actuator(const ActuatorTrace& trace) {
  std::vector<PeriodRecord> records;
  for (const ActuatorPeriod& period : trace.periods) {
    records.push_back(packed(period));
  }
  const std::size_t of_periods = records.size() * period_bytes;
  std::vector<std::byte> rows(of_periods + trace.samples.size() * sizeof(float));
  transpose(std::as_bytes(std::span{records}).data(), records.size(), period_bytes, rows.data());
  transpose(std::as_bytes(std::span{trace.samples}).data(), trace.samples.size(), sizeof(float),
            rows.data() + of_periods);
  return compressed(rows);
}

ActuatorTrace decode_actuator(std::span<const std::byte> bytes, std::size_t periods,
                              std::size_t samples, const std::string& what) {
  const std::size_t of_periods = periods * period_bytes;
  const std::vector<std::byte> rows =
      decompressed(bytes, of_periods + samples * sizeof(float), what);
  std::vector<PeriodRecord> records(periods);
  ActuatorTrace trace;
  trace.samples.resize(samples);
  transpose(rows.data(), period_bytes, periods, std::as_writable_bytes(std::span{records}).data());
  transpose(rows.data() + of_periods, sizeof(float), samples,
            std::as_writable_bytes(std::span{trace.samples}).data());
  std::size_t in_periods = 0;
  for (const PeriodRecord& record : records) {
    trace.periods.push_back(unpacked(record));
    in_periods += trace.periods.back().samples;
  }
  if (in_periods != samples) {
    throw StoreError{
        fmt::format("{}: its periods have {} samples, not {}", what, in_periods, samples)};
  }
  return trace;
}
}  // namespace tapstudy::results
