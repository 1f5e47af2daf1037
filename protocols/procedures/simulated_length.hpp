#pragma once
#include <cstddef>

#include "protocols/procedures/procedure.hpp"
namespace tapstudy::protocols {
// How many trials a procedure takes.
struct TrackLength {
  std::size_t usual{};  // median over people
  std::size_t most{};   // 19 of 20 people need no more
};

// Of a procedure that may end early, with simulated people: each has a threshold anywhere between
// the limits of the first axis, on a logarithmic scale where these are above 0, and a cumulative
// Gaussian whose standard deviation is an eighth of the distance between them, with 2 % lapses.
// The same for every call. Of any other procedure: all its trials.
// guess_rate: the proportion of right answers without any perception, from 0 to below 0.98.
TrackLength simulated_length(const TrackSettings& track, double guess_rate);
}  // namespace tapstudy::protocols
