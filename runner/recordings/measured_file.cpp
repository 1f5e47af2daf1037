#include "runner/recordings/measured_file.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <numeric>

#include "core/error.hpp"
namespace tapstudy::runner {
namespace {
analysis::Recording read_column(const std::string& file, const TapQuestion& question,
                                const std::string& column) {
  analysis::ReadingOptions options = question.reading;
  options.column = column;
  return analysis::read_recording(file, options);
}

double largest(const analysis::Recording& recording) {
  const auto [low, high] = std::ranges::minmax(recording.samples);
  return std::max(std::abs(low), std::abs(high));
}
}  // namespace

MeasuredFile read_measured_file(const std::string& file, const TapQuestion& question) {
  MeasuredFile measured;
  for (const std::string& column :
       question.columns.empty() ? std::vector<std::string>{""} : question.columns) {
    measured.channels.push_back(read_column(file, question, column));
  }
  if (!question.force_column.empty()) {
    measured.force = read_column(file, question, question.force_column);
  }
  return measured;
}

analysis::FoundTaps find_taps(const MeasuredFile& measured, const analysis::TapFinding& finding) {
  std::optional<analysis::FoundTaps> clearest;
  double most = 0.0;
  std::exception_ptr none;
  for (const analysis::Recording& channel : measured.channels) {
    try {
      analysis::FoundTaps found = analysis::find_taps(channel, finding);
      const double over_noise = largest(channel) / std::max(found.noise_rms, 1e-300);
      if (!clearest || over_noise > most) {
        most = over_noise;
        clearest = std::move(found);
      }
    } catch (const core::InvalidInput&) {
      none = std::current_exception();
    }
  }
  if (!clearest) {
    std::rethrow_exception(none);
  }
  return *clearest;
}

double impulse_n_s(const analysis::Recording& force, const analysis::Tap& tap) {
  constexpr double before_s = 0.005;
  constexpr double resting_s = 0.02;
  const auto samples = [&](double seconds) {
    return static_cast<std::size_t>(std::lround(seconds * force.rate_hz));
  };
  const std::size_t begin = tap.onset - std::min(tap.onset, samples(before_s));
  const std::size_t rest = begin - std::min(begin, samples(resting_s));
  const auto at = [&](std::size_t place) {
    return force.samples.begin() + static_cast<std::ptrdiff_t>(place);
  };
  const double resting_n =
      begin == rest ? 0.0
                    : std::accumulate(at(rest), at(begin), 0.0) / static_cast<double>(begin - rest);
  double sum_n = 0.0;
  for (std::size_t i = begin; i < tap.begin; ++i) {
    sum_n += force.samples[i] - resting_n;
  }
  return std::abs(sum_n) / force.rate_hz;
}
}  // namespace tapstudy::runner
