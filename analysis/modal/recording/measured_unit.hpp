#pragma once
#include <optional>
#include <string>

#include "analysis/modal/recording/recording.hpp"
namespace tapstudy::analysis {
// The unit of a channel's values, as its header or the file states it.
struct MeasuredUnit {
  std::string text;                  // "g", "mm/s", "V"
  std::optional<Quantity> quantity;  // unset: of a sensor whose sensitivity it is to be told
  double si{};                       // m/s², m/s or m in one; 0 where there is no quantity
};

// Of a header as "Acc (g)", "velocity [mm/s]", "x_um" or "acc_m_s2"; unset: it states none.
std::optional<MeasuredUnit> unit_in(const std::string& header);

// What stands in the way of taking a channel's values for SI units of the quantity, as a sentence
// about --scale and --quantity; empty: nothing. Values without a stated unit are taken for SI, but
// those of sound, whose unit is full scale.
std::string why_not_si(const Recording& recording, Quantity quantity);
}  // namespace tapstudy::analysis
