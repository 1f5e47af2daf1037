#pragma once
#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "analysis/modal/response/frequency_responses.hpp"
#include "core/random/rng.hpp"
// Frequency responses in closed form of a structure with known modes, in noise.
namespace tapstudy::testing {
struct PlantedStructure {
  std::vector<analysis::Pole> poles;
  int places{6};
  int references{1};     // the first of the places
  double per_mass{0.5};  // 1 / kg of its rigid motion

  static double displacement(std::size_t mode, int place) {
    const auto number = static_cast<double>(mode + 1);
    return std::cos(0.9 * number * (place + 0.3) + 0.2 * number);
  }
  // R of R / (s - p) + R* / (s - p*) in a receptance.
  std::complex<double> residue(std::size_t mode, int place, int reference) const {
    const double ratio = poles[mode].damping_ratio;
    const double damped_rad_per_s =
        2.0 * std::numbers::pi * poles[mode].frequency_hz * std::sqrt(1.0 - ratio * ratio);
    return displacement(mode, place) * displacement(mode, reference) /
           std::complex<double>{0.0, 2.0 * damped_rad_per_s};
  }
  std::complex<double> receptance(double frequency_hz, int place, int reference) const {
    const std::complex<double> s{0.0, 2.0 * std::numbers::pi * frequency_hz};
    std::complex<double> sum = per_mass / (s * s);
    for (std::size_t mode = 0; mode < poles.size(); ++mode) {
      const std::complex<double> p = log_of(poles[mode], 1.0);
      const std::complex<double> r = residue(mode, place, reference);
      sum += r / (s - p) + std::conj(r) / (s - std::conj(p));
    }
    return sum;
  }
};

inline std::string place_name(int place) {
  return fmt::format("{}+Z", place + 1);
}

// White noise at this ratio (power of each response over that of its noise) in dB; 0: none.
inline analysis::FrequencyResponses planted_responses(const PlantedStructure& structure,
                                                      analysis::ResponseKind kind,
                                                      const analysis::Band& band,
                                                      Eigen::Index lines, double noise_db = 0.0,
                                                      std::uint64_t seed = 1) {
  core::Rng rng{seed};
  analysis::FrequencyResponses all;
  all.kind = kind;
  all.frequency_hz = Eigen::ArrayXd::LinSpaced(lines, band.low_hz, band.high_hz);
  all.values.resize(lines, structure.places * structure.references);
  for (int reference = 0; reference < structure.references; ++reference) {
    for (int place = 0; place < structure.places; ++place) {
      auto column = all.values.col(std::ssize(all.pairs));
      all.pairs.push_back({place_name(place), place_name(reference)});
      for (Eigen::Index line = 0; line < lines; ++line) {
        const std::complex<double> s{0.0, 2.0 * std::numbers::pi * all.frequency_hz[line]};
        column[line] = structure.receptance(all.frequency_hz[line], place, reference) *
                       std::pow(s, static_cast<int>(kind));
      }
      if (noise_db > 0.0) {
        const double deviation = column.norm() * std::pow(10.0, -0.05 * noise_db) /
                                 std::sqrt(2.0 * static_cast<double>(lines));
        for (std::complex<double>& value : column) {
          const double real = rng.normal();
          value += deviation * std::complex<double>{real, rng.normal()};
        }
      }
    }
  }
  return all;
}

// A data set 58 as the format's description lays it out, single precision, 5 decimals.
inline std::string universal_function(const analysis::FrequencyResponses& responses,
                                      Eigen::Index column, int function_type = 4) {
  const auto node = [](const std::string& place) { return place.substr(0, place.find('+')); };
  const analysis::ResponsePair& pair = responses.pairs[static_cast<std::size_t>(column)];
  const Eigen::ArrayXd& hz = responses.frequency_hz;
  const int numerator = std::vector{8, 11, 12}.at(static_cast<std::size_t>(responses.kind));
  std::string text = fmt::format(
      "    -1\n    58\nNONE\nNONE\n01-Jan-26 10:00:00\nNONE\nNONE\n"
      "{:>5}{:>10}{:>5}{:>10} {:<10}{:>10}{:>4} {:<10}{:>10}{:>4}\n"
      "{:>10}{:>10}{:>10}{:>13.5E}{:>13.5E}{:>13.5E}\n"
      "        18    0    0    0 Frequency            Hz\n"
      "{:>10}    0    0    0 Response             NONE\n"
      "        13    0    0    0 Excitation           N\n"
      "         0    0    0    0 NONE                 NONE\n",
      function_type, 0, 0, 0, "NONE", node(pair.response), 3, "NONE", node(pair.reference), 3, 5,
      hz.size(), 1, hz[0], hz[1] - hz[0], 0.0, numerator);
  for (Eigen::Index line = 0; line < hz.size(); ++line) {
    const std::complex<double> value = responses.values(line, column);
    text += fmt::format("{:>13.5E}{:>13.5E}", value.real(), value.imag());
    text += line % 3 == 2 || line == hz.size() - 1 ? "\n" : "";
  }
  return text + "    -1\n";
}

inline std::string universal_file(const analysis::FrequencyResponses& responses) {
  std::string text;
  for (Eigen::Index column = 0; column < responses.values.cols(); ++column) {
    text += universal_function(responses, column);
  }
  return text;
}
}  // namespace tapstudy::testing
