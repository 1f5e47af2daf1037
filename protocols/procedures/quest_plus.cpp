// What a protocol says of QUEST+ and of the psi method.
#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "protocols/procedures/likelihood_table.hpp"
#include "protocols/procedures/procedure.hpp"
#include "protocols/procedures/quest_plus_track.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
// The prior of a parameter, a weight for each of its values: `prior` uniform, normal (exp(-(x -
// mean)^2 / 2 sd^2)), log_normal (the same of log10 x and log10 mean; sd in decades) or listed
// (`weights`). Empty: a problem was noted, or there are no values.
std::vector<double> read_prior(MapReader& reader, const std::vector<double>& values);

namespace {
enum class Prior { uniform, normal, log_normal, listed };

std::vector<double> bell_weights(MapReader& reader, const std::vector<double>& values,
                                 bool is_log) {
  const double mean = reader.number({"mean", "of the normal prior; of log_normal its median"},
                                    {-largest_value, largest_value});
  const double deviation = reader.number({"sd", "of the normal prior; of log_normal in decades"},
                                         Range::positive(largest_value));
  if (values.empty()) {
    return {};
  }
  if (is_log && (mean <= 0.0 || values.front() <= 0.0)) {
    reader.reject("prior", "is log_normal, but its mean or its values are not all above 0");
    return {};
  }
  std::vector<double> weights;
  double sum = 0.0;
  for (const double value : values) {
    const double distance = is_log ? std::log10(value / mean) : value - mean;
    weights.push_back(std::exp(-0.5 * distance * distance / (deviation * deviation)));
    sum += weights.back();
  }
  if (!(sum > 0.0)) {
    reader.reject("prior", "excludes every value: mean is too far from them for this sd");
    return {};
  }
  return weights;
}

std::vector<double> listed_weights(MapReader& reader, std::size_t values) {
  std::vector<double> weights = reader.number_list(
      {"weights", "prior weight of each value, not all 0"}, {0.0, largest_value});
  if (values == 0) {
    return {};
  }
  if (weights.size() != values) {
    reader.reject("weights", fmt::format("are {}, values are {}", weights.size(), values));
    return {};
  }
  if (!(std::accumulate(weights.begin(), weights.end(), 0.0) > 0.0)) {
    reader.reject("weights", "are all 0: the prior excludes every value");
    return {};
  }
  return weights;
}

void refuse_keys_of_others(MapReader& reader, Prior prior) {
  const bool is_bell = prior == Prior::normal || prior == Prior::log_normal;
  for (const char* key : {"mean", "sd"}) {
    if (!is_bell) {
      reader.refuse(key, "is for prior: normal or log_normal only");
    }
  }
  if (prior != Prior::listed) {
    reader.refuse("weights", "is for prior: listed only");
  }
}
}  // namespace

std::vector<double> read_prior(MapReader& reader, const std::vector<double>& values) {
  const auto prior =
      reader.one_of<Prior>({"prior",
                            "weight of each value before the first answer: equal; a normal "
                            "distribution of the value or of its logarithm to base 10; or listed"},
                           {{"uniform", Prior::uniform},
                            {"normal", Prior::normal},
                            {"log_normal", Prior::log_normal},
                            {"listed", Prior::listed}},
                           "uniform");
  refuse_keys_of_others(reader, prior);
  if (prior == Prior::uniform) {
    return std::vector<double>(values.size(), 1.0);
  }
  if (prior == Prior::listed) {
    return listed_weights(reader, values.size());
  }
  return bell_weights(reader, values, prior == Prior::log_normal);
}

namespace {
using Presence = MapReader::Presence;
constexpr int max_quest_trials = 1000;
// What can be wrong with grids before they make a design.
class DesignReader {
 public:
  DesignReader(MapReader& reader, const core::PsychometricShapeRow& shape)
      : reader_{&reader}, shape_{&shape} {}

  void read_curve() {
    reader_->map({"stimulus", "values of the first axis, that of the psychometric function"},
                 Presence::required, [&](MapReader& own) { read_axis(own); });
    if (!design_.axes.empty() && shape_->is_logarithmic && design_.axes[0].front() < 0.0) {
      refuse("stimulus", fmt::format("has values below 0, where {} is not defined", shape_->name));
    }
    read_parameter(
        {"threshold", "stimulus value at which F is one half (weibull, gumbel: 1 - 1/e)"},
        threshold_range());
    read_parameter(
        {"slope",
         "steepness of F per unit of the value, or per decade for shapes of the logarithm"},
        Range::positive(largest_value));
  }
  void read_parameter(const Key& key, const Range& range) {
    reader_->map(key, Presence::required,
                 [&](MapReader& own) { add_parameter(own, key.name, range); });
  }
  void read_fixed(const Key& key, const Range& range) {
    design_.parameters.push_back({key.name, {reader_->number(key, range)}, {1.0}, false});
  }
  void read_further_axes() {
    reader_->list(
        {"further_axes",
         "of the stimuli, which move the threshold; those of the block's `further_axes`, in their "
         "order"},
        Presence::optional, [&](MapReader& own) {
          const std::string name = fmt::format("effect_{}", design_.axes.size() + 1);
          read_axis(own);
          origins_.push_back(own.number(
              {"origin", "value on the axis at which the threshold is as `threshold` says"},
              {-largest_value, largest_value}, 0.0));
          own.map({"effect",
                   "shift of the threshold (of its logarithm to base 10, for shapes of the "
                   "logarithm) per unit of this axis"},
                  Presence::required, [&](MapReader& effect) {
                    add_parameter(effect, name, {-largest_value, largest_value});
                  });
        });
  }
  void check_rates() {
    if (is_complete() && highest(2) + highest(3) >= 1.0) {
      refuse("lapse", "and guess reach 1 together: nothing would be left to the stimulus");
    }
  }
  Range threshold_range() const {
    return shape_->is_logarithmic ? Range::positive(largest_value)
                                  : Range{-largest_value, largest_value};
  }

  std::shared_ptr<const TrackSettings> built(const QuestPlusStop& stop,
                                             const core::CitingText& method) {
    if (!is_complete()) {
      return nullptr;
    }
    design_.model = psychometric_model(shape_->shape, origins_);
    try {
      return std::make_shared<const QuestPlusSettings>(
          design_, stop, QuestPlusSettings::Method{method, shape_->shape});
    } catch (const core::InvalidInput& error) {
      reader_->reject(error.what());
      return nullptr;
    }
  }

 private:
  void refuse(const std::string& key, const std::string& what) {
    reader_->reject(key, what);
    is_refused_ = true;
  }
  // Axes and parameters that were refused are missing.
  bool is_complete() const {
    return !is_refused_ && !design_.axes.empty() &&
           design_.parameters.size() == 4 + design_.axes.size() - 1;
  }
  double highest(std::size_t parameter) const {
    return design_.parameters[parameter].values.back();
  }

  void read_axis(MapReader& own) {
    const auto values = read_grid(own);
    is_refused_ = is_refused_ || !values;
    design_.axes.push_back(values.value_or(std::vector<double>{0.0}));
  }

  void add_parameter(MapReader& own, const std::string& name, const Range& range) {
    const auto values = read_grid(own, range);
    const bool is_nuisance = own.yes_or_no(
        {"nuisance", "estimated, but stimuli are not chosen to learn about it"}, false);
    const std::vector<double> weights = read_prior(own, values.value_or(std::vector<double>{}));
    if (!values || weights.empty()) {
      is_refused_ = true;
      return;
    }
    if (!range.contains(values->front()) || !range.contains(values->back())) {
      own.reject(fmt::format("has values from {} to {}, each must be {}", values->front(),
                             values->back(), range.words()));
      is_refused_ = true;
    }
    design_.parameters.push_back({name, *values, weights, is_nuisance});
  }

  MapReader* reader_;
  const core::PsychometricShapeRow* shape_;
  QuestPlusDesign design_;
  std::vector<double> origins_;  // of the further axes
  bool is_refused_{false};
};

const core::PsychometricShapeRow& read_function(MapReader& reader) {
  const auto* const row = core::find_psychometric_shape(
      reader.word({"function",
                   "shape F of the psychometric function guess + (1 - guess - lapse) F "
                   "(core/psychometric_function.hpp)"},
                  "psychometric function", core::psychometric_shape_names()));
  return row == nullptr ? core::psychometric_shapes().front() : *row;
}

QuestPlusStop read_stop(MapReader& top, bool may_be_narrow) {
  QuestPlusStop stop;
  top.map({"stop", "when it ends: whichever comes first"}, Presence::required,
          [&](MapReader& reader) {
            stop.trials = static_cast<std::size_t>(
                reader.integer({"trials", "at most so many trials"}, 1, max_quest_trials));
            if (may_be_narrow && reader.has("threshold_sd")) {
              stop.standard_deviation =
                  reader.number({"threshold_sd",
                                 "once the posterior standard deviation of the threshold is at "
                                 "most this; unset: after trials only"},
                                Range::positive(largest_value));
            }
          });
  return stop;
}

const Range rate{0.0, 1.0, true, false};
Key guess_key() {
  return {"guess", "proportion correct far below the threshold"};
}
Key lapse_key() {
  return {"lapse", "proportion incorrect far above it"};
}

class QuestPlus final : public Procedure {
 public:
  std::string_view name() const override { return "quest_plus"; }
  std::string_view meaning() const override {
    return "QUEST+: the stimulus after which the posterior of the parameters is "
           "expected to have the least entropy";
  }
  std::shared_ptr<const TrackSettings> read(MapReader& reader) const override {
    DesignReader design{reader, read_function(reader)};
    design.read_curve();
    design.read_parameter(guess_key(), rate);
    design.read_parameter(lapse_key(), rate);
    design.read_further_axes();
    design.check_rates();
    return design.built(read_stop(reader, true), core::citing("QUEST+ ({})", "Watson 2017"_source));
  }
};

class Psi final : public Procedure {
 public:
  std::string_view name() const override { return "psi"; }
  std::string_view meaning() const override { return "psi method: QUEST+ of threshold and slope"; }
  std::shared_ptr<const TrackSettings> read(MapReader& reader) const override {
    DesignReader design{reader, read_function(reader)};
    design.read_curve();
    design.read_fixed(guess_key(), rate);
    design.read_fixed(lapse_key(), rate);
    design.check_rates();
    return design.built(read_stop(reader, false),
                        core::citing("the psi method ({})", "Kontsevich & Tyler 1999"_source));
  }
};
}  // namespace

const Procedure& quest_plus() {
  static const QuestPlus procedure;
  return procedure;
}
const Procedure& psi() {
  static const Psi procedure;
  return procedure;
}
}  // namespace tapstudy::protocols
