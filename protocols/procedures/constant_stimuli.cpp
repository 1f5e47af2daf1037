#include <fmt/format.h>

#include <utility>

#include "core/random/rng.hpp"
#include "protocols/procedures/procedure.hpp"
namespace tapstudy::protocols {
namespace {
constexpr int max_repetitions = 1000;
constexpr std::size_t max_constant_trials = 100'000;

class ConstantTrack final : public Track {
 public:
  explicit ConstantTrack(std::vector<double> order) : Track{1, 2}, order_{std::move(order)} {}
  bool is_finished() const override { return trials() >= order_.size(); }
  TrackSummary summary() const override {
    TrackSummary summary;
    summary.trials = trials();
    summary.is_finished = is_finished();
    return summary;
  }

 private:
  std::vector<double> request() const override { return {order_[trials()]}; }
  void take(const std::vector<double>& /*presented*/, std::size_t /*outcome*/) override {}

  std::vector<double> order_;
};

// One repetition is each value once.
class ConstantSettings final : public TrackSettings {
 public:
  ConstantSettings(std::vector<double> values, std::size_t repetitions, bool is_within_repetition)
      : values_{std::move(values)},
        repetitions_{repetitions},
        is_within_repetition_{is_within_repetition} {}
  std::size_t axes() const override { return 1; }
  std::size_t outcomes() const override { return 2; }
  std::size_t max_trials() const override { return values_.size() * repetitions_; }
  std::vector<std::pair<double, double>> ranges() const override {
    return {{values_.front(), values_.back()}};
  }

  core::CitingText describe() const override {
    return fmt::format("the method of constant stimuli at {} levels, {} times each", values_.size(),
                       repetitions_);
  }
  std::unique_ptr<Track> start(std::uint64_t seed) const override {
    core::Rng rng{core::derived_seed(seed, core::Purpose::procedure)};
    std::vector<double> order;
    for (std::size_t repetition = 0; repetition < repetitions_; ++repetition) {
      std::vector<double> part = values_;
      if (is_within_repetition_) {
        rng.shuffle(part);
      }
      order.insert(order.end(), part.begin(), part.end());
    }
    if (!is_within_repetition_) {
      rng.shuffle(order);
    }
    return std::make_unique<ConstantTrack>(std::move(order));
  }

 private:
  std::vector<double> values_;
  std::size_t repetitions_;
  bool is_within_repetition_;
};

class ConstantStimuli final : public Procedure {
 public:
  std::string_view name() const override { return "constant"; }
  std::string_view meaning() const override {
    return "method of constant stimuli: given values in random order";
  }
  std::shared_ptr<const TrackSettings> read(MapReader& reader) const override {
    const auto values = read_grid(reader);
    const int repetitions = reader.integer({"repetitions", "of each value"}, 1, max_repetitions);
    const bool is_within_repetition = reader.one_of<bool>(
        {"order", "all presentations in random order, or each repetition by itself"},
        {{"shuffle_within_repetition", true}, {"shuffle", false}}, "shuffle");
    if (!values) {
      return nullptr;
    }
    const auto wanted = static_cast<std::size_t>(repetitions);
    if (values->size() * wanted > max_constant_trials) {
      reader.reject("repetitions", "make too many trials (at most 100000)");
      return nullptr;
    }
    return std::make_shared<const ConstantSettings>(*values, wanted, is_within_repetition);
  }
};
}  // namespace

const Procedure& constant_stimuli() {
  static const ConstantStimuli procedure;
  return procedure;
}
}  // namespace tapstudy::protocols
