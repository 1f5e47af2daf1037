#pragma once
#include "protocols/procedures/procedure.hpp"
namespace tapstudy::protocols {
// An up-down staircase. Correct answers in a row make the next stimulus harder, incorrect ones in a
// row easier; each change ends the row.
//
// Transformed (Levitt 1971): n_down correct, or n_up incorrect, in a row; equal steps. It settles
//   where either change is as likely as the other: at n_up = 1, psi = 0.5^(1/n_down).
// Weighted (Kaernbach 1991): one answer each; the step towards easier is target / (1 - target)
//   times the one towards harder. It settles at psi = target.
//
// Steps are added to the value (linear), or are decibels of it: value = start 10^(dB/20). Each
// reversal halves the step until min_step. A step stops at min and max; that counts as a step in
// its direction. The value of a reversal is that of the trial whose answer turned the staircase.
struct StaircaseSettings {
  double start{};
  double min{};
  double max{};
  bool is_in_db{false};
  bool is_harder_below{true};  // correct answers decrease the value
  double first_step{};         // towards harder; in the unit of the value, or in dB
  double min_step{};
  double easier_per_harder{1.0};  // ratio of steps
  int n_down{1};
  int n_up{1};
  std::size_t max_trials{};
  std::optional<std::size_t> max_reversals;
  // Of the estimate: the last so many reversals, even, so that peaks and valleys are as many
  // (Wetherill & Levitt 1965). Averaged in the unit of steps: in dB a geometric mean.
  std::size_t estimate_reversals{};
};

// Where it settles: the proportion correct at which steps in both directions balance.
double staircase_target(const StaircaseSettings& settings);

// Values are `start` moved by an offset in the unit of the steps.
double offset_of(const StaircaseSettings& settings, double value);
double value_at(const StaircaseSettings& settings, double offset);

std::unique_ptr<Track> start_staircase(const StaircaseSettings& settings);
}  // namespace tapstudy::protocols
