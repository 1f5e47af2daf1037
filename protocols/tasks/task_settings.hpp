#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocols/axes/axis_range.hpp"
#include "protocols/procedures/procedure.hpp"
namespace tapstudy::protocols {
// What the tasks of a block have of their own.

// Of the standard. Levels have a sign on `either` only.
enum class Side { above, below, either };
// A comparison that differs from its standard along an axis of their family, by a level that
// procedures choose: a fraction of the standard, or a difference in the axis's unit.
struct Comparison {
  std::string axis;
  // All alternatives of a trial have the same values on these, which a procedure of several axes
  // chooses as they are: the threshold along the axis above depends on them.
  std::vector<std::string> further_axes;
  double standard{};
  bool is_fraction{true};
  Side side{Side::above};
  bool is_standard_right{false};  // what is asked for is the standard
  // Of the function that is fitted to the answers.
  core::PsychometricShape shape{core::PsychometricShape::weibull};
  std::vector<std::shared_ptr<const TrackSettings>> tracks;  // interleaved; at least one
  double value_at(double level) const {
    const double difference = is_fraction ? level * standard : level;
    return side == Side::below ? standard - difference : standard + difference;
  }
  double level_of(double value) const {
    const double difference = side == Side::below ? standard - value : value - standard;
    return is_fraction ? difference / standard : difference;
  }
};

// On which a stimulus is rated: steps from 1 (Likert), or a mark on a line from 0, low, to 1, high
// (visual analogue).
enum class ScaleKind { likert, visual_analogue };
struct RatingScale {
  ScaleKind kind{ScaleKind::likert};
  int steps{7};  // likert
  std::string low;
  std::string high;
};

// Values of an axis at which every stimulus of a block is presented.
struct ValuesOnAxis {
  std::string axis;
  std::vector<double> values;  // from low to high, as presented
};

// A stimulus that is presented beside the one to be judged, with the number that it is said to
// have.
struct Modulus {
  std::string stimulus;
  double number{};
};

// One stimulus is moved along an axis of its family until it feels equal to a standard: the same
// stimulus at one value, or another stimulus.
struct Adjustment {
  std::string axis;
  std::vector<double> values;  // that it can be set to, from low to high, as presented
  Spacing spacing{Spacing::linear};
  std::optional<double> standard;  // on the axis
  std::string reference;           // the other stimulus, where there is no such value
  // Runs start below or above it: the standard, or the middle of the values as they are spaced.
  double middle() const {
    constexpr double half = 0.5;
    return standard.value_or(between(values.front(), values.back(), spacing, half));
  }
};
}  // namespace tapstudy::protocols
