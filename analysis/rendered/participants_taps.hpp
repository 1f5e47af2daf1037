#pragma once
#include <map>
#include <string>
#include <vector>

#include "analysis/tables/cells.hpp"
namespace tapstudy::analysis {
// All taps of one participant that count.
struct TapsOfParticipant {
  std::vector<double> speeds_m_s;
  std::vector<double> peaks_n;  // of the commanded force
  double contact_s{};           // of all together
};

// How participants tapped, each by the medians of their taps, and the means of these over
// participants with a 95 % interval by t: how strong somebody taps is a property of the person.
ReportTable participants_taps_table(const std::map<std::string, TapsOfParticipant>& participants);
}  // namespace tapstudy::analysis
