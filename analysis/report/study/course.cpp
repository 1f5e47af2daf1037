#include "analysis/report/study/course.hpp"

#include <fmt/format.h>

#include <algorithm>
namespace tapstudy::analysis {
namespace {
using results::ParticipantCourseRow;
using Courses = std::vector<ParticipantCourseRow>;

// So many of so many, without an interval: participants are not drawn from their own trials.
Cell part(std::int64_t some, std::int64_t all) {
  return all == 0 ? Cell{"–", {some, all}} : Cell{fmt::format("{}/{}", some, all), {some, all}};
}

Column part_column(const std::string& heading, const std::string& key) {
  return {heading, {key, key + "_of"}};
}

// Shown in milliseconds, stored in seconds.
Cell milliseconds(double seconds) {
  return {rounded(1e3 * seconds), {seconds}};
}

ReportTable course_table(const Courses& participants) {
  ReportTable table{
      "course",
      "Sessions and presentations of trials, practice aside",
      {column("participant", "participant"), column("", "mode"), column("sessions", "sessions"),
       column("answered", "answered"), column("interrupted", "interrupted"),
       column("repeated", "repeated"), column("skipped", "skipped"),
       column("timed out", "timed_out"), column("given up", "given_up"),
       column("corrected", "corrected"), column("", "is_excluded")}};
  for (const ParticipantCourseRow& row : participants) {
    table.rows.push_back({word(row.participant_id), word(results::to_text(row.mode)),
                          count(row.sessions), count(row.answered), count(row.interrupted),
                          count(row.repeated), count(row.skipped), count(row.timed_out),
                          count(row.given_up), count(row.corrected),
                          flag(row.exclusion_reason.has_value())});
  }
  return table;
}

ReportTable exclusions_table(const Courses& participants) {
  ReportTable table{"exclusions",
                    "Excluded by the operator: not in the results",
                    {column("participant", "participant"), column("reason", "reason")}};
  for (const ParticipantCourseRow& row : participants) {
    if (row.exclusion_reason) {
      table.rows.push_back({word(row.participant_id), word(*row.exclusion_reason)});
    }
  }
  return table;
}

ReportTable attention_table(const Courses& participants) {
  ReportTable table{"attention",
                    "Catch trials that were right, and items of questionnaires that were answered",
                    {column("participant", "participant"), part_column("catch trials", "catch"),
                     part_column("items of questionnaires", "form_items")}};
  for (const ParticipantCourseRow& row : participants) {
    if (row.catch_trials > 0 || row.form_items > 0) {
      table.rows.push_back({word(row.participant_id), part(row.catch_right, row.catch_trials),
                            part(row.form_items - row.form_items_left_out, row.form_items)});
    }
  }
  return table;
}

ReportTable practice_table(const std::vector<PracticeResult>& practice) {
  ReportTable table{"practice",
                    "Practice, answers as first given",
                    {column("participant", "participant"), column("block", "block"),
                     part_column("right", "right"), column("share", "share"),
                     column("criterion", "is_criterion_met")}};
  for (const PracticeResult& row : practice) {
    const bool is_scored = row.right.trials > 0;
    table.rows.push_back(
        {word(row.participant_id), word(row.block), part(row.right.successes, row.right.trials),
         is_scored ? share(row.right.value()) : nothing(table.columns[3]),
         row.is_criterion_met
             ? Cell{*row.is_criterion_met ? "met" : "not met", {*row.is_criterion_met}}
             : Cell{"no criterion", {Value{}}}});
  }
  return table;
}

bool is_in_real_time(const ParticipantCourseRow& row) {
  return row.mode != results::Mode::simulated;  // in virtual time no tick is late
}

ReportTable loop_table(const Courses& participants) {
  ReportTable table{
      "loop_quality",
      "The haptic loop in all stored trials",
      {column("participant", "participant"), column("ticks", "ticks"), column("late", "late"),
       column("skipped", "skipped"), column("saturated", "saturated"),
       column("lost samples", "dropped_samples"), column("99.9 %, ms", "lateness_p999_s"),
       column("worst, ms", "worst_lateness_s"), part_column("late impacts", "late_impacts")}};
  for (const ParticipantCourseRow& row : participants) {
    if (row.ticks > 0 && is_in_real_time(row)) {
      table.rows.push_back(
          {word(row.participant_id), count(row.ticks), count(row.late), count(row.skipped_ticks),
           count(row.saturated), count(row.dropped_samples), milliseconds(row.lateness_p999_s),
           milliseconds(row.worst_lateness_s), part(row.late_impacts, row.impacts)});
    }
  }
  return table;
}

// Of ticks in virtual time; nothing if no force was cut off.
ReportTable saturation_table(const Courses& participants) {
  ReportTable table{"saturation",
                    "Ticks whose force was cut off at the device's limit",
                    {column("participant", "participant"), part_column("saturated", "saturated")}};
  for (const ParticipantCourseRow& row : participants) {
    if (row.saturated > 0 && !is_in_real_time(row)) {
      table.rows.push_back({word(row.participant_id), part(row.saturated, row.ticks)});
    }
  }
  return table;
}

Cell masking_level(const ParticipantCourseRow& row, const Column& column) {
  if (!row.masking_low_db || !row.masking_high_db) {
    return nothing(column);
  }
  const std::string low = rounded(*row.masking_low_db);
  const std::string high = rounded(*row.masking_high_db);
  return {low == high ? low : fmt::format("{} to {}", low, high),
          {*row.masking_low_db, *row.masking_high_db}};
}

ReportTable masking_table(const Courses& participants) {
  ReportTable table{"masking",
                    "Masking noise",
                    {column("participant", "participant"),
                     part_column("trials", "trials"),
                     {"RMS, dB FS", {"low_db", "high_db"}},
                     column("gaps", "gaps"),
                     column("samples beyond full scale", "cut_samples"),
                     column("trials where the card stopped", "lost")}};
  for (const ParticipantCourseRow& row : participants) {
    if (row.stored_trials > 0 && is_in_real_time(row)) {
      table.rows.push_back({word(row.participant_id), part(row.masked_trials, row.stored_trials),
                            masking_level(row, table.columns[2]), count(row.masking_gaps),
                            count(row.masking_cut_samples), count(row.masking_lost)});
    }
  }
  return table;
}
}  // namespace

ReportSection course_section(const Courses& participants,
                             const std::vector<PracticeResult>& practice, bool has_masking) {
  ReportSection section{"How the sessions went"};
  section.name = study_sections::sessions;
  section.is_detail = true;
  section.tables = {course_table(participants),    exclusions_table(participants),
                    attention_table(participants), practice_table(practice),
                    loop_table(participants),      saturation_table(participants)};
  if (has_masking) {
    section.tables.push_back(masking_table(participants));
  }
  section.remarks.emplace_back(
      "Given up: trials that were skipped or timed out and not answered later.");
  if (section.tables[4].rows.empty()) {
    section.remarks.emplace_back("In virtual time no tick is late.");
  } else {
    section.remarks.emplace_back(
        "Lateness of a tick: 99.9 % of the ticks of a participant's worst trial were no later (to "
        "2 %, in older sessions to 19 %), and the latest of all. Late impacts: "
        "those up to 5 ms after a late tick.");
  }
  return section;
}
}  // namespace tapstudy::analysis
