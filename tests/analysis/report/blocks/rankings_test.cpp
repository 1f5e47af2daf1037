// Rankings of all stimuli, against R's conditional logit: a ranking is a choice of the first among
// all, then of the second among those left, and so on (Luce 1959).
#include <random>
#include <sstream>

#include "analysis/statistics/scaling/preference_scales.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/formats.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using testing::r_numbers;
using testing::r_vector;
using testing::reported;

namespace {
const std::vector<std::string> names{"steel", "wood", "rubber", "glass"};

// With worths 4, 3, 2, 1.
std::vector<Ranking> rankings(int count, std::uint64_t seed) {
  std::mt19937_64 generator{seed};
  std::vector<Ranking> all;
  for (int i = 0; i < count; ++i) {
    Ranking left{0, 1, 2, 3};
    Ranking placed;
    while (!left.empty()) {
      std::vector<double> worths;
      for (const std::size_t item : left) {
        worths.push_back(4.0 - static_cast<double>(item));
      }
      const auto next = std::discrete_distribution<>{worths.begin(), worths.end()}(generator);
      placed.push_back(left[static_cast<std::size_t>(next)]);
      left.erase(left.begin() + next);
    }
    all.push_back(placed);
  }
  return all;
}

std::vector<results::AnswerRow> answers_of(const std::vector<Ranking>& all, int people) {
  std::vector<results::AnswerRow> answers;
  for (const Ranking& ranking : all) {
    results::AnswerRow answer;
    answer.participant_id = "p" + std::to_string(answers.size() % static_cast<std::size_t>(people));
    for (const std::size_t item : ranking) {
      answer.response += (answer.response.empty() ? "" : " ") + names[item];
    }
    answers.push_back(answer);
  }
  return answers;
}

BlockDesign design() {
  BlockDesign design;
  design.name = "order";
  for (const std::string& name : names) {
    design.stimuli.push_back({name, name, {}});
  }
  return design;
}

// Row by row.
std::string r_orders(const std::vector<Ranking>& all) {
  std::vector<std::size_t> flat;
  for (const Ranking& ranking : all) {
    for (const std::size_t item : ranking) {
      flat.push_back(item + 1);
    }
  }
  return "o <- matrix(" + r_vector(flat) + ", ncol = 4, byrow = TRUE);\n";
}
}  // namespace

TEST_CASE("worths of rankings are those of a conditional logit of their choices",
          "[analysis][rankings]") {
  const std::vector<Ranking> all = rankings(60, 5);
  const PreferenceScale scale = plackett_luce({all}, 4);
  const auto r = r_numbers(r_orders(all) + R"(library(survival)
    d <- do.call(rbind, lapply(seq_len(nrow(o)), function(i) do.call(rbind, lapply(1:3, function(k)
      data.frame(item = o[i, k:4], chosen = c(1, rep(0, 4 - k)), set = paste(i, k))))))
    f <- clogit(chosen ~ factor(item) + strata(set), d, method = "exact",
                control = coxph.control(eps = 1e-13, toler.chol = 1e-14))
    out(coef(f), sqrt(diag(vcov(f))), f$loglik[2]))");
  for (Eigen::Index item = 1; item < 4; ++item) {
    const ScaleDifference from_first = difference(scale, item, 0);
    CHECK(from_first.value == Approx(r[static_cast<std::size_t>(item - 1)]).epsilon(1e-9));
    CHECK(from_first.standard_error == Approx(r[static_cast<std::size_t>(item + 2)]).epsilon(1e-9));
  }
  CHECK(scale.log_likelihood == Approx(r[6]).epsilon(1e-10));
}

TEST_CASE("a report of rankings tests participants' mean places", "[analysis][rankings]") {
  const std::vector<Ranking> all = rankings(24, 8);
  const auto json = reported("rankings", design(), answers_of(all, 8)).json;
  const auto r = r_numbers(testing::exact_signed_rank_p + r_orders(all) + R"(
    places <- t(apply(o, 1, order)); person <- (seq_len(24) - 1) %% 8
    m <- apply(places, 2, function(x) tapply(x, person, mean)); f <- friedman.test(m)
    p <- combn(4, 2, function(k) exact_signed_rank_p(round(m[, k[1]] - m[, k[2]], 9)))
    out(f$statistic, f$p.value, f$statistic / (8 * 3), colMeans(places), p.adjust(p, 'holm')))");
  CHECK(json["friedman"][0]["chi_squared"].get<double>() == Approx(r[0]).epsilon(1e-9));
  CHECK(json["friedman"][0]["p"].get<double>() == Approx(r[1]).margin(0.05));  // by chi-squared
  CHECK(json["friedman"][0]["kendalls_w"].get<double>() == Approx(r[2]).epsilon(1e-9));
  for (std::size_t item = 0; item < 4; ++item) {
    CHECK(json["stimuli"][item]["mean_place"].get<double>() == Approx(r[3 + item]).epsilon(1e-12));
  }
  REQUIRE(json["pairs"].size() == 6);
  for (std::size_t pair = 0; pair < 6; ++pair) {
    CHECK(json["pairs"][pair]["p_holm"].get<double>() == Approx(r[7 + pair]).epsilon(1e-9));
  }
}

TEST_CASE("a stimulus that is first in every ranking has no finite worth, and the report says so",
          "[analysis][rankings]") {
  const std::vector<Ranking> all{{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}};
  CHECK_THROWS_AS(plackett_luce({all}, 4), core::InvalidInput);
  const auto formats = reported("rankings", design(), answers_of(all, 3));
  CHECK(formats.json["stimuli"][0]["log_worth"].is_null());
  CHECK(formats.json["stimuli"][0]["place_1"] == 3);
  CHECK_THAT(formats.text, Contains("There are no worths"));
  CHECK(testing::longest_line(formats.text) <= 100);
}

TEST_CASE("an answer that does not rank every stimulus once is refused", "[analysis][rankings]") {
  for (const char* const response : {"", "steel wood rubber", "steel wood rubber wood",
                                     "steel wood rubber glass steel", "steel wood rubber brass"}) {
    CAPTURE(response);
    std::vector<results::AnswerRow> answers = answers_of({{0, 1, 2, 3}}, 1);
    answers.front().response = response;
    CHECK_THROWS_AS(reported("rankings", design(), answers), core::InvalidInput);
  }
}

TEST_CASE("a report of no rankings is of no numbers", "[analysis][rankings]") {
  const auto formats = reported("rankings", design(), {});
  CHECK(formats.json["stimuli"].empty());
  CHECK_THAT(formats.text, Contains("There are no answers."));
}
