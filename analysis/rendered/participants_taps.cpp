#include "analysis/rendered/participants_taps.hpp"

#include <optional>

#include "analysis/participants/mean_proportion.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double half = 0.5;

Cell mean_of(const std::vector<double>& values) {
  return interval(mean_and_spread(values).mean, t_interval(values));
}
}  // namespace

ReportTable participants_taps_table(const std::map<std::string, TapsOfParticipant>& participants) {
  ReportTable table{"rendered_participants",
                    "Taps of the participants: medians; means over participants (95 % CI, t)",
                    {column("participant", "participant_id"), column("taps", "taps"),
                     interval_column("speed at impact, m/s", "speed_m_s"),
                     interval_column("peak of the commanded force, N", "peak_n"),
                     interval_column("contact of a tap, s", "contact_s")}};
  std::vector<double> speeds_m_s;
  std::vector<double> peaks_n;
  std::vector<double> contacts_s;
  std::int64_t all = 0;
  const std::optional<Interval> none;
  for (const auto& [name, taps] : participants) {
    const std::size_t tapped = taps.peaks_n.size();
    all += static_cast<std::int64_t>(tapped);
    speeds_m_s.push_back(quantile(taps.speeds_m_s, half));
    peaks_n.push_back(quantile(taps.peaks_n, half));
    contacts_s.push_back(taps.contact_s / static_cast<double>(tapped));
    table.rows.push_back({word(name), count(static_cast<std::int64_t>(tapped)),
                          interval(speeds_m_s.back(), none), interval(peaks_n.back(), none),
                          interval(contacts_s.back(), none)});
  }
  if (participants.size() > 1) {
    table.rows.push_back(
        {word("mean"), count(all), mean_of(speeds_m_s), mean_of(peaks_n), mean_of(contacts_s)});
  }
  return table;
}
}  // namespace tapstudy::analysis
