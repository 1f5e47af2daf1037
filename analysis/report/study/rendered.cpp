#include "analysis/report/study/rendered.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/model/shells/shell_elements.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double half = 0.5;
}  // namespace

ReportTable participants_taps_table(const std::map<std::string, TapsOfParticipant>& participants) {
  ReportTable table{"rendered_participants",
                    "Taps of the participants: medians; means over participants (95 % CI)",
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
    table.rows.push_back({word("mean"), count(all), mean_of_positive(speeds_m_s),
                          mean_of_positive(peaks_n), mean_of_positive(contacts_s)});
  }
  return table;
}

namespace {
Cell named(const RenderedStimulus& stimulus) {
  return {stimulus.label, {stimulus.name}};
}

// Shown with quartiles.
Cell quartiles_cell(const Quartiles& of) {
  return interval(of.median, {of.low, of.high});
}

// Stored in metres.
Cell millimetres(const std::vector<double>& values_m) {
  const Quartiles of = quartiles(values_m);
  Cell cell = quartiles_cell(of);
  cell.text = with_interval(1e3 * of.median, {1e3 * of.low, 1e3 * of.high});
  return cell;
}

std::string first_modes(const RenderedModel& model) {
  constexpr std::size_t shown = 3;
  std::string text;
  const std::size_t modes = model.frequencies_hz.size();
  for (std::size_t i = 0; i < std::min(shown, modes); ++i) {
    text += fmt::format("{}{:.0f} ({} %)", i == 0 ? "" : ", ", model.frequencies_hz[i],
                        rounded(100.0 * model.damping_ratios[i], 2));
  }
  return modes > shown ? text + " …" : text;
}

ReportTable stimuli_table(const RenderedStudy& study) {
  ReportTable table{
      "rendered_stimuli",
      "The stimuli",
      {column("stimulus", "stimulus"), column("plate", "plate"), column("size", "size"),
       column("fixation", "fixation"), column("technique", "technique")}};
  for (const RenderedStimulus& stimulus : study.stimuli) {
    table.rows.push_back({named(stimulus), word(stimulus.plate), word(stimulus.size),
                          word(stimulus.fixation), word(stimulus.technique)});
  }
  return table;
}

// Shown in GPa; data has the first.
Cell moduli_cell(const std::vector<double>& moduli_pa) {
  std::vector<std::string> shown;
  for (const double modulus_pa : moduli_pa) {
    shown.push_back(rounded(1e-9 * modulus_pa));
  }
  return {fmt::format("{}", fmt::join(shown, ", ")), {moduli_pa.front()}};
}

ReportTable models_table(const RenderedStudy& study) {
  ReportTable table{
      "rendered_models",
      "Materials and finite element models: modes in the band, frequencies (damping ratios)",
      {column("stimulus", "stimulus"), column("material", "material"),
       column("E, GPa", "youngs_modulus_pa"), column("kg/m³", "density_kg_per_m3"),
       column("modes", "modes"), column("frequencies, Hz", "first_modes"),
       column("elements", "elements"), column("nodes", "nodes"), column("order", "order"),
       column("residual", "worst_residual"), column("error", "estimated_relative_error")}};
  for (const RenderedStimulus& stimulus : study.stimuli) {
    std::vector<Cell> row{named(stimulus), word(stimulus.material),
                          moduli_cell(stimulus.youngs_moduli_pa),
                          number(stimulus.density_kg_per_m3)};
    if (stimulus.model) {
      const RenderedModel& model = *stimulus.model;
      row.insert(row.end(), {count(static_cast<std::int64_t>(model.frequencies_hz.size())),
                             word(first_modes(model)), count(model.tets), count(model.nodes),
                             model.order == core::shell_order ? word("shell") : count(model.order),
                             number(model.worst_residual, 2), number(model.estimated_error)});
    } else {
      for (std::size_t i = row.size(); i < table.columns.size(); ++i) {
        row.push_back(nothing(table.columns[i]));
      }
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable modes_table(const RenderedStudy& study) {
  ReportTable table{"rendered_modes",
                    "Modes in the band",
                    {column("", "stimulus"), column("", "mode"), column("", "frequency_hz"),
                     column("", "damping_ratio")}};
  table.shown_in = programs_only;
  for (const RenderedStimulus& stimulus : study.stimuli) {
    const std::size_t modes = stimulus.model ? stimulus.model->frequencies_hz.size() : 0;
    for (std::size_t i = 0; i < modes; ++i) {
      table.rows.push_back({named(stimulus), count(static_cast<std::int64_t>(i + 1)),
                            number(stimulus.model->frequencies_hz[i]),
                            number(stimulus.model->damping_ratios[i])});
    }
  }
  return table;
}

ReportTable taps_table(const RenderedStudy& study) {
  ReportTable table{"rendered_taps",
                    "Taps: medians and quartiles over taps",
                    {column("stimulus", "stimulus"), column("taps", "taps"),
                     interval_column("speed at impact, m/s", "speed_m_s"),
                     interval_column("peak of the commanded force, N", "peak_n")}};
  for (std::size_t i = 0; i < study.stimuli.size(); ++i) {
    const TapStatistics& taps = study.taps[i].all;
    if (taps.taps() > 0) {
      table.rows.push_back({named(study.stimuli[i]), count(taps.taps()),
                            quartiles_cell(quartiles(taps.speeds_m_s())),
                            quartiles_cell(quartiles(taps.commanded().peaks_n))});
    }
  }
  return table;
}

ReportTable forces_table(const RenderedStudy& study) {
  ReportTable table{
      "rendered_forces",
      "Parts of the force in these taps, while in contact; peaks with quartiles",
      {column("stimulus", "stimulus"), column("force", "part"), column("RMS, N", "rms_n"),
       column("largest, N", "largest_peak_n"), interval_column("peak of a tap, N", "peak_n")}};
  for (std::size_t i = 0; i < study.stimuli.size(); ++i) {
    for (const ForceExtent& part : study.taps[i].all.extents()) {
      if (part.squares_n2 > 0.0) {
        table.rows.push_back({named(study.stimuli[i]), word(part.part), number(part.rms_n()),
                              number(part.peak_n()), quartiles_cell(quartiles(part.peaks_n))});
      }
    }
  }
  return table;
}

ReportTable points_table(const RenderedStudy& study) {
  ReportTable table{
      "rendered_points",
      "Where it was tapped: each tap counts to the tapping point nearest to it",
      {column("stimulus", "stimulus"), column("point", "point"), column("taps", "taps"),
       interval_column("distance from it, mm (quartiles)", "distance_m")}};
  for (std::size_t i = 0; i < study.stimuli.size(); ++i) {
    for (const PointTaps& at : study.taps[i].points) {
      if (at.taps.taps() > 0) {
        table.rows.push_back({named(study.stimuli[i]), word(at.point), count(at.taps.taps()),
                              millimetres(at.distances_m)});
      }
    }
  }
  return table;
}

ReportTable waveforms_table(const RenderedStudy& study) {
  ReportTable table{"rendered_waveforms",
                    "Force after the impact, over taps",
                    {column("", "stimulus"), column("", "point"), column("", "time_s"),
                     column("", "taps"), column("", "total_n"), column("", "total_sd_n"),
                     column("", "added_n"), column("", "added_sd_n")}};
  table.shown_in = programs_only;
  for (std::size_t i = 0; i < study.stimuli.size(); ++i) {
    for (const PointTaps& at : study.taps[i].points) {
      const TapStatistics& taps = at.taps;
      for (std::size_t k = 0; k < taps.ticks() && taps.taps_at(k) > 0; ++k) {
        table.rows.push_back({named(study.stimuli[i]), word(at.point),
                              number(static_cast<double>(k) / taps.window().rate_hz),
                              count(taps.taps_at(k)), number(taps.mean_total_n(k)),
                              number(taps.spread_total_n(k)), number(taps.mean_added_n(k)),
                              number(taps.spread_added_n(k))});
      }
    }
  }
  return table;
}

ReportTable spectra_table(const RenderedStudy& study) {
  ReportTable table{"rendered_spectra",
                    "Magnitude of what is added to the contact spring",
                    {column("", "stimulus"), column("", "point"), column("", "frequency_hz"),
                     column("", "added_n_per_hz")}};
  table.shown_in = programs_only;
  for (std::size_t i = 0; i < study.stimuli.size(); ++i) {
    for (const PointTaps& at : study.taps[i].points) {
      if (at.taps.taps() == 0 || !at.taps.has_added()) {
        continue;
      }
      const std::vector<double> spectrum = at.taps.spectrum_n_per_hz();
      for (std::size_t m = 0; m < spectrum.size(); ++m) {
        table.rows.push_back({named(study.stimuli[i]), word(at.point),
                              number(at.taps.frequency_hz(m)), number(spectrum[m])});
      }
    }
  }
  return table;
}

bool lacks_model(const RenderedStimulus& stimulus) {
  return stimulus.needs_model && !stimulus.model;
}

bool is_orthotropic(const RenderedStimulus& stimulus) {
  return stimulus.youngs_moduli_pa.size() > 1;
}

bool has_drawn_points(const StimulusTaps& stimulus) {
  return std::ranges::any_of(
      stimulus.points, [](const PointTaps& at) { return at.taps.taps() >= least_drawn_taps; });
}

void say_what_is_missing(const RenderedStudy& study, ReportSection& section) {
  if (study.traced_trials == 0) {
    section.remarks.emplace_back(
        "Forces, speeds and waveforms are left out: this study has no traces.");
  } else if (study.traced_trials < study.trials) {
    section.remarks.push_back(
        fmt::format("Traces are stored of {} of {} trials.", study.traced_trials, study.trials));
  }
  if (std::ranges::any_of(study.taps, has_drawn_points)) {
    section.remarks.emplace_back(
        "Figures of forces: mean over taps with the standard deviation, so far as half of them "
        "last; at the point where most is added to the contact spring, and for all other points "
        "behind \"More figures\". Axes are those of all stimuli at a point. Spectra are of the "
        "force that is added, over the whole tap.");
  }
  if (std::ranges::any_of(study.stimuli, lacks_model)) {
    section.remarks.emplace_back(
        "Where modes are left out, no model of this version of the program is cached on this "
        "machine: `tapstudy check` of the protocol makes one.");
  }
  for (const RenderedStimulus& stimulus : study.stimuli) {
    if (stimulus.model && !stimulus.model->relaxed_radius_edge_ratio.empty()) {
      section.remarks.push_back(
          fmt::format("The mesh of {} has a radius-edge ratio of {}, as that takes too many "
                      "elements.",
                      stimulus.label, stimulus.model->relaxed_radius_edge_ratio));
    }
    if (stimulus.model && !stimulus.model->dropped.empty()) {
      section.remarks.push_back(fmt::format(
          "Modes of {} that no tap excites were not rendered; below the strongest mode at every "
          "tapping point they would have been by: {}.",
          stimulus.label, stimulus.model->dropped));
    }
  }
  if (std::ranges::any_of(study.stimuli, is_orthotropic)) {
    section.remarks.emplace_back(
        "Where a material has three moduli, it is orthotropic, and they are those along its own "
        "axes; data has the first.");
  }
  if (std::ranges::any_of(study.stimuli, &RenderedStimulus::varies)) {
    section.remarks.emplace_back(
        "Of stimuli that vary, models are those of their own values, and taps those at all "
        "values.");
  }
}
}  // namespace

ReportSection rendered_section(const RenderedStudy& study) {
  ReportSection section{"What was rendered"};
  section.name = study_sections::rendered;
  section.is_detail = true;
  section.tables = {stimuli_table(study), models_table(study), modes_table(study)};
  if (study.traced_trials > 0) {
    section.tables.insert(
        section.tables.end(),
        {taps_table(study), participants_taps_table(study.participants), forces_table(study),
         points_table(study), waveforms_table(study), spectra_table(study)});
    add_rendered_charts(study, section);
    const TapWindow window = study.taps.empty() ? TapWindow{} : study.taps.front().all.window();
    section.remarks.push_back(fmt::format(
        "A tap is what was felt for {:.0f} ms from its impact on, or until the next tap; an impact "
        "within {:.0f} ms after the finger came off is a rebound of the tap before. Taps are those "
        "of all trials whose answers count. Root mean squares are over the ticks in contact; the "
        "total is before the limiter, the commanded force after it; reported is what the device "
        "says that it exerted.",
        1e3 * window.length_s, 1e3 * window.rebound_s));
  }
  say_what_is_missing(study, section);
  return section;
}
}  // namespace tapstudy::analysis
