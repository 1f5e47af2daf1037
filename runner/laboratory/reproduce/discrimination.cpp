// Section 5.2.1 and Table 2: which real plate people take a virtual one for, beside a simulated
// observer whose one free parameter, the internal noise, is fitted on half of the cells.
#include "runner/laboratory/reproduce/discrimination.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include "analysis/report/answer_tables/counts_csv.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/rank_tests.hpp"
#include "core/files/scratch_directory.hpp"
#include "core/random/rng.hpp"
#include "results/store/store.hpp"
#include "results/store/study_queries.hpp"
#include "runner/laboratory/reproduce/claims.hpp"
#include "runner/laboratory/reproduce/paper_protocols.hpp"
#include "runner/studies/simulated_study.hpp"
namespace tapstudy::runner {
namespace {
using Row = std::vector<std::int64_t>;
constexpr double added = 0.5;  // to each count (Jeffreys)

std::int64_t total_of(const Row& row) {
  return std::accumulate(row.begin(), row.end(), std::int64_t{0});
}

double log_multinomial(const Row& counts) {
  double sum = std::lgamma(static_cast<double>(total_of(counts)) + 1.0);
  for (const std::int64_t count : counts) {
    sum -= std::lgamma(static_cast<double>(count) + 1.0);
  }
  return sum;
}

double log_probability(const analysis::CountTable& counts, const Rows& rows,
                       const Probabilities& probabilities) {
  double sum = log_likelihood(counts, rows, probabilities);
  for (const std::size_t i : rows) {
    sum += log_multinomial(counts[i]);
  }
  return sum;
}

Row drawn(std::int64_t answers, const std::vector<double>& probabilities, core::Rng& rng) {
  Row row(probabilities.size(), 0);
  for (std::int64_t answer = 0; answer < answers; ++answer) {
    double left = rng.uniform();
    std::size_t j = 0;
    while (j + 1 < row.size() && left >= probabilities[j]) {
      left -= probabilities[j++];
    }
    ++row[j];
  }
  return row;
}
// Dirichlet: gamma variates over their sum.
std::vector<double> drawn_shares(const Row& answers, core::Rng& rng) {
  std::vector<double> shares;
  for (const std::int64_t count : answers) {
    const double uniform = std::max(rng.uniform(), std::numeric_limits<double>::min());
    shares.push_back(analysis::gamma_quantile(uniform, static_cast<double>(count) + added));
  }
  const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) {
    share /= all;
  }
  return shares;
}

// The share of tables, with rows drawn from these shares, that are at most as probable as the
// counts.
template <class SharesOf>
double share_as_rare(const analysis::CountTable& counts, const Rows& rows,
                     const Probabilities& probabilities, std::uint64_t seed, SharesOf shares_of) {
  constexpr int draws = 4000;
  constexpr double rounding = 1e-9;
  core::Rng rng{core::derived_seed(seed, core::Purpose::resampling)};
  const double observed = log_probability(counts, rows, probabilities);
  analysis::CountTable table = counts;
  int as_rare = 0;
  for (int draw = 0; draw < draws; ++draw) {
    for (const std::size_t i : rows) {
      table[i] = drawn(total_of(counts[i]), shares_of(i, rng), rng);
    }
    as_rare += log_probability(table, rows, probabilities) <= observed + rounding ? 1 : 0;
  }
  return (as_rare + 1.0) / (draws + 1.0);
}
}  // namespace

Probabilities probabilities_of(const analysis::CountTable& answers) {
  Probabilities probabilities;
  for (const Row& row : answers) {
    const double all = static_cast<double>(total_of(row)) + added * static_cast<double>(row.size());
    std::vector<double> shares;
    for (const std::int64_t count : row) {
      shares.push_back((static_cast<double>(count) + added) / all);
    }
    probabilities.push_back(shares);
  }
  return probabilities;
}

double log_likelihood(const analysis::CountTable& counts, const Rows& rows,
                      const Probabilities& probabilities) {
  double sum = 0.0;
  for (const std::size_t i : rows) {
    for (std::size_t j = 0; j < counts[i].size(); ++j) {
      sum += static_cast<double>(counts[i][j]) * std::log(probabilities[i][j]);
    }
  }
  return sum;
}

double multinomial_p(const analysis::CountTable& counts, const Rows& rows,
                     const Probabilities& probabilities, std::uint64_t seed) {
  return share_as_rare(counts, rows, probabilities, seed,
                       [&](std::size_t row, core::Rng& /*rng*/) { return probabilities[row]; });
}

double predictive_p(const analysis::CountTable& counts, const Rows& rows,
                    const analysis::CountTable& answers, std::uint64_t seed) {
  return share_as_rare(
      counts, rows, probabilities_of(answers), seed,
      [&](std::size_t row, core::Rng& rng) { return drawn_shares(answers[row], rng); });
}

namespace {
using analysis::ConfusionMatrix;
const char* const table_file = "protocols/paper/table2.csv";
constexpr double significance = 0.05;
constexpr double well = 0.75;  // halfway between guessing, one half, and always right

ConfusionMatrix printed_table() {
  std::istringstream stream{shipped_text(table_file)};
  return analysis::read_counts(analysis::read_csv(stream, table_file), table_file);
}

// The answers of simulated participants to each stimulus at this internal noise.
struct Predicted {
  double noise_db{};
  ConfusionMatrix answers;
  Probabilities probabilities() const { return probabilities_of(answers.counts); }
};

struct Simulated {
  std::string method;
  std::string file;
  protocols::Protocol protocol;
  int participants{};
  std::vector<Predicted> by_noise;
};

Predicted predicted(const Bench& bench, const Simulated& study, double noise_db) {
  protocols::Protocol protocol = study.protocol;
  protocol.simulation.observer.noise_db = noise_db;
  const core::ScratchDirectory directory;
  simulate({study.file, directory.path(), study.participants, bench.seed, false,
            fmt::format("{}, noise of {} dB: simulating {} participants", study.method, noise_db,
                        study.participants)},
           protocol);
  const ConfusionMatrix printed = printed_table();
  Predicted result{noise_db, ConfusionMatrix{printed.stimuli, printed.responses}};
  results::Store store = results::Store::open_existing(directory.path());
  for (const results::AnswerRow& answer : results::stored_answers(store)) {
    const bool is_counted = !answer.is_practice && !answer.is_catch &&
                            answer.block == protocol.hypotheses.front().block;
    if (is_counted) {
      result.answers.add(answer.stimulus, answer.response);
    }
  }
  return result;
}

Simulated simulated(const Bench& bench, const std::string& method, const std::string& file,
                    const protocols::Protocol& protocol, int participants) {
  Simulated study{method, file, protocol, participants, {}};
  const std::vector<double> grid = bench.is_quick()
                                       ? std::vector{9.0, 14.0, 20.0}
                                       : std::vector{6.0, 9.0, 11.0, 12.5, 14.0, 16.0, 20.0, 26.0};
  for (const double noise_db : grid) {
    core::tell(bench.progress, fmt::format("{}, noise of {} dB", method, noise_db));
    study.by_noise.push_back(predicted(bench, study, noise_db));
  }
  return study;
}

const Predicted& best(const ConfusionMatrix& table, const Rows& rows, const Simulated& study) {
  return *std::ranges::max_element(study.by_noise, {}, [&](const Predicted& one) {
    return log_likelihood(table.counts, rows, one.probabilities());
  });
}

// Each half holds both materials and both structures.
const std::vector<Rows> halves{{0, 3}, {1, 2}};
const Rows all_rows{0, 1, 2, 3};

std::string command(const Simulated& study, const Bench& bench) {
  return fmt::format("tapstudy simulate {} --participants {} --seed {} --no-traces --out DIR",
                     study.file, study.participants, bench.seed);
}

Method cross_validated(const Bench& bench, const ConfusionMatrix& table, const Simulated& study) {
  Method method{study.method, command(study, bench), {}};
  std::vector<double> p;
  for (std::size_t half = 0; half < halves.size(); ++half) {
    p.push_back(predictive_p(table.counts, halves[1 - half],
                             best(table, halves[half], study).answers.counts, bench.seed));
  }
  const std::vector<double> adjusted = analysis::holm_adjusted(p);
  for (std::size_t half = 0; half < halves.size(); ++half) {
    const Rows& judged = halves[1 - half];
    const Predicted& fitted = best(table, halves[half], study);
    method.measures.push_back(
        shown(fmt::format("noise fitted on {} and {}", table.stimuli[halves[half][0]].name,
                          table.stimuli[halves[half][1]].name),
              fitted.noise_db, "dB"));
    method.measures.push_back(
        at_least(significance,
                 fmt::format("p of the rows {} and {} then, after Holm",
                             table.stimuli[judged[0]].name, table.stimuli[judged[1]].name),
                 adjusted[half]));
  }
  return method;
}

std::string describe_commands(const std::vector<Simulated>& studies) {
  return fmt::format(
      "The command simulates the protocol's own noise, {} dB; another is a line of the protocol, "
      "simulation.observer.noise_db. 5 mm thick: as recommended, with {}.",
      studies.front().protocol.simulation.observer.noise_db, thin_plate_changes);
}

Claim table_of_observer(const Bench& bench, const ConfusionMatrix& table,
                        const std::vector<Simulated>& studies) {
  Claim claim{
      .name = "table_2_from_vibration",
      .section = "section 5.2.1, Table 2",
      .statement = "Table 2 is what people answer who feel nothing but the rendered vibration.",
      .rule =
          "The observer's internal noise, its one free parameter, is fitted on two rows of "
          "Table 2 by maximum likelihood, and the other two are judged: of tables drawn from its "
          "answers, with probabilities as uncertain as so many answers leave them, at least 5 % "
          "are as rare as the printed ones. Then the other way round (Holm 1979)."};
  for (const Simulated& study : studies) {
    claim.methods.push_back(cross_validated(bench, table, study));
  }
  claim.remarks.push_back(describe_commands(studies));
  return claim;
}

double share(const ConfusionMatrix& table, const char* factor) {
  return analysis::factor_accuracy(table, factor).value();
}

// The printed shares with the interval in which the material's must lie.
Claim structure_well_material_less(const Bench& bench, const ConfusionMatrix& table,
                                   const std::vector<Simulated>& studies) {
  const analysis::Interval interval =
      analysis::wilson_interval(analysis::factor_accuracy(table, "material"));
  Claim claim{.name = "structure_well_material_two_thirds",
              .section = "section 5.2.1",
              .statement =
                  "Structure is told apart well, of material only two thirds of the answers "
                  "are right.",
              .rule =
                  "Well is 75 %, halfway between guessing and always right. Table 2 itself is only "
                  "shown. The simulated observer's share of material, with the noise fitted on all "
                  "of Table 2, lies in the 95 % interval of that table's."};
  claim.methods.push_back(
      {"Table 2 itself",
       fmt::format("tapstudy report --counts {}", table_file),
       {shown("structure right", 100.0 * share(table, "structure"), "%"),
        shown("material right", 100.0 * share(table, "material"), "%"),
        shown("lower end of material's interval", 100.0 * interval.low, "%"),
        shown("upper end of material's interval", 100.0 * interval.high, "%")}});
  for (const Simulated& study : studies) {
    const Predicted& fitted = best(table, all_rows, study);
    const double material = 100.0 * share(fitted.answers, "material");
    claim.methods.push_back(
        {"simulated, " + study.method,
         command(study, bench),
         {shown("noise fitted on all rows", fitted.noise_db, "dB"),
          at_least(100.0 * well, "structure right", 100.0 * share(fitted.answers, "structure"),
                   "%"),
          within(100.0 * interval.low, 100.0 * interval.high, "material right", material, "%")}});
  }
  claim.remarks.push_back(describe_commands(studies));
  return claim;
}

Claim better_than_guessing(const ConfusionMatrix& table) {
  Claim claim{.name = "better_than_guessing",
              .section = "sections 5.2.1 and 6",
              .statement = "Users can discriminate between structures and between materials.",
              .rule =
                  "Each is right more often than by guessing, one half: the exact binomial test, "
                  "one-sided, p below .05. The paper gives no test."};
  Method method{"Table 2 itself", fmt::format("tapstudy report --counts {}", table_file), {}};
  for (const char* const factor : {"structure", "material"}) {
    method.measures.push_back(
        at_most(significance, fmt::format("p of {}", factor),
                analysis::binomial_p_at_least(analysis::factor_accuracy(table, factor),
                                              analysis::factor_chance(table, factor, ""))));
  }
  claim.methods.push_back(std::move(method));
  claim.remarks.emplace_back(
      "The test takes 80 answers of ten people for independent, because Table 2 does not say whose "
      "they are: with people who differ, p is larger.");
  return claim;
}
}  // namespace

std::vector<Claim> discrimination(Bench& bench) {
  const ConfusionMatrix table = printed_table();
  const int participants = bench.is_quick() ? 20 : 100;
  const std::string printed = "protocols/paper/discrimination.yaml";
  const std::string recommended = "protocols/recommended/discrimination.yaml";
  const protocols::Protocol screwed = shipped_protocol(recommended);
  const std::vector<Simulated> studies{
      simulated(bench, std::string{method::printed}, printed, shipped_protocol(printed),
                participants),
      simulated(bench, std::string{method::recommended}, recommended, screwed, participants / 2),
      simulated(bench, "5 mm thick", recommended, with_thin_plates(screwed), participants / 2)};
  return {structure_well_material_less(bench, table, studies),
          table_of_observer(bench, table, studies), better_than_guessing(table)};
}
}  // namespace tapstudy::runner
