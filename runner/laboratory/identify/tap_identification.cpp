#include "runner/laboratory/identify/tap_identification.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "analysis/modal/modes/mode_kinds.hpp"
#include "analysis/modal/modes/mode_shapes.hpp"
#include "analysis/modal/modes/steady_tone.hpp"
#include "analysis/modal/recording/measured_unit.hpp"
#include "core/error.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/laboratory/identify/fits_over_taps.hpp"
#include "runner/laboratory/identify/measurement_files.hpp"
#include "runner/laboratory/identify/modes_of_taps.hpp"
namespace tapstudy::runner {
namespace {
void widen(double factor, analysis::Interval& interval) {
  interval.low *= interval.low > 0.0 ? 1.0 / factor : factor;
  interval.high *= interval.high > 0.0 ? factor : 1.0 / factor;
}

void widen(double factor, analysis::Estimate& estimate) {
  widen(factor, estimate.interval);
  if (estimate.bootstrap) {
    widen(factor, *estimate.bootstrap);
  }
}
}  // namespace

void include_rate_error(double share, TapIdentification& identified) {
  const double factor = 1.0 + share;
  for (analysis::RepeatedMode& mode : identified.modes) {
    widen(factor, mode.frequency_hz);
  }
  if (identified.rayleigh) {
    widen(factor, identified.rayleigh->alpha_per_s);
    widen(factor, identified.rayleigh->beta_s);
  }
  if (identified.sinusoid) {
    widen(factor, identified.sinusoid->decay_per_s);
    widen(factor, identified.sinusoid->frequency_hz);
  }
  if (identified.model && identified.model->update) {
    widen(factor * factor, identified.model->update->youngs_modulus_pa);
  }
  if (identified.model && identified.model->springs) {
    widen(factor * factor, identified.model->springs->factor);
  }
}

namespace {
analysis::FreeDecay between(const analysis::Recording& recording, std::size_t begin,
                            std::size_t end) {
  const auto first = static_cast<Eigen::Index>(begin);
  const auto count = static_cast<Eigen::Index>(end - begin);
  const Eigen::Map<const Eigen::VectorXd> all{recording.samples.data(),
                                              static_cast<Eigen::Index>(recording.samples.size())};
  return {recording.rate_hz, all.segment(first, count)};
}

// A sensor that is off or disconnected.
bool is_dead(const Eigen::VectorXd& samples) {
  const double most = samples.cwiseAbs().maxCoeff();
  return samples.maxCoeff() - samples.minCoeff() <= 1e-12 * most;
}

// What is known of a channel, whatever the tap.
struct ChannelState {
  analysis::Resting at_rest;
  std::vector<std::size_t> rails;    // see rail_samples
  std::vector<std::size_t> dropped;  // see dropped_samples

  bool is_clipped_in(const analysis::Tap& tap) const {
    const auto next = std::ranges::lower_bound(rails, tap.onset);
    return next != rails.end() && *next < tap.end;
  }

  std::ptrdiff_t dropped_in(const analysis::Tap& tap) const {
    return std::ranges::lower_bound(dropped, tap.end) -
           std::ranges::lower_bound(dropped, tap.begin);
  }
};

ChannelState state_of(const analysis::Recording& recording) {
  const analysis::Resting at_rest = analysis::resting(recording);
  return {at_rest, analysis::rail_samples(recording.samples, at_rest.noise_rms),
          analysis::dropped_samples(recording.samples, at_rest.noise_rms)};
}

class Identifier {
 public:
  Identifier(const TapQuestion& question, Progress& progress) : hook_{progress.hook()} {
    result_.question = question;
    if (!question.protocol.empty()) {
      protocol_ = protocols::read_protocol(question.protocol);
      result_.loop_rate_hz = protocol_->rate_hz;
      static_cast<void>(protocol_->stimulus(question.stimulus));  // must be there
      result_.finger_kg = protocol_->rendering.finger.mass_kg;
    }
  }

  TapIdentification identify() {
    std::vector<MeasuredFile> files;
    for (const std::string& file : result_.question.recordings) {
      files.push_back(read_measured_file(file, result_.question));
    }
    check_playback_rate(files);
    check_units(files);
    check_band(result_.question, rate_of(*std::ranges::min_element(files, {}, rate_of)));
    for (const MeasuredFile& file : files) {
      add_remarks_of(file);
      impacts_ += add(file, impacts_);
    }
    identify_modes();
    give_speeds(impacts_);
    give_places(impacts_);
    sum_up();
    include_rate_error(result_.question.rate_error, result_);
    return std::move(result_);
  }

 private:
  static double rate_of(const MeasuredFile& file) { return file.channels.front().rate_hz; }

  void check_playback_rate(const std::vector<MeasuredFile>& files) const {
    for (const MeasuredFile& file : files) {
      if (result_.question.at_m && rate_of(file) != rate_of(files.front())) {
        throw core::InvalidInput{
            fmt::format("--at: {} has {:g} samples a second, {} {:g}: all of one rate",
                        file.channels.front().file, rate_of(file),
                        files.front().channels.front().file, rate_of(files.front()))};
      }
    }
  }
  // Amplitudes are told per impact speed; frequencies and damping do not depend on the unit.
  void check_units(const std::vector<MeasuredFile>& files) const {
    if (result_.question.speeds.empty() || result_.question.scale) {
      return;
    }
    for (const MeasuredFile& file : files) {
      for (const analysis::Recording& channel : file.channels) {
        const std::string why = analysis::why_not_si(channel, result_.question.quantity);
        if (!why.empty()) {
          throw core::InvalidInput{why};
        }
      }
    }
  }
  // What was noticed while reading, once for all channels.
  void add_remarks_of(const MeasuredFile& file) {
    for (const std::string& remark : file.channels.front().remarks) {
      result_.remarks.push_back(file.channels.front().file + ": " + remark);
    }
  }

  // Returns the number of impacts in the file; `before` is the number in earlier recordings.
  int add(const MeasuredFile& file, int before) {
    const analysis::FoundTaps found = find_taps(file, result_.question.finding);
    for (const analysis::TapRemark& remark : found.remarks) {
      tap_remarks_.add(file.channels.front().file, remark);
    }
    std::vector<ChannelState> states;
    std::ranges::transform(file.channels, std::back_inserter(states), state_of);
    const analysis::Tap* before_it = nullptr;
    for (std::size_t k = 0; k < found.taps.size(); ++k) {
      const analysis::Tap& tap = found.taps[k];
      const std::size_t next = k + 1 < found.taps.size() ? found.taps[k + 1].onset
                                                         : file.channels.front().samples.size();
      hook_(fmt::format("tap {} of {}", tap.impact, file.channels.front().file));
      const auto force = file.force ? std::optional{impact_force(file, tap)} : std::nullopt;
      if (force && force->is_clipped) {
        tap_remarks_.add(file.force->file, {force->centre_s, "the force is clipped", {}});
      }
      for (std::size_t i = 0; i < file.channels.size(); ++i) {
        if (add(file.channels[i], states[i], tap)) {
          result_.taps.back().impact = before + tap.impact;
          result_.taps.back().force = force;
          give_rest(file.channels[i], before_it, next, result_.taps.back());
        }
      }
      before_it = &tap;
    }
    return found.impacts;
  }

  // At most half a second of what is around a tap: since the end of the one before, and from its
  // own until the next, but for what may be the beginning of an impact.
  static void give_rest(const analysis::Recording& recording, const analysis::Tap* before,
                        std::size_t next, IdentifiedTap& one) {
    constexpr double longest_s = 0.5;
    constexpr double guard_s = 0.005;
    const auto samples = [&](double s) { return static_cast<std::size_t>(s * recording.rate_hz); };
    const auto guarded = [&](std::size_t impact) {
      return impact - std::min(impact, samples(guard_s));
    };
    const std::size_t end = guarded(one.tap.onset);
    const std::size_t begin = std::min(end, std::max(before == nullptr ? 0 : before->end,
                                                     end - std::min(end, samples(longest_s))));
    one.rest = between(recording, begin, end);
    const std::size_t after =
        std::clamp(guarded(next), one.tap.end, one.tap.end + samples(longest_s));
    const bool is_before =
        one.rest.duration_s() >= analysis::shortest_stretch_s || end - begin >= after - one.tap.end;
    one.quiet = is_before ? one.rest : between(recording, one.tap.end, after);
    const std::size_t quiet_from = is_before ? begin : one.tap.end;
    const analysis::Tap* const struck = is_before ? before : &one.tap;
    one.quiet_s = static_cast<double>(quiet_from) / recording.rate_hz;
    one.struck_s = struck == nullptr
                       ? 0.0
                       : static_cast<double>(quiet_from - struck->onset) / recording.rate_hz;
  }

  // A channel that shows nothing is left out with a remark.
  bool add(const analysis::Recording& recording, const ChannelState& state,
           const analysis::Tap& tap) {
    IdentifiedTap one;
    one.file = recording.file;
    one.channel = recording.channel;
    one.tap = tap;
    one.time_s = static_cast<double>(tap.onset) / recording.rate_hz;
    one.noise_rms = state.at_rest.noise_rms;
    one.is_clipped = state.is_clipped_in(tap);
    one.decay = between(recording, tap.begin, tap.end);
    if (is_dead(one.decay.samples)) {
      tap_remarks_.add(recording.file,
                       {one.time_s, fmt::format("{} does not change", recording.channel), {}});
      return false;
    }
    if (!analysis::shows(tap, recording, state.at_rest)) {
      tap_remarks_.add(
          recording.file,
          {one.time_s,
           fmt::format("{} shows nothing above its noise, and is left out", recording.channel),
           {}});
      return false;
    }
    if (const auto dropped = state.dropped_in(tap); dropped > 0) {
      tap_remarks_.add(
          recording.file,
          {one.time_s,
           "zeros within its decay, as dropped samples leave them: they falsify damping",
           fmt::format("{} of {} samples of {}", dropped, tap.end - tap.begin, recording.channel)});
    }
    one.decay.samples.array() -= one.decay.samples.mean();
    // not by its mean: what stopped has been accelerated
    one.whole = between(recording, tap.onset, tap.end);
    one.whole.samples.array() -= state.at_rest.value;
    remark_on_skipped(one);
    result_.taps.push_back(std::move(one));
    return true;
  }

  // What has died by the time the decay is taken from.
  void remark_on_skipped(const IdentifiedTap& one) {
    constexpr double most_of_it = 0.5;
    const auto skipped = static_cast<Eigen::Index>(one.tap.begin - one.tap.onset);
    const double share =
        one.whole.samples.head(skipped).squaredNorm() / one.whole.samples.squaredNorm();
    if (share > most_of_it) {
      tap_remarks_.add(
          one.file,
          {one.time_s,
           fmt::format("over {:.0f} % of its energy lies before the decay is taken, {:g} ms after "
                       "its peak: modes that die so soon are not found (--skip, in s, takes less)",
                       10.0 * std::floor(10.0 * share), 1e3 * result_.question.finding.skip_s),
           {}});
    }
  }

  void identify_modes() {
    if (!result_.taps.empty()) {
      result_.band = modal_band(result_.question, result_.taps,
                                protocol_ ? std::optional{protocol_->band_limit_hz} : std::nullopt,
                                result_.remarks);
      hook_("modes");
      result_.modes =
          modes_over_all(result_.band, result_.taps, result_.question.quantity, tap_remarks_);
    }
    if (result_.taps.empty()) {
      add_remarks(tap_remarks_.sentences(impacts_));
      throw core::InvalidInput{fmt::format("{}", fmt::join(result_.remarks, "\n"))};
    }
    for (IdentifiedTap& tap : result_.taps) {
      // it is fitted from the impact on, where samples at the limit and further blows are
      if (!tap.is_clipped && !tap.tap.is_struck_again) {
        tap.sinusoid = analysis::fit_decaying_sinusoid(
            tap.whole, band_of_sinusoid(result_.band, tap.whole.rate_hz));
      }
    }
  }

  static void check_rows(const std::string& file, const char* what, std::size_t rows, int impacts) {
    if (rows != static_cast<std::size_t>(impacts)) {
      throw core::InvalidInput{
          fmt::format("{}: has {} {}, the recordings {} impacts (one row for each, in their order, "
                      "also for those left out)",
                      file, rows, what, impacts)};
    }
  }
  std::size_t impact_of(std::size_t tap) const {
    return static_cast<std::size_t>(result_.taps[tap].impact - 1);
  }

  void give_speeds(int impacts) {
    if (result_.question.speeds.empty()) {
      return;
    }
    const std::vector<double> speeds = read_speeds(result_.question.speeds);
    check_rows(result_.question.speeds, "speeds", speeds.size(), impacts);
    for (std::size_t i = 0; i < result_.taps.size(); ++i) {
      result_.taps[i].speed_m_s = speeds[impact_of(i)];
    }
  }

  void give_places(int impacts) {
    if (result_.question.places.empty()) {
      return;
    }
    const NumberedPlaces places = numbered(read_places(result_.question.places));
    check_rows(result_.question.places, "places", places.of_impacts.size(), impacts);
    result_.places_m = places.places_m;
    for (std::size_t i = 0; i < result_.taps.size(); ++i) {
      result_.taps[i].place = places.of_impacts[impact_of(i)];
    }
  }

  // The measured shapes of the agreed modes.
  std::optional<MeasuredShapes> measured_shapes() {
    if (result_.places_m.empty()) {
      return std::nullopt;
    }
    if (result_.places_m.size() < fewest_places) {
      result_.remarks.emplace_back(told_of_few_places);
      return std::nullopt;
    }
    std::vector<std::string> sensors;
    std::vector<analysis::PlacedTap> taps;
    for (const IdentifiedTap& tap : result_.taps) {
      const auto known = std::ranges::find(sensors, tap.channel);
      const auto sensor = static_cast<std::size_t>(known - sensors.begin());
      if (known == sensors.end()) {
        sensors.push_back(tap.channel);
      }
      taps.push_back({*tap.place, sensor, tap.impact,
                      tap.force ? tap.force->impulse_n_s : *tap.speed_m_s,
                      static_cast<double>(tap.tap.begin) / tap.decay.rate_hz -
                          (tap.force ? tap.force->centre_s : tap.time_s),
                      tap.decay});
    }
    std::vector<analysis::Pole> poles;
    for (const std::size_t i : result_.agreed) {
      poles.push_back({result_.modes[i].frequency_hz.value, result_.modes[i].damping_ratio.value});
    }
    const Eigen::MatrixXd shapes = analysis::tapped_shapes(poles, taps, result_.places_m.size());
    return MeasuredShapes{result_.places_m, shapes.cast<std::complex<double>>()};
  }

  void sum_up() {
    remark_on_residuals(result_.taps, tap_remarks_);
    add_remarks(tap_remarks_.sentences(impacts_));
    add_remarks(remarks_on_resolution(result_.taps));
    add_remarks(remarks_on_scatter(result_.modes));
    result_.source =
        fmt::format("{} taps, {}, {:g} to {:g} Hz", result_.taps.size(),
                    name(result_.question.quantity), result_.band.low_hz, result_.band.high_hz);
    result_.stimulus = result_.question.stimulus;
    sum_up_modes(result_);
    result_.others = analysis::summaries_of_others(result_.modes);
    result_.sinusoid = sinusoid_law(
        result_, protocol_ ? std::optional{protocol_->rendering.finger} : std::nullopt);
    if (!result_.sinusoid) {
      result_.remarks.push_back(why_no_sinusoid(result_));
    }
    if (protocol_) {
      result_.model = compared_with_model();
    }
  }

  void add_remarks(const std::vector<std::string>& remarks) {
    result_.remarks.insert(result_.remarks.end(), remarks.begin(), remarks.end());
  }

  ModelComparison compared_with_model() {
    MeasuredModes measured{{}, measured_shapes(), result_.places_m, result_.band.low_hz};
    if (result_.question.at_m) {
      measured.places_m.push_back(*result_.question.at_m);
    }
    for (const std::size_t i : result_.agreed) {
      measured.frequencies_hz.push_back(result_.modes[i].frequency_hz);
    }
    ModelComparison model = compare_with_model(*protocol_, result_.question.stimulus, measured,
                                               result_.band.high_hz, hook_);
    add_remarks(remarks_on_springs(model));
    if (model.update) {
      add_remarks(remarks_on_shapes(*model.update, result_));
    }
    return model;
  }

  TapIdentification result_;
  TapRemarks tap_remarks_;
  int impacts_{0};
  std::optional<protocols::Protocol> protocol_;
  core::ProgressHook hook_;
};
}  // namespace

void sum_up_modes(ModalFindings& findings) {
  std::vector<analysis::MeasuredRatio> ratios;
  for (std::size_t i = 0; i < findings.modes.size(); ++i) {
    const analysis::RepeatedMode& mode = findings.modes[i];
    if (mode.standing == analysis::Standing::agreed) {
      findings.agreed.push_back(i);
      ratios.push_back({mode.frequency_hz.value, mode.damping_ratio.value,
                        std::max(mode.damping_ratio.standard_error, 1e-12),
                        mode.degrees_of_freedom});
    }
  }
  findings.rayleigh = analysis::fit_rayleigh(ratios);
  if (findings.agreed.empty()) {
    findings.remarks.emplace_back("no mode was found for certain");
  }
}

std::vector<std::string> remarks_on_springs(const ModelComparison& model) {
  if (!model.is_on_springs || model.springs) {
    return {};
  }
  return {
      "Young's modulus and the stiffness of the springs cannot be told apart by these modes: the "
      "protocol's were kept (measure more modes, some of which bend the plate)"};
}

TapIdentification identify_taps(const TapQuestion& question, Progress& progress) {
  return Identifier{question, progress}.identify();
}
}  // namespace tapstudy::runner
