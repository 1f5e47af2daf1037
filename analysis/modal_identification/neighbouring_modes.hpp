#pragma once
#include <vector>

#include "analysis/modal_identification/repeated_modes.hpp"
namespace tapstudy::analysis {
// Modes whose intervals, frequency plus and minus half-power bandwidth, overlap; a mode alone is a
// group of its own.
struct Neighbours {
  Band range;
  std::size_t agreed{};
  double least_ratio{};
  double greatest_ratio{};

  // Inside the range, damped at most five times less or more than these.
  bool may_hold(const Pole& pole) const;
};

// All modes but lines, in ascending frequency as they are given.
std::vector<Neighbours> neighbours_among(const std::vector<RepeatedMode>& modes);

// Two poles or more, and no fewer than are agreed, as most orders show them (at least as many as
// make a pole stable); empty: none.
std::vector<Pole> poles_by_all(const MatrixPencil& pencil, const Neighbours& neighbours);

// A mode whose frequency depends on its amplitude is, to first order, one pole and another of the
// same frequency and three times its decay (a cubic stiffness, Nayfeh & Mook 1979).
bool may_be_one_nonlinear_mode(const std::vector<Pole>& poles);
}  // namespace tapstudy::analysis
