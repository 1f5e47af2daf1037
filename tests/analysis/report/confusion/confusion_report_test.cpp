#include <fmt/format.h>

#include <regex>
#include <sstream>

#include "analysis/report/answer_tables/counts_csv.hpp"
#include "analysis/report/confusion/chance_tests.hpp"
#include "analysis/report/confusion/confusion_sections.hpp"
#include "analysis/report/confusion/confusion_summary.hpp"
#include "analysis/report/writers.hpp"
#include "analysis/statistics/contingency/agreement.hpp"
#include "analysis/statistics/contingency/information_transfer.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/formats.hpp"
#include "support/reference_programs.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using testing::r_numbers;
using testing::reported;

namespace {
constexpr const char* statistic = "confusion";

BlockDesign four_plates() {
  BlockDesign design;
  design.name = "plates";
  for (const std::string structure : {"two", "three"}) {
    for (const std::string material : {"acrylic", "mdf"}) {
      const std::string name = material + "_" + structure;
      design.stimuli.push_back({name, name, {{"structure", structure}, {"material", material}}});
    }
  }
  design.responses = design.stimuli;
  return design;
}

// Presents every plate `repetitions` times to each; who feels with that probability answers right,
// else guesses with a preference of their own.
std::vector<results::AnswerRow> answers_of(const BlockDesign& design, int participants,
                                           int repetitions, double felt, std::uint64_t seed) {
  core::Rng rng{seed};
  std::vector<results::AnswerRow> answers;
  std::int64_t trial_id = 0;
  for (int person = 0; person < participants; ++person) {
    const std::size_t preferred = rng.below(4);
    std::vector<std::size_t> order;
    for (int repetition = 0; repetition < repetitions; ++repetition) {
      order.insert(order.end(), {0, 1, 2, 3});
    }
    rng.shuffle(order);
    std::vector<int> presented(4, 0);
    for (std::size_t place = 0; place < order.size(); ++place) {
      const std::size_t guess = rng.uniform() < 0.3 ? preferred : rng.below(4);
      results::AnswerRow answer;
      answer.participant_id = fmt::format("P{:02}", person + 1);
      answer.participant_index = person;
      answer.block = design.name;
      answer.number = static_cast<int>(place) + 1;
      answer.place_in_block = answer.number - 1;
      answer.trial_id = ++trial_id;
      answer.stimulus = design.stimuli[order[place]].name;
      answer.response = design.responses[rng.uniform() < felt ? order[place] : guess].name;
      answer.is_correct = answer.stimulus == answer.response;
      answer.response_time_s = 2.0 + rng.uniform();
      answer.time_from_first_contact_s = answer.response_time_s - 0.5;
      answer.repetition = ++presented[order[place]];
      answer.impacts = 3 + static_cast<std::int64_t>(rng.below(3));
      answer.mean_impact_speed_m_s = 0.2;
      answer.contact_s = 0.5;
      answers.push_back(answer);
    }
  }
  return answers;
}

ChanceTests tested(const BlockDesign& design, const std::vector<results::AnswerRow>& answers,
                   const std::vector<std::string>& factors) {
  return chance_tests(randomisation_of(design, identification_data(design, answers)),
                      {design.stimuli, design.responses}, factors, {99, 1});
}

BlockDesign drawn(BlockDesign design, int repetitions) {
  design.redraw = [repetitions](const Place& place, std::uint64_t draw) {
    core::Rng rng{draw + static_cast<std::uint64_t>(place.participant_index)};
    std::vector<int> order;
    for (int repetition = 0; repetition < repetitions; ++repetition) {
      order.insert(order.end(), {0, 1, 2, 3});
    }
    rng.shuffle(order);
    return order;
  };
  design.hypotheses = {{"h", "Plates are told apart.", ""}};
  return design;
}
}  // namespace

TEST_CASE("a class that all participants name too often is found over participants, as R tests it",
          "[analysis][identification][r]") {
  const BlockDesign design = drawn(four_plates(), 4);
  auto answers = answers_of(design, 6, 4, 0.4, 3);
  std::vector<double> more(6, 0.0);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (i % 4 == 0) {
      answers[i].response = "acrylic_two";
      answers[i].is_correct = answers[i].stimulus == answers[i].response;
    }
    more[i / 16] += ((answers[i].response == "acrylic_two" ? 1.0 : 0.0) - 0.25) / 16.0;
  }
  const auto named = reported(statistic, design, answers).json["naming"];
  REQUIRE(named.size() == 4);
  std::string r = "d <- c(";
  for (const double difference : more) {
    r += fmt::format("{}{:.17g}", difference == more.front() && r.back() == '(' ? "" : ", ",
                     difference);
  }
  const auto expected =
      r_numbers(r +
                "); s <- as.matrix(expand.grid(rep(list(c(-1, 1)), length(d)))); t <- t.test(d);"
                "out(mean(d), t$conf.int, mean(abs(s %*% d) >= abs(sum(d)) - 1e-12))");
  CHECK(named[0]["difference"].get<double>() == Approx(expected[0]));
  CHECK(named[0]["difference_low"].get<double>() == Approx(expected[1]));
  CHECK(named[0]["p"].get<double>() == Approx(expected[3]));
  CHECK(named[0]["p"].get<double>() < 0.05);
}

TEST_CASE("of two classes the bias to name one is the other's, and one test",
          "[analysis][identification]") {
  BlockDesign design = four_plates();
  design.responses = {{"acrylic", "acrylic", {}}, {"mdf", "mdf", {}}};
  const auto material = [](const std::string& plate) { return plate.substr(0, plate.find('_')); };
  for (Item& stimulus : design.stimuli) {
    stimulus.right = material(stimulus.name);
  }
  auto answers = answers_of(four_plates(), 6, 4, 1.0, 3);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    answers[i].response = i % 5 == 0 ? "acrylic" : material(answers[i].stimulus);
    answers[i].is_correct = answers[i].response == material(answers[i].stimulus);
  }
  const auto named = reported(statistic, design, answers).json["naming"];
  REQUIRE(named.size() == 2);
  CHECK(named[0]["p"] == named[1]["p"]);
  CHECK(named[0]["p_holm"] == named[0]["p"]);
  CHECK(named[0]["difference"].get<double>() == -named[1]["difference"].get<double>());
}

TEST_CASE("four stimuli with two answers transfer one bit at most", "[analysis][identification]") {
  BlockDesign design = four_plates();
  design.responses = {{"acrylic", "acrylic", {}}, {"mdf", "mdf", {}}};
  auto answers = answers_of(four_plates(), 2, 4, 1.0, 1);
  for (Item& stimulus : design.stimuli) {
    stimulus.right = stimulus.name.substr(0, stimulus.name.find('_'));
  }
  for (results::AnswerRow& answer : answers) {
    answer.response = answer.stimulus.substr(0, answer.stimulus.find('_'));
  }
  const auto information = reported(statistic, design, answers).json["information"][0];
  CHECK(information["most_bits"].get<double>() == 1.0);
  CHECK(information["bits"].get<double>() == Approx(1.0));
}

TEST_CASE(
    "where several participants answered, no interval of accuracy treats answers as "
    "independent without saying so",
    "[analysis][identification]") {
  const BlockDesign design = drawn(four_plates(), 2);
  const auto formats = reported(statistic, design, answers_of(design, 10, 2, 0.4, 1));
  CHECK_THAT(formats.text, Contains("95 % CI over 10 participants"));
  const auto& all = formats.json["accuracy_estimates"][0];
  CHECK(all["over_participants_low"].get<double>() < all["share"].get<double>());
  CHECK(all["independent_wilson_low"].is_number());
  CHECK(formats.json["accuracy"]["over_participants_95"].size() == 2);
  CHECK(testing::longest_line(formats.text) <= 100);
  const auto alone = reported(statistic, design, answers_of(design, 1, 2, 0.4, 1));
  CHECK_THAT(alone.text, Contains("if answers are independent") && !Contains("95 % CI"));
}

TEST_CASE("information of a participant is refused below 5 k^2 answers, with the numbers",
          "[analysis][identification]") {
  const BlockDesign design = four_plates();
  const auto few = reported(statistic, design, answers_of(design, 3, 2, 0.4, 1));
  CHECK(few.json["information_participants"][0]["miller_madow_bits"].is_null());
  CHECK_THAT(few.html, !Contains("n/a: 8 answers") && Contains("or of one participant"));
  auto some = answers_of(design, 2, 20, 0.4, 1);
  const auto enough = reported(statistic, design, some);
  std::erase_if(some, [](const results::AnswerRow& answer) {
    return answer.participant_id == "P01" && answer.number > 8;
  });
  CHECK_THAT(reported(statistic, design, some).html, Contains("n/a: 8 answers &lt; 80"));
  CHECK(enough.json["information_participants"][0]["miller_madow_bits"].is_number());
}

TEST_CASE("a report says with a word what it cannot say", "[analysis][identification]") {
  BlockDesign design = four_plates();
  for (Item& item : design.stimuli) {
    item.factors = {{"structure", "two"}};
  }
  const auto one = reported(statistic, design, answers_of(design, 1, 1, 0.0, 2));
  CHECK(one.json["factors"].empty());
  CHECK(one.json["contrasts"].empty());
  CHECK(one.json["learning"].empty());
  CHECK(one.json["previous_trial"].empty());
  CHECK_THAT(one.html, Contains("No contrasts") && Contains("No learning") &&
                           Contains("not tested: nobody was presented a stimulus twice"));
  const auto none = reported(statistic, design, {});
  CHECK_THAT(none.text, !Contains("information transfer"));
  CHECK(none.json["accuracy"]["value"].is_null());
}

TEST_CASE("a class that nobody names leaves no hole in the report", "[analysis][identification]") {
  std::istringstream text{"stimulus,a,b,c\na,6,0,4\nb,5,0,5\nc,1,0,9\n"};
  const auto matrix = read_counts(read_csv(text, "counts.csv"), "counts.csv");
  const auto formats = testing::formats_of(IdentificationSummary{BlockDesign{}, matrix});
  CHECK_THAT(formats.html,
             Contains("No similarity-choice model") && !Contains(">nan") && !Contains(">inf"));
  CHECK(formats.json["dependence"][0]["degrees_of_freedom"] == 2.0);
}

TEST_CASE("every format of a report has the same tables, and each of them rows of its keys",
          "[analysis][identification]") {
  const BlockDesign design = drawn(four_plates(), 3);
  const auto formats = reported(statistic, design, answers_of(design, 6, 3, 0.5, 4));
  for (const auto& [name, csv] : formats.csv) {
    if (name == "confusion.csv") {
      continue;
    }
    const auto& rows = formats.json.at(name.substr(0, name.size() - 4));
    CHECK(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) == rows.size() + 1);
  }
  CHECK_THAT(formats.html, Contains("<details class=section><summary><h3>") &&
                               Contains("<a class=anchor id=\"section-block-plates-1\">"));
  // rows of the table of cells add up to all answers, for each way to group them
  std::map<std::string, std::int64_t> sums;
  for (const auto& cell : formats.json["group_counts"]) {
    sums[cell["by"]] += cell["count"].get<std::int64_t>();
  }
  for (const std::string by :
       {"participant", "stimulus", "material", "structure", "presentation"}) {
    CHECK(sums[by] == 72);
  }
}

TEST_CASE("of so few that there is no interval the head has each one's value",
          "[analysis][identification]") {
  const BlockDesign design = drawn(four_plates(), 2);
  for (const int people : {1, 2, 3}) {
    CAPTURE(people);
    std::vector<results::AnswerRow> answers = answers_of(design, people, 2, 0.5, 4);
    for (results::AnswerRow& answer : answers) {  // of eight trials 6 right, then 5, then 4
      const bool is_right = answer.place_in_block < 6 - answer.participant_index;
      answer.response = is_right                       ? answer.stimulus
                        : answer.stimulus == "mdf_two" ? "mdf_three"
                                                       : "mdf_two";
      answer.is_correct = is_right;
    }
    Summary summary;
    summary.participants = people;
    summary.blocks = {find_statistic(statistic).summarise(design, {answers, {}})};
    std::ostringstream out;
    write_html(out, summary);
    const bool has_values =
        out.str().find(people == 1 ? "Share of right answers, chance 0.25: P01 0.75."
                                   : ": P01 0.75, P02 0.625.") != std::string::npos;
    CHECK(has_values == (people < 3));
  }
}

TEST_CASE("a page has its results in words first, methods before details, links to all of them",
          "[analysis][identification]") {
  const BlockDesign design = drawn(four_plates(), 3);
  Summary summary;
  summary.participants = 6;
  summary.blocks = {
      find_statistic(statistic).summarise(design, {answers_of(design, 6, 3, 0.5, 4), {}})};
  std::ostringstream out;
  write_html(out, summary);
  const std::string page = out.str();
  std::vector<std::size_t> places;
  for (const char* const part :
       {"6 participants answered", "Accuracy ", ", chance 25&nbsp;%).", "class=contents",
        "class=matrix", "<h2 id=methods>", "<details class=section>"}) {
    CAPTURE(part);
    places.push_back(page.find(part, page.find("</style>")));
    CHECK(places.back() != std::string::npos);
  }
  CHECK(std::ranges::is_sorted(places));
  CHECK_THAT(page, !Contains(", of 6 participants"));
  const std::regex link{"href=\"#([^\"]+)\""};
  std::size_t links = 0;
  for (auto at = std::sregex_iterator{page.begin(), page.end(), link}; at != std::sregex_iterator{};
       ++at, ++links) {
    const std::string id = (*at)[1];
    CAPTURE(id);
    CHECK((page.find("id=\"" + id + "\"") != std::string::npos ||
           page.find("id=" + id + ">") != std::string::npos));
  }
  CHECK(links > 10);
}

TEST_CASE("contrasts, learning and medians are those that R computes from the answers",
          "[analysis][identification]") {
  const BlockDesign design = four_plates();
  const auto answers = answers_of(design, 7, 3, 0.5, 9);
  const auto json = reported(statistic, design, answers).json;
  std::string person;
  std::string material;
  std::string right;
  std::string stimulus;
  std::string response;
  std::string repetition;
  std::string time;
  for (const auto& answer : answers) {
    const char* separator = person.empty() ? "" : ",";
    person += fmt::format("{}{}", separator, answer.participant_index);
    material += fmt::format("{}{}", separator, answer.stimulus.starts_with("mdf") ? 1 : 0);
    right += fmt::format("{}{}", separator, *answer.is_correct ? 1 : 0);
    stimulus += fmt::format("{}'{}'", separator, answer.stimulus);
    response += fmt::format("{}'{}'", separator, answer.response);
    repetition += fmt::format("{}{}", separator, answer.repetition);
    time += fmt::format("{}{:.17g}", separator, answer.response_time_s);
  }
  const auto r = r_numbers(
      "p <- c(" + person + "); m <- c(" + material + "); k <- c(" + right + "); r <- c(" +
      repetition + "); t <- c(" + time + "); z <- c(" + stimulus + "); a <- c(" + response +
      "); q <- mapply(function(i, j) mean(a[p == i] == j), p, z);"
      "s <- tapply(k - q, list(p, m), mean);"
      "d <- s[, 1] - s[, 2]; f <- function(d) { s <- as.matrix(expand.grid(rep(list(c(-1, 1)), "
      "length(d)))); mean(abs(s %*% d) >= abs(sum(d)) - 1e-9) };"
      "b <- sapply(split(data.frame(k, r), p), function(x) coef(lm(k ~ r, x))[2]);"
      "v <- tapply(t, p, median); u <- uniroot(function(a) (mean(v) - a)^2 - qt(.975, length(v) - "
      "1)^2 * var(v) / length(v) * a / mean(v), c(mean(v), 1e3), tol = 1e-13)$root;"
      "out(mean(d), t.test(d)$conf.int, f(d), mean(b), f(b), mean(v), quantile(t, .25), u)");
  const auto& contrast = json["contrasts"][0];
  CHECK(contrast["of"] == "material");
  CHECK(contrast["difference"].get<double>() == Approx(r[0]).margin(1e-12));
  CHECK(contrast["difference_low"].get<double>() == Approx(r[1]).epsilon(1e-9));
  CHECK(contrast["difference_high"].get<double>() == Approx(r[2]).epsilon(1e-9));
  CHECK(contrast["p"].get<double>() == Approx(r[3]).epsilon(1e-9));
  CHECK(json["learning"][0]["change"].get<double>() == Approx(r[4]).margin(1e-12));
  CHECK(json["learning"][0]["p"].get<double>() == Approx(r[5]).epsilon(1e-9));
  CHECK(json["response_times"][0]["mean_median_s"].get<double>() == Approx(r[6]).epsilon(1e-9));
  CHECK(json["response_times"][0]["mean_median_s_high"].get<double>() ==
        Approx(r[8]).epsilon(1e-8));
  CHECK(json["response_times"][0]["quartile_low_s"].get<double>() == Approx(r[7]).epsilon(1e-9));
}

TEST_CASE("a contrast that is 0 whatever is answered is not tested", "[analysis][identification]") {
  BlockDesign design = four_plates();
  design.stimuli = {design.stimuli.front(), design.stimuli.back()};
  design.responses = design.stimuli;
  std::vector<results::AnswerRow> answers = answers_of(four_plates(), 7, 6, 0.5, 9);
  std::erase_if(answers, [&](const results::AnswerRow& answer) {
    const auto is_there = [&](const std::string& name) {
      return name == design.stimuli[0].name || name == design.stimuli[1].name;
    };
    return !is_there(answer.stimulus) || !is_there(answer.response);
  });
  // each presented as often as the other to everybody
  std::map<std::pair<std::string, std::string>, int> counts;
  std::erase_if(answers, [&](const results::AnswerRow& answer) {
    return ++counts[{answer.participant_id, answer.stimulus}] > 1;
  });
  const auto formats = reported(statistic, design, answers);
  CHECK(formats.json["contrasts"].empty());
  CHECK_THAT(formats.html, Contains("Not tested, as the difference is 0 for each participant"));
}

TEST_CASE("a habit that all share is no difference between the levels of a factor",
          "[analysis][identification][slow]") {
  constexpr int studies = 400;
  for (const bool are_equal : {true, false}) {
    int significant = 0;
    for (std::uint64_t study = 0; study < studies; ++study) {
      const BlockDesign design = four_plates();
      core::Rng rng{study + 1};
      auto answers = answers_of(design, 10, 4, 0.0, 1000 + study);
      for (auto& answer : answers) {
        const double habit = are_equal ? 0.8 : 0.4 + 0.04 * answer.participant_index;
        answer.response = design.responses[rng.uniform() < habit ? 0 : 1 + rng.below(3)].name;
        answer.is_correct = answer.stimulus == answer.response;
      }
      const auto section = contrasts_section(identification_data(design, answers));
      const double p = std::get<double>(section.tables.at(0).rows.at(0).at(5).values.at(0));
      significant += p <= 0.05 ? 1 : 0;
    }
    INFO((are_equal ? "equal" : "unequal") << " preferences: " << significant << " of " << studies);
    CHECK(significant < 0.07 * studies + 8);  // two standard errors
    CHECK(significant > 0.03 * studies - 8);
  }
}

TEST_CASE("who is presented techniques that differ has contrasts of them",
          "[analysis][identification]") {
  BlockDesign design = four_plates();
  for (std::size_t i = 0; i < design.stimuli.size(); ++i) {
    design.stimuli[i].technique = i < 2 ? "simple" : "modal";
  }
  const auto json = reported(statistic, design, answers_of(design, 5, 2, 0.5, 9)).json;
  CHECK(json["contrasts"][0]["of"] == "technique");
  CHECK(json["contrasts"][0]["first"] == "simple");
}

TEST_CASE("agreement in a factor is tested by that factor's levels", "[analysis][identification]") {
  const BlockDesign design = drawn(four_plates(), 2);
  auto answers = answers_of(design, 4, 2, 1.0, 3);
  for (auto& answer : answers) {  // the other material of the right structure
    const bool is_mdf = answer.stimulus.starts_with("mdf");
    answer.response = is_mdf ? testing::replaced(answer.stimulus, "mdf", "acrylic")
                             : testing::replaced(answer.stimulus, "acrylic", "mdf");
    answer.is_correct = false;
  }
  const auto tests = tested(design, answers, {"material", "structure"});
  CHECK(tests.accuracy->p == 1.0);
  CHECK(tests.factors.at(0).p == 1.0);
  CHECK(tests.factors.at(1).p == 0.01);
}

TEST_CASE("an order drawn again is compared place by place with the answers",
          "[analysis][identification]") {
  BlockDesign design = drawn(four_plates(), 2);
  const auto answers = answers_of(design, 1, 2, 1.0, 3);
  std::vector<int> order;
  for (const auto& answer : answers) {
    const auto found = std::ranges::find(design.stimuli, answer.stimulus, &Item::name);
    order.push_back(static_cast<int>(found - design.stimuli.begin()));
  }
  design.redraw = [order](const Place& /*place*/, std::uint64_t /*draw*/) { return order; };
  // every draw is the order that was presented, so that each is as good
  CHECK(tested(design, answers, {}).accuracy->as_good == 99);
}

TEST_CASE(
    "of studies in which nobody felt anything but all have preferences, probabilities are no "
    "smaller than they say",
    "[analysis][identification][slow]") {
  constexpr int studies = 1000;
  const BlockDesign design = drawn(four_plates(), 2);
  constexpr int draws = 199;
  std::map<std::string, std::vector<double>> found;
  for (std::uint64_t study = 0; study < studies; ++study) {
    const auto data = identification_data(design, answers_of(design, 8, 2, 0.0, 1000 + study));
    const Randomisation randomisation = randomisation_of(design, data);
    const ConfusionMatrix matrix{design.stimuli, design.responses};
    const auto tests =
        chance_tests(randomisation, matrix, {"material", "structure"}, {draws, study});
    found["accuracy"].push_back(tests.accuracy->p);
    found["material"].push_back(tests.factors[0].p);
    found["structure"].push_back(tests.factors[1].p);
    const auto contrasts = contrasts_section(data);
    found["contrast"].push_back(
        std::get<double>(contrasts.tables.at(0).rows.at(0).at(5).values.at(0)));
    found["dependence"].push_back(monte_carlo_independence(*randomisation.tables, draws, study).p);
    found["information"].push_back(guessed_information(*randomisation.tables, draws, study).p);
    const auto serial = serial_dependence(sequences_of(data), draws, study);
    found["previous answer"].push_back(serial.repeated_answer.p);
    found["previous stimulus"].push_back(serial.last_right.p);
    found["learning"].push_back(learning_of(data)->p);
  }
  // Kolmogorov-Smirnov, one-sided: a valid test's probabilities lie at or above the uniform
  // distribution; beyond this distance by chance once in 10 000 (exp(-2 n d^2))
  const double limit = std::sqrt(std::log(10'000.0) / (2.0 * studies));
  for (auto& [name, p] : found) {
    std::ranges::sort(p);
    double above = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      above = std::max(above, static_cast<double>(i + 1) / static_cast<double>(p.size()) - p[i]);
    }
    INFO(name << ": " << above);
    CHECK(p.size() == studies);
    CHECK(above < limit);
    CHECK(p.front() < 0.05);  // it is a test
  }
}
