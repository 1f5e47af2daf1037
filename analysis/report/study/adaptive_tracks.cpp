#include "analysis/report/study/adaptive_tracks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "analysis/statistics/population/means.hpp"
namespace tapstudy::analysis {
namespace {
// Of staircases.
Cell count_of(const TrackResult& track, std::size_t number, const Column& column) {
  return track.settles_at ? count(static_cast<std::int64_t>(number)) : nothing(column);
}

ReportTable tracks_table(const std::vector<TrackResult>& tracks) {
  ReportTable table{
      "procedure_tracks",
      "Procedures and their estimates",
      {column("participant", "participant"), column("block", "block"), column("track", "track"),
       column("procedure", "procedure"), column("trials", "trials"), column("", "is_finished"),
       column("estimate", "estimate"), column("settles at", "settles_at"),
       column("reversals", "reversals"), column("trials at its limit", "trials_at_limit")}};
  for (const TrackResult& track : tracks) {
    table.rows.push_back({word(track.participant_id), word(track.block), count(track.track),
                          word(track.procedure), count(static_cast<std::int64_t>(track.trials)),
                          flag(track.is_finished),
                          track.estimate ? number(*track.estimate) : nothing(table.columns[6]),
                          track.settles_at ? share(*track.settles_at) : nothing(table.columns[7]),
                          count_of(track, track.reversals, table.columns[8]),
                          count_of(track, track.trials_at_limit, table.columns[9])});
  }
  return table;
}

// The estimates of a procedure in a block, logarithms where levels are above 0.
struct Estimates {
  bool is_signed{};
  std::map<std::string, std::vector<double>> of_participants;
};
using EstimatesOfProcedures = std::map<std::pair<std::string, std::string>, Estimates>;

// No logarithm of a level of 0, where a staircase may rest.
EstimatesOfProcedures estimates_of(const std::vector<TrackResult>& tracks) {
  EstimatesOfProcedures all;
  for (const TrackResult& track : tracks) {
    if (track.estimate && (track.is_signed || *track.estimate > 0.0)) {
      Estimates& estimates = all[{track.block, track.procedure}];
      estimates.is_signed = track.is_signed;
      estimates.of_participants[track.participant_id].push_back(
          track.is_signed ? *track.estimate : std::log10(*track.estimate));
    }
  }
  return all;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Cell group_mean(const Estimates& estimates) {
  std::vector<double> means;
  for (const auto& [participant, values] : estimates.of_participants) {
    means.push_back(mean_of(values));
  }
  const auto back = [&](double mean) { return estimates.is_signed ? mean : std::pow(10.0, mean); };
  if (means.size() < 2) {
    return interval(back(mean_of(means)), std::nullopt);
  }
  const Interval range = t_interval(means);
  return interval(back(mean_of(means)), Interval{back(range.low), back(range.high)});
}

ReportTable means_table(const std::vector<TrackResult>& tracks) {
  ReportTable table{
      "procedure_means",
      "Estimates of the procedures over participants",
      {column("block", "block"), column("procedure", "procedure"),
       column("participants", "participants"), interval_column("mean (95 % CI)", "estimate"),
       column("mean is", "kind_of_mean")}};
  for (const auto& [of, estimates] : estimates_of(tracks)) {
    table.rows.push_back({word(of.first), word(of.second),
                          count(std::ssize(estimates.of_participants)), group_mean(estimates),
                          word(estimates.is_signed ? "arithmetic" : "geometric")});
  }
  return table;
}

ReportTable posteriors_table(const std::vector<TrackResult>& tracks) {
  ReportTable table{"procedure_posteriors",
                    "Posterior of each parameter of the procedures",
                    {column("participant", "participant"),
                     column("block", "block"),
                     column("track", "track"),
                     column("parameter", "parameter"),
                     {"mean (95 %)", {"mean", "low", "high"}},
                     column("standard deviation", "standard_deviation")}};
  for (const TrackResult& track : tracks) {
    for (const ParameterEstimate& parameter : track.parameters) {
      table.rows.push_back({word(track.participant_id), word(track.block), count(track.track),
                            word(parameter.name), interval(parameter.mean, parameter.range),
                            number(parameter.standard_deviation)});
    }
  }
  return table;
}
// "slope in 'jnd' of 2 of 5 tracks"
std::vector<std::string> described_ends(const std::vector<TrackResult>& tracks) {
  struct Ends {
    std::size_t at_end{};
    std::size_t all{};
  };
  std::map<std::pair<std::string, std::string>, Ends> ends;  // by block and parameter
  for (const TrackResult& track : tracks) {
    for (const ParameterEstimate& parameter : track.parameters) {
      Ends& of = ends[{track.block, parameter.name}];
      of.at_end += parameter.is_at_end ? 1 : 0;
      ++of.all;
    }
  }
  std::vector<std::string> described;
  for (const auto& [of, counts] : ends) {
    if (counts.at_end > 0) {
      described.push_back(fmt::format("{} in '{}' of {} of {} tracks", of.second, of.first,
                                      counts.at_end, counts.all));
    }
  }
  return described;
}
}  // namespace

ReportSection procedures_section(const std::vector<TrackResult>& tracks) {
  ReportSection section{"What the procedures estimated",
                        {means_table(tracks), tracks_table(tracks), posteriors_table(tracks)}};
  section.name = study_sections::procedures;
  if (!tracks.empty()) {
    section.remarks = {
        "As the procedures chose the levels, computed again from the answers as first given. A "
        "staircase's estimate is the mean of its last reversals, that of QUEST+ and the psi method "
        "the posterior mean of the threshold; with further axes the threshold is that at their "
        "origin. Means count each participant once, and their intervals are by t. The results "
        "above "
        "fit all answers of a participant anew."};
  }
  if (const auto ends = described_ends(tracks); !ends.empty()) {
    section.remarks.emplace_back(
        fmt::format("The most probable value lies at an end of the procedure's grid, beyond which "
                    "it knew none, so that the estimate is one of the grid: {}.",
                    fmt::join(ends, "; ")));
  }
  return section;
}
}  // namespace tapstudy::analysis
