#pragma once
#include <cstddef>
#include <vector>
namespace tapstudy::analysis {
// What the samples before do not foretell: the errors of a linear prediction that is fitted to the
// whole recording (autoregressive, Yule 1927), as mean squares of frames of so many samples. What
// rings freely is foretold, beats and slow modes too; an impact is not. Samples of more than about
// 4 kHz are averaged before, so that the prediction looks back over several milliseconds.
std::vector<double> innovation_energies(const std::vector<double>& samples, double rate_hz,
                                        std::size_t frame);
}  // namespace tapstudy::analysis
