#include "analysis/statistics/psychometric/hierarchical.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/numerics.hpp"
#include "analysis/statistics/psychometric/inference.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::size_t position_cells = 241;
constexpr std::size_t slope_cells = 32;
constexpr std::size_t lapse_cells = 3;
constexpr std::size_t guess_cells = 6;

struct PopulationGrid {
  AxisRange range;    // of all people's levels
  GridAxis position;  // on the shape's axis
  GridAxis log_slope;
};

PopulationGrid grid_of(const PsychometricModel& model,
                       const std::vector<std::vector<Level>>& people) {
  constexpr double beyond = 2.0;   // of the levels' range
  constexpr double widest = 10.0;  // likewise
  constexpr double finest = 0.01;  // likewise: where levels are of many tracks
  std::vector<Level> all;
  for (const std::vector<Level>& levels : people) {
    all.insert(all.end(), levels.begin(), levels.end());
  }
  const AxisRange range = axis_range(checked_levels(all, model.shape), model.shape);
  const double width = width_of_unit_slope(model.shape);
  return {
      range,
      {range.low - beyond * range.length(), range.high + beyond * range.length(), position_cells},
      {std::log(width / (widest * range.length())),
       std::log(2.0 * width / std::max(range.smallest_gap, finest * range.length())), slope_cells}};
}

// The rates in a range, or the one that it is.
std::vector<double> rates_in(const Interval& range, std::size_t cells) {
  if (range.low == range.high) {
    return {range.low};
  }
  const GridAxis axis{range.low, range.high, cells};
  std::vector<double> rates;
  for (std::size_t i = 0; i < cells; ++i) {
    rates.push_back(axis.centre(i));
  }
  return rates;
}

// How people's lapse rates are distributed, as believed before they answer.
Eigen::VectorXd prior_of(const std::vector<double>& lapse_rates) {
  Eigen::VectorXd prior(static_cast<Eigen::Index>(lapse_rates.size()));
  for (std::size_t i = 0; i < lapse_rates.size(); ++i) {
    prior[static_cast<Eigen::Index>(i)] = std::exp(log_prior_of_rate(lapse_rates[i]));
  }
  return prior / prior.sum();
}

// The likelihood of one person's answers at each position (row) and ln slope (column), of each
// lapse rate, up to a factor.
using PersonLikelihood = std::vector<Eigen::MatrixXd>;
PersonLikelihood likelihood_of(const PsychometricModel& model, const std::vector<Level>& levels,
                               const PopulationGrid& grid) {
  const BinomialLikelihood likelihood{model.shape, levels, model.rates};
  const Interval guess = model.rates == Rates::equal ? Interval{0.0, 0.0} : model.guess;
  PersonLikelihood found;
  Eigen::MatrixXd logarithms(position_cells, slope_cells);
  double scale = -std::numeric_limits<double>::infinity();
  for (const double lapse_rate : rates_in(model.lapse, lapse_cells)) {
    found.emplace_back(Eigen::MatrixXd::Zero(position_cells, slope_cells));
    for (const double guess_rate : rates_in(guess, guess_cells)) {
      for (Eigen::Index i = 0; i < logarithms.rows(); ++i) {
        for (Eigen::Index j = 0; j < logarithms.cols(); ++j) {
          logarithms(i, j) = likelihood.value({grid.position.centre(static_cast<std::size_t>(i)),
                                               grid.log_slope.centre(static_cast<std::size_t>(j)),
                                               guess_rate, lapse_rate});
        }
      }
      const double most = std::max(scale, logarithms.maxCoeff());
      for (Eigen::MatrixXd& of_lapse : found) {
        of_lapse *= std::exp(scale - most);
      }
      found.back() += (logarithms.array() - most).exp().matrix();
      scale = most;
    }
  }
  return found;
}

// A normal distribution over the cells of an axis, never narrower than a cell.
struct NormalOverCells {
  double mean{};
  double deviation{};
  Eigen::VectorXd over(const GridAxis& axis) const {
    Eigen::VectorXd weights(static_cast<Eigen::Index>(axis.cells));
    for (std::size_t i = 0; i < axis.cells; ++i) {
      const double z = (axis.centre(i) - mean) / deviation;
      weights[static_cast<Eigen::Index>(i)] = std::exp(-0.5 * z * z);
    }
    return weights / weights.sum();
  }
};

// The first two moments of a distribution over the cells, added over people.
struct MomentsOverCells {
  double sum{};
  double squares{};
  void add(const Eigen::VectorXd& probabilities, const GridAxis& axis) {
    for (std::size_t i = 0; i < axis.cells; ++i) {
      const double p = probabilities[static_cast<Eigen::Index>(i)];
      sum += p * axis.centre(i);
      squares += p * axis.centre(i) * axis.centre(i);
    }
  }
  NormalOverCells normal(double people, const std::optional<double>& mean, double cell) const {
    const double at = mean.value_or(sum / people);
    const double variance = squares / people - 2.0 * at * sum / people + at * at;
    return {at, std::max(cell, std::sqrt(std::max(0.0, variance)))};
  }
};

class Population {
 public:
  Population(PopulationGrid grid, std::vector<PersonLikelihood> people, Eigen::VectorXd lapses)
      : grid_{grid},
        people_{std::move(people)},
        lapses_before_{std::move(lapses)},
        lapses_{lapses_before_},
        positions_{0.5 * (grid.range.low + grid.range.high), 0.5 * grid.range.length()},
        slopes_{0.5 * (grid.log_slope.low + grid.log_slope.high),
                0.25 * (grid.log_slope.high - grid.log_slope.low)} {}

  double count() const { return static_cast<double>(people_.size()); }
  const PopulationGrid& grid() const { return grid_; }
  const NormalOverCells& positions() const { return positions_; }
  const NormalOverCells& slopes() const { return slopes_; }

  // Climbs to the greatest log-likelihood, of this mean position if one is given, and returns it:
  // every third step of EM goes on from where two others lead (SQUAREM, Varadhan & Roland 2008,
  // step length S3), unless that is no improvement.
  double climb(const std::optional<double>& mean) {
    constexpr int most_steps = 200;
    constexpr double close = 1e-6;
    positions_.mean = mean.value_or(positions_.mean);
    double now = -std::numeric_limits<double>::infinity();
    for (int step = 0; step < most_steps; ++step) {
      const Parameters start = parameters();
      const double before = improve(mean);
      const Parameters first = parameters() - start;
      improve(mean);
      const Parameters end = parameters();
      const Parameters bend = end - start - 2.0 * first;
      const double length = std::max(1.0, first.norm() / std::max(bend.norm(), 1e-12));
      set(start + 2.0 * length * first + length * length * bend);
      now = improve(mean);
      if (!(now >= before)) {
        set(end);
        now = improve(mean);
      }
      if (now - before < close) {
        break;
      }
    }
    return now;
  }

  // Climbs from here on as from there, of the same people.
  void start_as(const Population& other) {
    positions_ = other.positions_;
    slopes_ = other.slopes_;
    lapses_ = other.lapses_;
  }

  // A person's probability of each cell.
  Eigen::VectorXd of_person(std::size_t i) const {
    const Eigen::VectorXd steep = slopes_.over(grid_.log_slope);
    Eigen::VectorXd probabilities = Eigen::VectorXd::Zero(position_cells);
    for (Eigen::Index lapse = 0; lapse < lapses_.size(); ++lapse) {
      probabilities += lapses_[lapse] * (people_[i][static_cast<std::size_t>(lapse)] * steep);
    }
    probabilities.array() *= positions_.over(grid_.position).array();
    return probabilities / probabilities.sum();
  }

 private:
  // Means and logarithms of deviations, of positions and of ln slopes; logarithms of the shares of
  // people with each lapse rate.
  using Parameters = Eigen::VectorXd;
  Parameters parameters() const {
    Parameters now(4 + lapses_.size());
    now << positions_.mean, std::log(positions_.deviation), slopes_.mean,
        std::log(slopes_.deviation), lapses_.array().log().matrix();
    return now;
  }
  void set(const Parameters& to) {
    positions_ = {to[0], std::max(grid_.position.cell(), std::exp(to[1]))};
    slopes_ = {to[2], std::max(grid_.log_slope.cell(), std::exp(to[3]))};
    lapses_ = to.tail(lapses_.size()).array().exp();
    lapses_ /= lapses_.sum();
  }

  // A step of EM; the log-likelihood before it, with what is believed of lapses.
  double improve(const std::optional<double>& mean) {
    const Eigen::VectorXd at = positions_.over(grid_.position);
    const Eigen::VectorXd steep = slopes_.over(grid_.log_slope);
    double log_likelihood = lapses_before_.dot(lapses_.array().log().matrix());
    MomentsOverCells of_positions;
    MomentsOverCells of_slopes;
    Eigen::VectorXd lapses = lapses_before_;
    for (const PersonLikelihood& person : people_) {
      Eigen::VectorXd by_position = Eigen::VectorXd::Zero(at.size());
      Eigen::VectorXd by_slope = Eigen::VectorXd::Zero(steep.size());
      Eigen::VectorXd by_lapse(lapses_.size());
      for (Eigen::Index lapse = 0; lapse < lapses_.size(); ++lapse) {
        const Eigen::MatrixXd& of_lapse = person[static_cast<std::size_t>(lapse)];
        const Eigen::VectorXd own = lapses_[lapse] * at.cwiseProduct(of_lapse * steep);
        by_position += own;
        by_slope += lapses_[lapse] * steep.cwiseProduct(of_lapse.transpose() * at);
        by_lapse[lapse] = own.sum();
      }
      const double all = std::max(by_position.sum(), std::numeric_limits<double>::min());
      log_likelihood += std::log(all);
      of_positions.add(by_position / all, grid_.position);
      of_slopes.add(by_slope / all, grid_.log_slope);
      lapses += by_lapse / all;
    }
    positions_ = of_positions.normal(count(), mean, grid_.position.cell());
    slopes_ = of_slopes.normal(count(), {}, grid_.log_slope.cell());
    lapses_ = lapses / lapses.sum();
    return log_likelihood;
  }

  PopulationGrid grid_;
  std::vector<PersonLikelihood> people_;
  Eigen::VectorXd lapses_before_;  // shares of people with each lapse rate
  Eigen::VectorXd lapses_;
  NormalOverCells positions_;
  NormalOverCells slopes_;
};

// One end of the profile interval on the axis; infinite where the grid does not hold it.
double profile_end(const Population& fitted, double most, double limit, double direction) {
  Population at = fitted;
  // Always from the maximum: a climb from where the last one ended may end on another hill.
  const auto excess = [&](double mean) {
    at.start_as(fitted);
    return 2.0 * (most - at.climb(mean)) - limit;
  };
  const GridAxis& axis = fitted.grid().position;
  double inside = fitted.positions().mean;
  double step = std::max(axis.cell(), fitted.positions().deviation / std::sqrt(at.count()));
  while (inside > axis.low && inside < axis.high) {
    const double outside = inside + direction * step;
    if (excess(outside) > 0.0) {
      return root(excess, inside, outside);
    }
    inside = outside;
    step *= 1.5;
  }
  return direction * std::numeric_limits<double>::infinity();
}

// Below this share of a person's probability, the cells taken as even within.
double position_at_share(const Eigen::VectorXd& probabilities, const GridAxis& axis, double share) {
  double below = 0.0;
  for (std::size_t i = 0; i < axis.cells; ++i) {
    const double p = probabilities[static_cast<Eigen::Index>(i)];
    if (below + p >= share) {
      return axis.low + (static_cast<double>(i) + (share - below) / p) * axis.cell();
    }
    below += p;
  }
  return axis.high;
}

PopulationFit::Person person_of(const Eigen::VectorXd& probabilities, const GridAxis& axis,
                                core::PsychometricShape shape, double confidence) {
  MomentsOverCells moments;
  moments.add(probabilities, axis);
  const auto at = [&](double share) {
    return from_axis(shape, position_at_share(probabilities, axis, share));
  };
  return {from_axis(shape, moments.sum),
          {at(0.5 * (1.0 - confidence)), at(0.5 * (1.0 + confidence))}};
}

// Two different levels, above 0 on a logarithmic axis.
bool has_levels(const std::vector<std::vector<Level>>& people, core::PsychometricShape shape) {
  std::vector<double> values;
  for (const std::vector<Level>& levels : people) {
    for (const Level& level : levels) {
      if (level.answers.trials > 0 && (level.value > 0.0 || !core::row_of(shape).is_logarithmic)) {
        values.push_back(level.value);
      }
    }
  }
  return !values.empty() && std::ranges::min(values) < std::ranges::max(values);
}
}  // namespace

std::optional<PopulationFit> fit_population(const PsychometricModel& model,
                                            const std::vector<std::vector<Level>>& people,
                                            double confidence) {
  constexpr std::size_t fewest = 3;
  if (people.size() < fewest || !has_levels(people, model.shape)) {
    return std::nullopt;
  }
  const PopulationGrid grid = grid_of(model, people);
  std::vector<PersonLikelihood> of_people;
  for (const std::vector<Level>& levels : people) {
    of_people.push_back(likelihood_of(model, levels, grid));
  }
  Population population{grid, std::move(of_people), prior_of(rates_in(model.lapse, lapse_cells))};
  const double most = population.climb({});
  const double mean = population.positions().mean;
  if (mean < grid.range.low || mean > grid.range.high) {
    return std::nullopt;
  }
  const double n = population.count();
  const double t = t_quantile(0.5 * (1.0 + confidence), n - 1.0);
  const double limit = n * std::log1p(t * t / (n - 1.0));
  PopulationFit fit{from_axis(model.shape, mean),
                    {from_axis(model.shape, profile_end(population, most, limit, -1.0)),
                     from_axis(model.shape, profile_end(population, most, limit, 1.0))},
                    population.positions().deviation,
                    population.slopes().mean,
                    population.slopes().deviation,
                    {}};
  for (std::size_t i = 0; i < people.size(); ++i) {
    fit.people.push_back(
        person_of(population.of_person(i), grid.position, model.shape, confidence));
  }
  return fit;
}
}  // namespace tapstudy::analysis
