#include "analysis/procedures/procedures_section.hpp"
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
}  // namespace

ReportSection procedures_section(const std::vector<TrackResult>& tracks) {
  ReportSection section{"What the procedures estimated",
                        {tracks_table(tracks), posteriors_table(tracks)}};
  section.name = "procedures";
  if (!tracks.empty()) {
    section.remarks = {
        "As the procedures chose the levels, computed again from the answers as first given. A "
        "staircase's estimate is the mean of its last reversals, that of QUEST+ and the psi method "
        "the posterior mean of the threshold; with further axes the threshold is that at their "
        "origin. The results above fit all answers of a participant anew."};
  }
  return section;
}
}  // namespace tapstudy::analysis
