#include "runner/session/participants/simulated_observer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include "core/error.hpp"
#include "core/haptics/haptic_state.hpp"
namespace tapstudy::runner {
namespace {
using device::FeltTick;
constexpr double lowest_band_hz = 20.0;
constexpr double early_s = 0.04;
constexpr double late_s = 0.12;
constexpr double rebound_s = 0.05;            // a finger that is off for less bounces
constexpr double contact_threshold_n = 1e-6;  // threshold of contact detection

double normal_force_n(const FeltTick& tick) {
  return core::along_normal(tick.force_n);
}
double height_m(const FeltTick& tick) {
  return core::along_normal(tick.hand.position_m);
}

bool is_contact(const FeltTick& tick) {
  return std::abs(normal_force_n(tick)) > contact_threshold_n;
}

// The residuals of a linear least-squares fit of force against height in contact; out of contact
// the spring exerts nothing. For a hand that holds still, where a script taps, it is the mean.
std::vector<double> without_spring(std::span<const FeltTick> tap) {
  std::vector<FeltTick> contact;
  std::ranges::copy_if(tap, std::back_inserter(contact), is_contact);
  double mean_height = 0.0;
  double mean_force = 0.0;
  for (const FeltTick& tick : contact) {
    mean_height += height_m(tick);
    mean_force += normal_force_n(tick);
  }
  const auto count = static_cast<double>(contact.size());
  mean_height /= count;
  mean_force /= count;
  double covariance = 0.0;
  double variance = 0.0;
  for (const FeltTick& tick : contact) {
    const double height = height_m(tick) - mean_height;
    covariance += height * (normal_force_n(tick) - mean_force);
    variance += height * height;
  }
  const double slope = variance > 0.0 ? covariance / variance : 0.0;
  std::vector<double> rest;
  rest.reserve(tap.size());
  for (const FeltTick& tick : tap) {
    const bool is_predicted = is_contact(tick) || variance == 0.0;
    const double spring = mean_force + slope * (height_m(tick) - mean_height);
    rest.push_back(normal_force_n(tick) - (is_predicted ? spring : 0.0));
  }
  return rest;
}

// Mean square of the component at one frequency (Goertzel 1958, as a rotating phasor).
double power_at(std::span<const double> signal, double frequency_hz, double dt_s) {
  const std::complex<double> turn = std::polar(1.0, -2.0 * std::numbers::pi * frequency_hz * dt_s);
  std::complex<double> phasor{1.0, 0.0};
  std::complex<double> sum{0.0, 0.0};
  for (const double x : signal) {
    sum += x * phasor;
    phasor *= turn;
  }
  const auto count = static_cast<double>(signal.size());
  return 2.0 * std::norm(sum) / (count * count);
}

Features features_of(std::span<const FeltTick> tap, double dt_s, double threshold_n) {
  const std::vector<double> rest = without_spring(tap);
  const std::span<const double> all{rest};
  const auto early = std::min(all.size(), static_cast<std::size_t>(std::lround(early_s / dt_s)));
  const std::array windows{all.first(early), all.subspan(early)};
  const double threshold_power = 0.5 * threshold_n * threshold_n;
  Features levels{};
  for (std::size_t band = 0; band < bands; ++band) {
    const double frequency = lowest_band_hz * std::exp2(static_cast<double>(band) / 3.0);
    if (frequency >= 0.5 / dt_s) {
      break;  // above the loop's bandwidth, so not felt
    }
    for (std::size_t window = 0; window < windows.size(); ++window) {
      const double power = power_at(windows.at(window), frequency, dt_s);
      levels.at(window * bands + band) = 10.0 * std::log10(1.0 + power / threshold_power);
    }
  }
  return levels;
}
}  // namespace

std::vector<FeltTap> felt_taps(std::span<const FeltTick> felt, double dt_s, double threshold_n) {
  const auto whole = static_cast<std::size_t>(std::lround((early_s + late_s) / dt_s));
  const auto rebound = static_cast<std::ptrdiff_t>(std::lround(rebound_s / dt_s));
  std::vector<FeltTap> taps;
  for (auto first = std::ranges::find_if(felt, is_contact); first != felt.end();) {
    auto last = std::find_if_not(first, felt.end(), is_contact);
    auto next = std::find_if(last, felt.end(), is_contact);
    while (next != felt.end() && next - last < rebound) {
      last = std::find_if_not(next, felt.end(), is_contact);
      next = std::find_if(last, felt.end(), is_contact);
    }
    if (static_cast<std::size_t>(last - first) >= whole) {
      taps.push_back(
          {first->hand.position_m, features_of(std::span{first, whole}, dt_s, threshold_n)});
    }
    first = next;
  }
  return taps;
}

namespace {
// Lower bound of the discriminable level difference at zero noise; keeps the weights finite.
constexpr double min_difference_db = 0.1;

Features mean_of(std::span<const FeltTap> taps) {
  Features mean{};
  for (const FeltTap& tap : taps) {
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean.at(i) += tap.level_db.at(i) / static_cast<double>(taps.size());
    }
  }
  return mean;
}

}  // namespace

SimulatedObserver::SimulatedObserver(std::vector<core::Vec3> places_m, const Person& person,
                                     core::Rng rng)
    : places_m_{std::move(places_m)}, person_{person}, rng_{rng} {}

double SimulatedObserver::bias_towards(std::size_t answer) const {
  core::Rng rng{core::derived_seed(person_.bias_seed, core::Purpose::person, answer)};
  return person_.bias * rng.normal();
}

std::size_t SimulatedObserver::index_of_least(std::vector<double> distances) {
  for (std::size_t i = 0; i < distances.size(); ++i) {
    distances[i] -= bias_towards(i);
  }
  const double least = *std::ranges::min_element(distances);
  std::vector<std::size_t> equals;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (distances[i] == least) {
      equals.push_back(i);
    }
  }
  return equals[rng_.below(static_cast<std::uint32_t>(equals.size()))];
}

std::size_t SimulatedObserver::place_of(const FeltTap& tap) const {
  const auto nearest = std::ranges::min_element(
      places_m_, {}, [&](const core::Vec3& place) { return (place - tap.place_m).squaredNorm(); });
  return static_cast<std::size_t>(nearest - places_m_.begin());
}

void SimulatedObserver::remember(const std::string& stimulus, std::span<const FeltTap> taps) {
  if (taps.empty()) {
    throw core::InvalidInput{
        fmt::format("simulation: no tap on '{}' stays in contact for the 0.16 s that feeling it "
                    "takes (raise simulation.taps.dwell_s or press_m)",
                    stimulus)};
  }
  const std::vector<std::vector<FeltTap>> at_place = by_place(taps);
  Memory& memory = memories_[stimulus];
  memory = {};
  memory.taps.assign(taps.begin(), taps.end());
  for (const std::vector<FeltTap>& here : at_place) {
    memory.mean_db.push_back(mean_of(here.empty() ? taps : std::span<const FeltTap>{here}));
  }
  for (const FeltTap& tap : taps) {
    const Features& mean = memory.mean_db.at(place_of(tap));
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const double deviation = tap.level_db.at(i) - mean.at(i);
      memory.variance_db2.at(i) += deviation * deviation / static_cast<double>(taps.size());
    }
  }
}

std::vector<std::vector<FeltTap>> SimulatedObserver::by_place(std::span<const FeltTap> taps) const {
  std::vector<std::vector<FeltTap>> at_place(places_m_.size());
  for (const FeltTap& tap : taps) {
    at_place.at(place_of(tap)).push_back(tap);
  }
  return at_place;
}

double SimulatedObserver::noise_variance_db2() const {
  return person_.noise_db * person_.noise_db + min_difference_db * min_difference_db;
}

double SimulatedObserver::position(const Percept& percept, const std::string& from,
                                   const std::string& to) const {
  if (percept.felt.empty()) {
    return percept.noise.front();
  }
  const Memory& start = memories_.at(from);
  const Memory& end = memories_.at(to);
  const Features felt = difference(percept.felt, start);
  double along = 0.0;
  double length = 0.0;
  for (std::size_t i = 0; i < felt.size(); ++i) {
    double way = 0.0;
    for (std::size_t place = 0; place < start.mean_db.size(); ++place) {
      way += (end.mean_db[place].at(i) - start.mean_db[place].at(i)) /
             static_cast<double>(start.mean_db.size());
    }
    const double weight = 1.0 / (noise_variance_db2() + start.variance_db2.at(i));
    along += weight * way * (felt.at(i) + percept.noise.at(i));
    length += weight * way * way;
  }
  // of two that feel alike, noise alone decides
  return length > 0.0 ? along / length : percept.noise.front();
}

Features SimulatedObserver::difference(const Percept& first, const Percept& second) const {
  const auto here = by_place(first.felt);
  const auto there = by_place(second.felt);
  Features mean{};
  double places = 0.0;
  for (std::size_t place = 0; place < here.size(); ++place) {
    if (here[place].empty() || there[place].empty()) {
      continue;
    }
    ++places;
    const Features one = mean_of(here[place]);
    const Features other = mean_of(there[place]);
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean.at(i) += one.at(i) - other.at(i);
    }
  }
  for (std::size_t i = 0; i < mean.size(); ++i) {
    mean.at(i) =
        (places > 0.0 ? mean.at(i) / places : 0.0) + first.noise.at(i) - second.noise.at(i);
  }
  return mean;
}

double SimulatedObserver::distance(const Percept& first, const Percept& second) const {
  double sum = 0.0;
  for (const double felt : difference(first, second)) {
    sum += felt * felt;
  }
  return sum / (2.0 * noise_variance_db2() * static_cast<double>(Features{}.size()));
}

double SimulatedObserver::weighted_distance(const Percept& first, const Percept& second,
                                            const Memory& memory) const {
  const Features felt = difference(first, second);
  const double taps = static_cast<double>(std::max<std::size_t>(1, first.felt.size()));
  double sum = 0.0;
  for (std::size_t i = 0; i < felt.size(); ++i) {
    sum += felt.at(i) * felt.at(i) / (noise_variance_db2() + memory.variance_db2.at(i) / taps);
  }
  return sum / (2.0 * static_cast<double>(felt.size()));
}

bool SimulatedObserver::are_different(const Percept& first, const Percept& second,
                                      const std::string& stimulus, double share) {
  return weighted_distance(first, second, memories_.at(stimulus)) >
         same_distance(stimulus, first.felt.size(), share);
}

double SimulatedObserver::same_distance(const std::string& stimulus, std::size_t taps_each,
                                        double share) {
  const auto [known, is_new] = same_distances_.try_emplace({stimulus, taps_each, share}, 0.0);
  if (!is_new) {
    return known->second;
  }
  constexpr int pairs = 300;
  const Memory& memory = memories_.at(stimulus);
  std::vector<FeltTap> taps = memory.taps;
  if (taps.size() < 2) {
    throw core::InvalidInput{
        fmt::format("simulation: one tap only on '{}' stays in contact for the 0.16 s that feeling "
                    "it takes, and two are compared (raise simulation.taps.dwell_s or press_m)",
                    stimulus)};
  }
  const std::size_t each = std::clamp<std::size_t>(taps_each, 1, taps.size() / 2);
  std::vector<double> distances;
  for (int pair = 0; pair < pairs; ++pair) {
    rng_.shuffle(taps);
    const std::span<const FeltTap> all{taps};
    distances.push_back(
        weighted_distance({all.first(each), noise()}, {all.subspan(each, each), noise()}, memory));
  }
  const auto at = distances.begin() + static_cast<std::ptrdiff_t>(share * pairs);
  std::ranges::nth_element(distances, at);
  known->second = *at;
  return *at;
}

double SimulatedObserver::distance(const Percept& percept, const std::string& stimulus) const {
  const Features felt = difference(percept.felt, memories_.at(stimulus));
  double sum = 0.0;
  for (std::size_t i = 0; i < felt.size(); ++i) {
    const double blurred = felt.at(i) + percept.noise.at(i);
    sum += blurred * blurred;
  }
  return sum / (noise_variance_db2() * static_cast<double>(felt.size()));
}

double SimulatedObserver::level_db(const Percept& percept) const {
  const Features felt = mean_of(percept.felt);
  double sum = 0.0;
  for (std::size_t i = 0; i < felt.size(); ++i) {
    sum += felt.at(i) + percept.noise.at(i);
  }
  return sum / static_cast<double>(felt.size());
}

Features SimulatedObserver::difference(std::span<const FeltTap> felt, const Memory& memory) const {
  Features mean{};
  for (const FeltTap& tap : felt) {
    const Features& expected = memory.mean_db.at(place_of(tap));
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean.at(i) += (tap.level_db.at(i) - expected.at(i)) / static_cast<double>(felt.size());
    }
  }
  return mean;
}

Features SimulatedObserver::noise() {
  Features noise{};
  std::ranges::generate(noise, [&] { return person_.noise_db * rng_.normal(); });
  return noise;
}

double SimulatedObserver::distance(const Features& difference, const Features& noise,
                                   const Memory& memory) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < difference.size(); ++i) {
    const double felt = difference.at(i) + noise.at(i);
    sum += felt * felt /
           (person_.noise_db * person_.noise_db + memory.variance_db2.at(i) +
            min_difference_db * min_difference_db);
  }
  return sum;
}

std::size_t SimulatedObserver::most_similar(std::span<const FeltTap> felt,
                                            const std::vector<std::string>& stimuli) {
  if (felt.empty()) {
    return rng_.below(static_cast<std::uint32_t>(stimuli.size()));
  }
  const Features blur = noise();
  Memory common;  // one scale for all candidates
  for (const std::string& stimulus : stimuli) {
    for (std::size_t i = 0; i < blur.size(); ++i) {
      common.variance_db2.at(i) +=
          memories_.at(stimulus).variance_db2.at(i) / static_cast<double>(stimuli.size());
    }
  }
  std::vector<double> distances;
  for (const std::string& stimulus : stimuli) {
    distances.push_back(distance(difference(felt, memories_.at(stimulus)), blur, common));
  }
  return index_of_least(std::move(distances));
}

std::size_t SimulatedObserver::most_similar(const std::vector<std::vector<FeltTap>>& felt,
                                            const std::string& stimulus) {
  const Memory& memory = memories_.at(stimulus);
  std::vector<double> distances;
  for (const std::vector<FeltTap>& taps : felt) {
    distances.push_back(taps.empty() ? std::numeric_limits<double>::infinity()
                                     : distance(difference(taps, memory), noise(), memory));
  }
  return index_of_least(std::move(distances));
}
}  // namespace tapstudy::runner
