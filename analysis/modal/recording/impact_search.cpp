#include "analysis/modal/recording/impact_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

#include "analysis/statistics/quantiles.hpp"
#include "core/algebra/dense_solvers.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double predicted_rate_hz = 4000.0;
constexpr Eigen::Index order = 32;

Eigen::VectorXd averaged(const std::vector<double>& samples, std::size_t factor) {
  Eigen::VectorXd means(static_cast<Eigen::Index>(samples.size() / factor));
  for (Eigen::Index i = 0; i < means.size(); ++i) {
    const auto first = samples.begin() + i * static_cast<std::ptrdiff_t>(factor);
    double sum = 0.0;
    for (auto sample = first; sample != first + static_cast<std::ptrdiff_t>(factor); ++sample) {
      sum += *sample;
    }
    means[i] = sum / static_cast<double>(factor);
  }
  return means;
}

// x[n] is about the sum of coefficients[k] x[n - 1 - k]: the equations of Yule and Walker.
Eigen::VectorXd prediction_of(const Eigen::VectorXd& samples) {
  Eigen::VectorXd covariance(order + 1);
  for (Eigen::Index lag = 0; lag <= order; ++lag) {
    const Eigen::Index count = samples.size() - lag;
    covariance[lag] = samples.head(count).dot(samples.tail(count));
  }
  Eigen::MatrixXd toeplitz(order, order);
  for (Eigen::Index i = 0; i < order; ++i) {
    for (Eigen::Index j = 0; j < order; ++j) {
      toeplitz(i, j) = covariance[std::abs(i - j)];
    }
  }
  constexpr double load = 1e-9;  // of a recording without noise
  toeplitz.diagonal().array() += load * covariance[0];
  return core::SymmetricFactors{toeplitz}.solve(covariance.tail(order));
}
}  // namespace

std::vector<double> innovation_energies(const std::vector<double>& samples, double rate_hz,
                                        std::size_t frame) {
  const auto factor =
      std::max<std::size_t>(1, static_cast<std::size_t>(rate_hz / predicted_rate_hz));
  const Eigen::VectorXd means = averaged(samples, factor);
  const std::size_t frames = samples.size() / frame;
  std::vector<double> energies(frames, 0.0);
  if (means.size() <= 2 * order) {
    return energies;
  }
  const Eigen::VectorXd backward = prediction_of(means).reverse();
  std::vector<int> counts(frames, 0);
  for (Eigen::Index i = 0; i < means.size(); ++i) {
    const std::size_t of = static_cast<std::size_t>(i) * factor / frame;
    if (of < frames) {
      const double foretold =
          i < order ? 0.0 : backward.dot(means.segment(i - order, order));  // nothing came before
      const double error = means[i] - foretold;
      energies[of] += error * error;
      ++counts[of];
    }
  }
  for (std::size_t i = 0; i < frames; ++i) {
    energies[i] /= std::max(1, counts[i]);
  }
  return energies;
}

namespace {
constexpr double frame_s = 0.002;
constexpr std::size_t min_frame = 8;
}  // namespace

std::size_t samples_in(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::llround(seconds * rate_hz));
}

std::size_t frame_of(double rate_hz) {
  return std::max(min_frame, samples_in(frame_s, rate_hz));
}

namespace {
double mean_of_group(const std::vector<double>& of_frames, std::size_t first) {
  const std::size_t count = std::min(frames_per_group, of_frames.size() - first);
  const auto begin = of_frames.begin() + static_cast<std::ptrdiff_t>(first);
  return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), 0.0) /
         static_cast<double>(count);
}
}  // namespace

double Energies::of_group(std::size_t first) const {
  return mean_of_group(of_frame, first);
}

namespace {
constexpr std::size_t fewest_groups = 6;
constexpr double far_quieter = 0.01;

// The 20 % quantile of what groups of frames have, without those at either end in which all samples
// are the same: editors and triggered recorders pad so, and no sensor was recorded there. But what
// changes in fewer than six groups, 0.1 s, is a blow in a force window, beside which zeros are the
// silence. What begins with 0.1 s 20 dB below that quantile rings for more than four fifths of the
// recording, and its floor is that beginning.
double floor_of(const std::vector<double>& of_frames, std::size_t frame,
                const std::vector<double>& centred) {
  std::vector<double> groups;
  std::size_t first = 0;
  std::size_t last = 0;  // behind the last that changes
  for (std::size_t i = 0; i < of_frames.size(); i += frames_per_group) {
    groups.push_back(mean_of_group(of_frames, i));
    const auto begin = centred.begin() + static_cast<std::ptrdiff_t>(i * frame);
    const auto length = static_cast<std::ptrdiff_t>(frames_per_group * frame);
    const auto end = begin + std::min(length, centred.end() - begin);
    if (std::adjacent_find(begin, end, std::not_equal_to<>{}) != end) {
      first = last == 0 ? groups.size() - 1 : first;
      last = groups.size();
    }
  }
  if (last - first >= fewest_groups) {
    groups.resize(last);
    groups.erase(groups.begin(), groups.begin() + static_cast<std::ptrdiff_t>(first));
  }
  const double usual = quantile(groups, 0.2);
  if (groups.size() <= fewest_groups) {
    return usual;
  }
  // the first of all may be cut by padding
  const double at_first = *std::max_element(groups.begin() + 1, groups.begin() + fewest_groups);
  return at_first > 0.0 && at_first < far_quieter * usual ? at_first : usual;
}
}  // namespace

Energies energies_of(const std::vector<double>& centred, double rate_hz) {
  Energies energies{frame_of(rate_hz), {}, {}, 0.0, 0.0, 0.0};
  for (std::size_t i = 0; i + energies.frame <= centred.size(); i += energies.frame) {
    double sum = 0.0;
    for (std::size_t k = i; k < i + energies.frame; ++k) {
      sum += centred[k] * centred[k];
    }
    energies.of_frame.push_back(sum / static_cast<double>(energies.frame));
  }
  energies.innovations = innovation_energies(centred, rate_hz, energies.frame);
  const double loudest = *std::ranges::max_element(energies.of_frame);
  energies.floor = std::max(floor_of(energies.of_frame, energies.frame, centred), 1e-12 * loudest);
  energies.innovation_floor = floor_of(energies.innovations, energies.frame, centred);
  energies.largest_innovation = *std::ranges::max_element(energies.innovations);
  return energies;
}

namespace {
constexpr std::size_t frames_before = 5;
constexpr double onset_ratio = 10.0;
constexpr double rise_ratio = 2.0;
constexpr double envelope_s = 0.05;
constexpr double min_innovation_ratio = 4.0;
constexpr double small_share = 0.01;  // of the largest innovation
constexpr double blow_ratio = 16.0;   // of a new blow while the last one still rings
constexpr std::size_t settled_frames = 6;
constexpr std::size_t look_back_frames = 125;
constexpr double one_impact_s = 0.03;
constexpr double pulse_share = 0.1;  // of the largest force
constexpr double pulse_over_noise = 6.0;
constexpr double resting_share = 0.3;  // of where a pulse begins
constexpr double pulse_pause_s = 0.001;

// The prediction error about a frame.
double innovation_at(std::size_t frame, const Energies& energies) {
  const auto begin = energies.innovations.begin();
  const std::size_t end = std::min(frame + 2, energies.innovations.size());
  return *std::max_element(begin + static_cast<std::ptrdiff_t>(frame > 0 ? frame - 1 : 0),
                           begin + static_cast<std::ptrdiff_t>(end));
}

// The ratio of the prediction error at a frame to that since the last impact, in energy; unset so
// soon after it that there is nothing to compare with.
std::optional<double> innovation_ratio(std::size_t frame, std::size_t last_impact,
                                       const Energies& energies) {
  const std::size_t first = std::max(last_impact + settled_frames,
                                     frame > look_back_frames ? frame - look_back_frames : 0);
  if (first + 2 > frame) {
    return std::nullopt;
  }
  const auto at = [&](std::size_t i) {
    return energies.innovations.begin() + static_cast<std::ptrdiff_t>(i);
  };
  const std::vector<double> before(at(first), at(frame - 1));
  return innovation_at(frame, energies) / std::max(quantile(before, 0.8), 1e-300);
}

// Errors of the prediction that are hardly larger than the noise's, and small beside those of the
// hardest impact.
bool is_foretold(std::size_t frame, const Energies& energies) {
  const double innovation = innovation_at(frame, energies);
  return innovation < min_innovation_ratio * energies.innovation_floor ||
         (innovation < onset_ratio * energies.innovation_floor &&
          innovation < small_share * energies.largest_innovation);
}

// Modes that beat, and slow ones, rise again and again while they ring, and so does a floor that
// rocks slowly: an impact is also not what the motion before foretells.
bool is_impact(std::size_t frame, const std::vector<std::size_t>& impacts, double envelope,
               const Energies& energies) {
  const double energy = energies.of_frame[frame];
  if (!(energy > onset_ratio * energies.floor) || is_foretold(frame, energies)) {
    return false;
  }
  const auto unforeseen =
      impacts.empty() ? std::nullopt : innovation_ratio(frame, impacts.back(), energies);
  if (energy > rise_ratio * envelope) {
    return !unforeseen || *unforeseen > min_innovation_ratio;
  }
  return unforeseen && *unforeseen > blow_ratio;
}

std::vector<std::size_t> frames_of_impacts(const Energies& energies, double rate_hz) {
  const double frame_duration_s = static_cast<double>(energies.frame) / rate_hz;
  const double fall = std::exp(-frame_duration_s / envelope_s);
  const auto one_impact = static_cast<std::size_t>(std::ceil(one_impact_s / frame_duration_s));
  std::vector<std::size_t> impacts;
  double envelope = 0.0;
  for (std::size_t j = 0; j < energies.of_frame.size(); ++j) {
    const double energy = energies.of_frame[j];
    const bool is_new = impacts.empty() || j - impacts.back() > one_impact;
    if (is_new && is_impact(j, impacts, envelope, energies)) {
      impacts.push_back(j);
    }
    envelope = std::max(energy, fall * envelope);
  }
  return impacts;
}

// The first sample above the noise and above what rang in the frames before, from where on the
// energy stays above the noise: single samples of noise exceed it by chance.
std::size_t onset_near(std::size_t frame, const Energies& energies,
                       const std::vector<double>& centred) {
  const std::size_t first = (frame > 0 ? frame - 1 : 0) * energies.frame;
  const std::size_t before = frames_before * energies.frame;
  double limit = std::sqrt(onset_ratio * energies.floor);
  for (std::size_t i = first > before ? first - before : 0; i < first; ++i) {
    limit = std::max(limit, std::abs(centred[i]));
  }
  std::size_t i = first;
  const std::size_t end = (frame + 1) * energies.frame;
  const auto stays = [&](std::size_t from) {
    const std::size_t to = std::min(from + energies.frame, centred.size());
    double sum = 0.0;
    for (std::size_t k = from; k < to; ++k) {
      sum += centred[k] * centred[k];
    }
    return sum > onset_ratio / 2.0 * energies.floor * static_cast<double>(to - from);
  };
  while (i + 1 < end && (std::abs(centred[i]) <= limit || !stays(i))) {
    ++i;
  }
  return i;
}

void add_pulse(std::size_t crossing, double rests, const std::vector<double>& centred,
               std::size_t one_impact, std::vector<Impact>& found) {
  std::size_t onset = crossing;
  while (onset > 0 && std::abs(centred[onset - 1]) > rests) {
    --onset;
  }
  if (!found.empty() && onset - found.back().onset <= one_impact) {
    found.back().last_blow = onset;
  } else {
    found.push_back({onset, onset});
  }
}
}  // namespace

std::vector<Impact> sensor_impacts(const Energies& energies, const std::vector<double>& centred,
                                   double rate_hz) {
  std::vector<Impact> found;
  for (const std::size_t frame : frames_of_impacts(energies, rate_hz)) {
    const std::size_t onset = onset_near(frame, energies, centred);
    found.push_back({onset, onset});
  }
  return found;
}

std::vector<Impact> force_pulses(const std::vector<double>& centred, double noise_rms,
                                 double rate_hz) {
  const double most = std::abs(
      *std::ranges::max_element(centred, {}, [](double sample) { return std::abs(sample); }));
  const double begins = std::max(pulse_share * most, pulse_over_noise * noise_rms);
  const double rests = resting_share * begins;
  const std::size_t pause = samples_in(pulse_pause_s, rate_hz) + 1;
  const std::size_t one_impact = samples_in(one_impact_s, rate_hz);
  std::vector<Impact> found;
  std::size_t resting = 0;
  bool may_begin = true;
  for (std::size_t i = 0; i < centred.size(); ++i) {
    const double away = std::abs(centred[i]);
    resting = away > rests ? 0 : resting + 1;
    may_begin = may_begin || resting >= pause;
    if (may_begin && away > begins) {
      add_pulse(i, rests, centred, one_impact, found);
      may_begin = false;
    }
  }
  return found;
}
}  // namespace tapstudy::analysis
