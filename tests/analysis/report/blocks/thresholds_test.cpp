#include "analysis/report/blocks/thresholds.hpp"

#include <cmath>
#include <random>

#include "analysis/report/document/wording.hpp"
#include "analysis/report/writers.hpp"
#include "analysis/statistics/detection/decision_model.hpp"
#include "analysis/statistics/psychometric/inference.hpp"
#include "core/error.hpp"
#include "core/psychometric_function.hpp"
#include "support/catch.hpp"
#include "support/formats.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using core::PsychometricShape;
using testing::Formats;
using testing::reported;

namespace {
constexpr double standard = 2000.0;
constexpr const char* statistic = "psychometric";
const std::vector<double> fractions{0.02, 0.03, 0.045, 0.07, 0.1, 0.15, 0.22, 0.33, 0.5};

BlockDesign design_of(double guess_rate = 0.5) {
  BlockDesign design;
  design.name = "stiffness";
  design.axis = VariedAxis{{"youngs_modulus_pa", "Young's modulus", "Pa"}, standard, true, false};
  design.guess_rate = guess_rate;
  return design;
}

results::AnswerRow answer_to(const std::string& participant, std::int64_t trial, double fraction,
                             bool is_correct) {
  results::AnswerRow answer;
  answer.participant_id = participant;
  answer.block = "stiffness";
  answer.number = static_cast<int>(trial);
  answer.trial_id = trial;
  answer.is_correct = is_correct;
  answer.alternatives = {
      {0, "A", "plate", {{"youngs_modulus_pa", standard}}, false},
      {1, "B", "plate", {{"youngs_modulus_pa", standard * (1.0 + fraction)}}, true}};
  return answer;
}

// A simulated observer whose answers follow the Weibull function.
std::vector<results::AnswerRow> observer(const std::string& name, double threshold, int per_level,
                                         std::uint64_t seed) {
  std::mt19937_64 generator{seed};
  std::vector<results::AnswerRow> answers;
  for (int i = 0; i < per_level; ++i) {
    for (const double fraction : fractions) {
      const double p =
          core::proportion(PsychometricShape::weibull, fraction, threshold, 2.0, 0.5, 0.02);
      const auto trial = static_cast<std::int64_t>(answers.size()) + 1;
      answers.push_back(
          answer_to(name, trial, fraction, std::bernoulli_distribution{p}(generator)));
    }
  }
  return answers;
}

std::vector<Level> levels_of(const std::vector<results::AnswerRow>& answers) {
  std::vector<Level> levels;
  for (std::size_t i = 0; i < fractions.size(); ++i) {
    levels.push_back({fractions[i], {}});
  }
  for (std::size_t k = 0; k < answers.size(); ++k) {
    Proportion& counted = levels[k % fractions.size()].answers;
    ++counted.trials;
    counted.successes += *answers[k].is_correct ? 1 : 0;
  }
  return levels;
}

std::vector<results::AnswerRow> joined(std::vector<results::AnswerRow> first,
                                       const std::vector<results::AnswerRow>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

const PsychometricModel model{PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};

PosteriorEstimates posterior_of(const std::vector<Level>& levels,
                                const PsychometricModel& of = model) {
  return *psychometric_posterior(of, levels, 0.95, prior_breadth).estimates;
}
}  // namespace

TEST_CASE("a report's interval holds the threshold of a simulated observer",
          "[analysis][thresholds][slow]") {
  std::vector<results::AnswerRow> answers;
  for (std::uint64_t i = 0; i < 20; ++i) {
    answers = joined(answers, observer("p" + std::to_string(i), 0.1, 40, i));
  }
  const auto json = reported(statistic, design_of(), answers).json;
  int held = 0;
  int fitted = 0;
  for (const auto& row : json["participants"]) {
    if (!row["threshold"].is_null()) {
      ++fitted;
      held += row["threshold_low"] <= 0.1 && row["threshold_high"] >= 0.1 ? 1 : 0;
    }
  }
  CHECK(fitted >= 18);
  CHECK(fitted - held <= 4);  // more have a probability of 0.3 % at a coverage of 95 %
  CHECK(json["pooled"][0]["participants"] == fitted);
  CHECK(json["pooled"][0]["threshold"].get<double>() == Approx(0.1).epsilon(0.1));
}

TEST_CASE("answers that fit a step have a threshold in it, with the profile's interval by NumPy",
          "[analysis][thresholds]") {
  std::vector<results::AnswerRow> answers;
  for (int i = 0; i < 40; ++i) {
    for (const double fraction : fractions) {
      answers.push_back(answer_to("p", static_cast<std::int64_t>(answers.size()), fraction,
                                  fraction > 0.12 || i % 2 == 0));
    }
  }
  const auto json = reported(statistic, design_of(), answers).json;
  const auto& person = json["participants"][0];
  const auto ends = testing::python_numbers(
      "x = np.array([0.02, 0.03, 0.045, 0.07, 0.1, 0.15, 0.22, 0.33, 0.5])\n"
      "k = np.where(x > 0.12, 40, 20)\n"
      "s = np.logspace(-1, 3, 1500)[:, None]\n"
      "def best(t):\n"
      "  f = 1 - np.exp(-np.exp(np.minimum(s * np.log(x / t), 50)))\n"
      "  p = np.clip(0.5 + 0.5 * f, 1e-12, 1 - 1e-12)\n"  // no lapse is likeliest
      "  return (k * np.log(p) + (40 - k) * np.log(1 - p)).sum(1).max()\n"
      "t = np.exp(np.linspace(np.log(0.05), np.log(0.2), 2001))\n"
      "l = np.array([best(v) for v in t])\n"
      "inside = t[l > l.max() - 3.841459 / 2]\n"
      "out(inside.min(), inside.max())");
  const auto& of_fit = json["fits"][0];
  CHECK(of_fit["likeliest_threshold"].get<double>() == Approx(std::sqrt(0.1 * 0.15)).epsilon(0.05));
  CHECK((person["threshold"].get<double>() > 0.1 && person["threshold"].get<double>() < 0.15));
  CHECK(of_fit["likeliest_threshold_low"].get<double>() == Approx(ends[0]).epsilon(2e-3));
  CHECK(of_fit["likeliest_threshold_high"].get<double>() == Approx(ends[1]).epsilon(2e-3));
  CHECK(json["fits"][0]["slope"].is_null());
  CHECK(json["fits"][0]["slope_low"].get<double>() > 1.0);
  CHECK(json["posteriors"][0]["posterior_threshold"].get<double>() > 0.1);
  CHECK(json["posteriors"][0]["posterior_threshold"].get<double>() < 0.15);
}

TEST_CASE(
    "a report's threshold is the posterior's, in both units, beside it that of the fit and those "
    "of "
    "half and twice the prior",
    "[analysis][thresholds]") {
  const auto answers = observer("p", 0.1, 30, 7);
  const std::vector<Level> levels = levels_of(answers);
  const PsychometricFit fit = fit_psychometric(model, levels);
  const PsychometricIntervals intervals = profile_intervals(model, levels);
  const Formats formats = reported(statistic, design_of(), answers);
  const auto& row = formats.json["participants"][0];
  const PosteriorEstimates posterior = posterior_of(levels);
  CHECK(row["threshold"].get<double>() == Approx(posterior.threshold).epsilon(1e-9));
  CHECK(row["threshold_low"].get<double>() ==
        Approx(posterior.threshold_interval.low).epsilon(1e-9));
  CHECK(row["threshold_high"].get<double>() ==
        Approx(posterior.threshold_interval.high).epsilon(1e-9));
  CHECK(row["weber_fraction"] == row["threshold"]);
  CHECK(row["jnd"].get<double>() == Approx(standard * posterior.threshold).epsilon(1e-9));
  const auto& of_prior = formats.json["priors"][0];
  CHECK(of_prior["threshold_prior"] == row["threshold"]);
  CHECK(of_prior["threshold_half_prior"].get<double>() ==
        Approx(
            psychometric_posterior(model, levels, 0.95, 0.5 * prior_breadth).estimates->threshold));
  CHECK(of_prior["threshold_twice_prior_high"].get<double>() ==
        Approx(psychometric_posterior(model, levels, 0.95, 2.0 * prior_breadth)
                   .estimates->threshold_interval.high));
  CHECK(row["proportion_at_threshold"].get<double>() ==
        Approx(0.5 + (0.5 - fit.curve->lapse) * (1.0 - std::exp(-1.0))).epsilon(1e-9));
  CHECK(row["correct_of"] == 270);
  const auto& of_fit = formats.json["fits"][0];
  CHECK(of_fit["likeliest_threshold"].get<double>() == Approx(fit.curve->threshold).epsilon(1e-9));
  CHECK(of_fit["likeliest_threshold_low"].get<double>() ==
        Approx(intervals.threshold.low).epsilon(1e-9));
  CHECK(of_fit["deviance_p"].get<double>() ==
        Approx(deviance_test(model, levels, 200, 1).p).margin(0.02));
  const auto& of_posterior = formats.json["posteriors"][0];
  CHECK(of_posterior["posterior_threshold_low"].get<double>() ==
        Approx(posterior.threshold_interval.low).epsilon(1e-9));
  CHECK(of_posterior["posterior_slope"].get<double>() == Approx(posterior.slope).epsilon(1e-9));
  CHECK(of_posterior["over_dispersion"].get<double>() ==
        Approx(posterior.eta.median).epsilon(1e-9));
}

TEST_CASE("levels that are differences have a threshold in the axis's unit and no Weber fraction",
          "[analysis][thresholds]") {
  const auto answers = observer("p", 0.1, 30, 7);
  BlockDesign design = design_of();
  design.axis->is_fraction = false;
  const auto of_difference = reported(statistic, design, answers).json["participants"][0];
  const auto of_fraction = reported(statistic, design_of(), answers).json["participants"][0];
  CHECK(of_difference["threshold"].get<double>() ==
        Approx(standard * of_fraction["threshold"].get<double>()).epsilon(1e-9));
  CHECK(of_difference["jnd"] == of_difference["threshold"]);
  CHECK(of_difference.count("weber_fraction") == 0);
}

TEST_CASE("comparisons below the standard have the thresholds of those above",
          "[analysis][thresholds]") {
  auto answers = observer("p", 0.1, 30, 7);
  const auto above = reported(statistic, design_of(), answers).json["participants"];
  for (results::AnswerRow& answer : answers) {
    double& value = answer.alternatives[1].axis_values["youngs_modulus_pa"];
    value = 2.0 * standard - value;
  }
  BlockDesign design = design_of();
  design.axis->is_below = true;
  const auto below = reported(statistic, design, answers).json["participants"];
  CHECK(below[0]["threshold"].get<double>() ==
        Approx(above[0]["threshold"].get<double>()).epsilon(1e-9));
}

TEST_CASE("the mean threshold is R's of participants' likeliest logarithms, not of one observer",
          "[analysis][thresholds]") {
  std::vector<results::AnswerRow> answers;
  std::vector<double> logarithms;
  for (const auto& [name, threshold, seed] :
       std::vector<std::tuple<std::string, double, std::uint64_t>>{
           {"a", 0.05, 1}, {"b", 0.1, 2}, {"c", 0.2, 3}}) {
    const auto of_one = observer(name, threshold, 40, seed);
    logarithms.push_back(std::log10(fit_psychometric(model, levels_of(of_one)).curve->threshold));
    answers = joined(answers, of_one);
  }
  const auto r = testing::r_numbers("x <- " + testing::r_vector(logarithms) +
                                    "; out(10^mean(x), 10^t.test(x)$conf.int, sd(x))");
  const auto row = reported(statistic, design_of(), answers).json["pooled"][0];
  CHECK(row["participants"] == 3);
  CHECK(row["threshold"].get<double>() == Approx(r.at(0)).epsilon(1e-9));
  CHECK(row["threshold_low"].get<double>() == Approx(r.at(1)).epsilon(1e-9));
  CHECK(row["jnd_high"].get<double>() == Approx(standard * r.at(2)).epsilon(1e-9));
  CHECK(row["sd_log10"].get<double>() == Approx(r.at(3)).epsilon(1e-9));
}

TEST_CASE("who has no threshold is given none, and every format says why",
          "[analysis][thresholds]") {
  auto answers = observer("always_right", 0.1, 8, 1);
  for (results::AnswerRow& answer : answers) {
    answer.is_correct = true;
  }
  const std::string reason{explanation(FitOutcome::all_successes)};
  const Formats formats = reported(statistic, design_of(), answers);
  CHECK(formats.json["participants"][0]["threshold"].is_null());
  CHECK(formats.json["participants"][0]["no_threshold_because"] == reason);
  CHECK(formats.json["pooled"].empty());
  CHECK_THAT(formats.csv.at("participants.csv"), Contains(reason));
  CHECK_THAT(formats.html, Contains("always_right has no threshold: " + reason));
  CHECK_THAT(formats.text, Contains("always_right has no threshold: " + reason.substr(0, 20)));
}

TEST_CASE("where somebody has no threshold the block's result is of the fit of all",
          "[analysis][thresholds]") {
  auto answers = joined(observer("a", 0.08, 12, 1),
                        joined(observer("b", 0.1, 12, 2), observer("c", 0.15, 12, 3)));
  const auto result_of = [](const std::vector<results::AnswerRow>& all) {
    return summarise_thresholds(design_of(), {all, {}})->main_results.at(0).estimate;
  };
  CHECK(result_of(answers) ==
        reported(statistic, design_of(), answers).json["pooled"][0]["threshold"].get<double>());
  auto always_right = observer("d", 0.01, 12, 4);
  for (results::AnswerRow& answer : always_right) {
    answer.is_correct = true;
  }
  answers = joined(answers, always_right);
  const Formats formats = reported(statistic, design_of(), answers);
  CHECK(formats.json["pooled"][0]["participants"] == 3);
  const auto population = formats.json["population"][0];
  CHECK(population["participants"] == 4);
  CHECK(population["threshold"] < formats.json["pooled"][0]["threshold"]);
  CHECK(result_of(answers) == population["threshold"].get<double>());
  CHECK(formats.json["population_participants"].size() == 4);
  const auto whole = summarise_thresholds(design_of(), {answers, {}});
  const std::string page = formats.html;  // what is read first is the block's result
  CHECK(page.find("one fit of all of them") < page.find("with a threshold alone, which biases it"));
  CHECK_THAT(in_words(whole->main_results.at(0), whole->number_who_answered()),
             Contains(", of 4 participants, 1 of them without a threshold of their own"));
  const auto told = formats.json["main_results"][0];  // to programs, too
  CHECK(told["estimate"] == population["threshold"]);
  CHECK(told["low"] == population["threshold_low"]);
  CHECK_THAT(told["in_words"].get<std::string>(),
             Contains(", of 4 participants, 1 of them without a threshold of their own"));
  const Chart& overview = whole->results().charts.at(0);
  CHECK(overview.name == "thresholds");
  CHECK(overview.bars.size() == 5);    // the fourth participant's alone, and the block's
  CHECK(overview.points.size() == 4);  // of which one is the block's
  CHECK(overview.points.back().x == whole->main_results.at(0).estimate);
  MainResult of_three = whole->main_results.at(0);
  of_three.people = 3;
  of_three.of_whom = "";
  CHECK_THAT(in_words(of_three, whole->number_who_answered()),
             Catch::Matchers::EndsWith("), of 3 of 4 participants"));
  CHECK_THAT(formats.text, Contains("which biases it; the fit"));
}

TEST_CASE("one level is reported as what it is, without a fit", "[analysis][thresholds]") {
  const Formats formats = reported(statistic, design_of(),
                                   {answer_to("p", 1, 0.1, true), answer_to("p", 2, 0.1, false)});
  CHECK(formats.json["levels"].size() == 1);
  CHECK_THAT(formats.text, Contains("two different values"));
}

TEST_CASE("trials without a comparison are counted as false alarms where answered wrongly",
          "[analysis][thresholds]") {
  auto answers = observer("p", 0.1, 10, 1);
  for (int i = 0; i < 8; ++i) {
    answers.push_back(answer_to("p", 1000 + i, 0.0, i >= 3));
    answers.back().alternatives[1].is_comparison = false;
  }
  const Formats formats = reported(statistic, design_of(), answers);
  CHECK(formats.json["false_alarms"][0]["false_alarms"] == 3);
  CHECK(formats.json["false_alarms"][0]["false_alarms_of"] == 8);
  CHECK(formats.json["participants"][0]["correct_of"] == 90);
}

TEST_CASE(
    "of same and different pairs, same ones of either value are the answers at the level 0, whose "
    "guess rate is free",
    "[analysis][thresholds]") {
  auto answers = observer("p", 0.1, 30, 3);
  std::vector<Level> levels = levels_of(answers);
  levels.push_back({0.0, {12, 60}});
  for (int i = 0; i < 60; ++i) {
    const bool is_of_comparison = i % 2 == 0;
    answers.push_back(answer_to("p", 1000 + i, is_of_comparison ? 0.12 : 0.0, i >= 12));
    for (auto& alternative : answers.back().alternatives) {
      alternative = answers.back().alternatives[1];
      alternative.is_comparison = is_of_comparison;
    }
  }
  BlockDesign design = design_of();
  design.has_own_guess_rate = true;
  const PsychometricModel of_rates{PsychometricShape::weibull, {0.0, 0.85}, {0.0, 0.1}};
  const PsychometricFit fit = fit_psychometric(of_rates, levels);
  const auto json = reported(statistic, design, answers).json;
  CHECK(json["false_alarms"][0]["false_alarms"] == 12);
  CHECK(json["false_alarms"][0]["false_alarms_of"] == 60);
  CHECK(json["participants"][0]["correct_of"] == 270);
  CHECK(json["participants"][0]["threshold"].get<double>() ==
        Approx(posterior_of(levels, of_rates).threshold).epsilon(1e-9));
  CHECK(json["fits"][0]["guess"].get<double>() == Approx(fit.curve->guess).epsilon(1e-9));
}

TEST_CASE("a block's function is the one that is fitted", "[analysis][thresholds]") {
  const auto answers = observer("p", 0.1, 30, 7);
  BlockDesign design = design_of();
  for (const auto shape : {PsychometricShape::log_logistic, PsychometricShape::logistic,
                           PsychometricShape::cumulative_gaussian}) {
    design.shape = shape;
    const PsychometricFit fit =
        fit_psychometric({shape, {0.5, 0.5}, {0.0, 0.1}}, levels_of(answers));
    const Formats formats = reported(statistic, design, answers);
    CHECK(formats.json["fits"][0]["likeliest_threshold"].get<double>() ==
          Approx(fit.curve->threshold).epsilon(1e-9));
    CHECK_THAT(formats.text, Contains(std::string{row_of(shape).name} + " function"));
  }
}

TEST_CASE("each level has the d' of its answers by the task's decision model",
          "[analysis][thresholds]") {
  const auto answers = observer("p", 0.1, 30, 7);
  BlockDesign design = design_of();
  design.decision_model = "forced_choice";
  const auto json = reported(statistic, design, answers).json;
  const std::vector<Level> levels = levels_of(answers);
  REQUIRE(json["levels"].size() == levels.size());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    CHECK(json["levels"][i]["d_prime"].get<double>() ==
          Approx(sensitivity({DecisionModel::forced_choice, 2}, levels[i].answers).d_prime)
              .epsilon(1e-9));
  }
}

TEST_CASE("interleaved procedures are drawn and listed as tracks of their own",
          "[analysis][thresholds]") {
  auto answers = observer("p", 0.1, 4, 1);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    answers[i].track = i % 3 == 0 ? 1 : 2;
  }
  const Formats formats = reported(statistic, design_of(), answers);
  CHECK(formats.json["tracks"][0]["track"] == 1);
  CHECK(formats.json["tracks"][1]["track"] == 2);
  CHECK_THAT(formats.html, Contains("aria-label=\"Levels of p, track 1 over 12 trials"));
  CHECK_THAT(formats.html, Contains("aria-label=\"Levels of p, track 2 over 24 trials"));
}

TEST_CASE("tracks follow the time of the trials, not the order of the rows",
          "[analysis][thresholds]") {
  auto answers = observer("p", 0.1, 4, 1);
  const auto in_order = reported(statistic, design_of(), answers);
  std::ranges::reverse(answers);
  const auto turned = reported(statistic, design_of(), answers);
  CHECK(turned.json == in_order.json);
  CHECK(in_order.json["tracks"].size() == 36);
  CHECK(in_order.json["tracks"][8]["level"].get<double>() == Approx(fractions[8]).epsilon(1e-9));
  CHECK(in_order.json["tracks"][9]["level"].get<double>() == Approx(fractions[0]).epsilon(1e-9));
}

TEST_CASE("a report of thresholds fits a terminal and names its figures",
          "[analysis][thresholds]") {
  const auto answers = joined(observer("a", 0.1, 20, 1), observer("b", 0.08, 20, 2));
  const Formats formats = reported(statistic, design_of(), answers);
  CHECK(testing::longest_line(formats.text) <= 100);
  CHECK_THAT(formats.html, Contains("aria-label=\"Psychometric function of a:"));
  CHECK_THAT(formats.html, Contains("aria-label=\"Levels of b over 180 trials"));
  Summary summary;
  summary.blocks = {summarise_thresholds(design_of(), {answers, {}})};
  const auto within = [&](std::size_t lines) {
    std::ostringstream out;
    write_text_within(out, summary, lines, all_lines);
    return out.str();
  };
  const std::string whole = within(10'000);
  REQUIRE(std::count(whole.begin(), whole.end(), '\n') > 60);
  const std::string screen = within(60);
  CHECK(std::count(screen.begin(), screen.end(), '\n') <= 60);
  CHECK_THAT(screen, Contains("Weber fraction of Young's modulus 0.") &&
                         Contains("of 2 participants") && Contains("lines: --all"));
  const std::string small = within(5);
  CHECK(std::count(small.begin(), small.end(), '\n') <= 5);
}

TEST_CASE("a threshold takes an axis, its values and answers that are right or wrong",
          "[analysis][thresholds]") {
  auto answers = observer("p", 0.1, 1, 1);
  BlockDesign without_axis = design_of();
  without_axis.axis.reset();
  CHECK_THROWS_AS(reported(statistic, without_axis, answers), core::InvalidInput);
  answers[0].alternatives[1].axis_values.clear();
  CHECK_THROWS_AS(reported(statistic, design_of(), answers), core::InvalidInput);
  answers = observer("p", 0.1, 1, 1);
  answers[0].is_correct.reset();
  CHECK_THROWS_AS(reported(statistic, design_of(), answers), core::InvalidInput);
  CHECK_THAT(reported(statistic, design_of(), {}).text, Contains("There are no answers"));
}
