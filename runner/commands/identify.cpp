#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "analysis/modal/response/response_files.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/laboratory/identify/modal_report.hpp"
#include "runner/laboratory/identify/responses/response_identification.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
struct IdentifyOptions {
  TapQuestion question;
  std::string quantity{"acceleration"};
  double scale{};  // 0: not given
  std::string response;
  std::string band;
  std::string at;
  bool wants_json{false};
  bool wants_all{false};
  std::string out;
};

// "10:300"
analysis::Band band_from(const std::string& text) {
  const auto [low_hz, high_hz] = core::two_numbers_in(text, ':').value_or(std::pair{0.0, 0.0});
  if (!(low_hz > 0.0 && low_hz < high_hz && high_hz <= 1e5)) {
    throw core::InvalidInput{
        fmt::format("--band '{}': must be LOW:HIGH in Hz, 0 < LOW < HIGH <= 100000", text)};
  }
  return {low_hz, high_hz};
}

// "0.1,0.05"
Eigen::Vector2d place_from(const std::string& text) {
  const auto at_m = core::two_numbers_in(text, ',');
  if (!at_m || !(std::abs(at_m->first) <= 10.0 && std::abs(at_m->second) <= 10.0)) {
    throw core::InvalidInput{fmt::format("--at '{}': must be X,Y in m, in the plate frame", text)};
  }
  return {at_m->first, at_m->second};
}

void check_playback(const TapQuestion& question) {
  if (question.columns.size() > 1) {
    throw core::InvalidInput{"--at takes one channel: that of the place tapped"};
  }
  if (question.protocol.empty() || question.speeds.empty() ||
      question.quantity != analysis::Quantity::acceleration) {
    throw core::InvalidInput{
        "--at needs --speeds, and --protocol with --stimulus, whose finger makes forces of "
        "accelerations (--quantity acceleration)"};
  }
}

void check_files_and_protocol(const TapQuestion& question) {
  if (question.recordings.empty()) {
    throw core::InvalidInput{
        "identify takes at least one recording (CSV, MATLAB, universal file or WAV)"};
  }
  for (const std::string& file : question.recordings) {
    if (std::ranges::count(question.recordings, file) > 1) {
      throw core::InvalidInput{file + ": is given twice"};
    }
  }
  if (question.protocol.empty() != question.stimulus.empty()) {
    throw core::InvalidInput{"--protocol and --stimulus go together"};
  }
}

// Whether the files are of frequency responses; all or none.
bool are_responses(const IdentifyOptions& options) {
  const std::vector<std::string>& files = options.question.recordings;
  if (!options.response.empty()) {
    return true;
  }
  const bool first = analysis::holds_responses(files.front());
  for (const std::string& file : files) {
    if (analysis::holds_responses(file) != first) {
      throw core::InvalidInput{
          fmt::format("{} holds frequency responses, {} recordings: identify takes one kind at a "
                      "time",
                      first ? files.front() : file, first ? file : files.front())};
    }
  }
  return first;
}

ResponseQuestion response_question_of(const IdentifyOptions& options) {
  const TapQuestion& asked = options.question;
  if (!asked.columns.empty() || !asked.force_column.empty() || !asked.speeds.empty() ||
      !options.at.empty() || asked.reading.rate_hz > 0.0) {
    throw core::InvalidInput{
        "--column, --force-column, --speeds, --at and --rate are for recordings of taps, not for "
        "frequency responses"};
  }
  if (!asked.places.empty() && asked.protocol.empty()) {
    throw core::InvalidInput{"--places needs --protocol with --stimulus, whose model has shapes"};
  }
  ResponseQuestion question{asked.recordings, {}, {}, asked.places, asked.protocol, asked.stimulus};
  if (!options.response.empty()) {
    question.kind = analysis::response_kind_from(options.response);
  }
  if (!options.band.empty()) {
    question.band = band_from(options.band);
  }
  return question;
}

TapQuestion question_of(const IdentifyOptions& options) {
  TapQuestion question = options.question;
  question.quantity = analysis::quantity_from(options.quantity);
  if (options.scale > 0.0) {
    question.scale = options.scale;
  }
  if (!options.band.empty()) {
    question.band = band_from(options.band);
  }
  const bool has_impulses = !question.speeds.empty() || !question.force_column.empty();
  if (!question.places.empty() && (question.protocol.empty() || !has_impulses)) {
    throw core::InvalidInput{
        "--places needs --force-column or --speeds, for the impulses, and --protocol with "
        "--stimulus, whose model has shapes"};
  }
  if (!options.at.empty()) {
    question.at_m = place_from(options.at);
    check_playback(question);
  }
  return question;
}

// Noise has onsets, too: without a mode or a sinusoid there is nothing to paste into a protocol.
void require_identified_mode(const TapIdentification& found) {
  if (!found.agreed.empty() || found.sinusoid) {
    return;
  }
  std::vector<std::string> doubtful;
  for (const analysis::RepeatedMode& mode : found.modes) {
    doubtful.push_back(fmt::format("{:.4g} Hz: {}", mode.frequency_hz.value, mode.why));
  }
  constexpr std::size_t most_told = 3;
  doubtful.resize(std::min(doubtful.size(), most_told));
  throw core::InvalidInput{fmt::format(
      "{}: no mode and no decaying sinusoid could be identified in what begins like a tap; is it "
      "noise?{}",
      fmt::join(found.question.recordings, ", "),
      doubtful.empty() ? "" : fmt::format(" Doubtful: {}", fmt::join(doubtful, "; ")))};
}

void identify_from_responses(const IdentifyOptions& options) {
  const ResponseQuestion question = response_question_of(options);
  const ResponseIdentification found = [&] {
    Progress progress{"identifying"};
    return identify_responses(question, progress);
  }();
  write_files(options.out, found);  // its figures show why there is nothing in it
  if (found.agreed.empty()) {
    throw core::InvalidInput{
        fmt::format("{}: no mode could be identified{}{}", fmt::join(question.files, ", "),
                    found.others.empty() ? "" : "; doubtful: ", fmt::join(found.others, "; "))};
  }
  if (options.wants_json) {
    fmt::print("{}\n", json_of(found));
  } else {
    print(found);
  }
}

void identify_from_taps(const IdentifyOptions& options) {
  const TapQuestion question = question_of(options);
  const TapIdentification found = [&] {
    Progress progress{"identifying"};
    return identify_taps(question, progress);
  }();
  write_files(options.out, found);  // its figures show why there is nothing in it
  require_identified_mode(found);
  if (options.wants_json) {
    fmt::print("{}\n", json_of(found));
  } else {
    print(found, options.wants_all ? Listing::all : Listing::modes);
  }
}

void run_identify(const IdentifyOptions& options) {
  check_files_and_protocol(options.question);
  std::error_code error;
  if (std::filesystem::exists(options.out, error)) {
    throw core::InvalidInput{options.out + ": exists already (a new directory is needed)"};
  }
  if (are_responses(options)) {
    identify_from_responses(options);
  } else {
    identify_from_taps(options);
  }
}
}  // namespace

void add_identify(CommandParser& line) {
  Command command =
      line.add("identify",
               "Recordings of real taps, or frequency responses: modes, damping, Young's modulus");
  const auto options = std::make_shared<IdentifyOptions>();
  TapQuestion& question = options->question;
  command.arguments("recordings", question.recordings,
                    "Recordings: tables (.csv, .txt, .tsv, .dat, .lvm), MATLAB (.mat), universal "
                    "files (.uff, .unv), WAV, FLAC ...; or frequency responses: universal files, "
                    "tables with frequency_hz");
  command.one_of("--response", options->response, {"receptance", "mobility", "accelerance"},
                 "The files are frequency responses of this kind, which they do not state");
  command.option("--out", options->out,
                 "New directory for identified.yaml, identified.json and figures", Need::required);
  command.option("--protocol", question.protocol, "Study (YAML) with a model of what was tapped");
  command.option("--stimulus", question.stimulus, "Which of its stimuli was tapped");
  command.number_within("--rate", question.reading.rate_hz, 0.0, 1e7,
                        "Samples a second, where the file does not state them");
  command.flag("--trust-rate", question.reading.trusts_rate,
               "Take --rate instead of another rate that the file states");
  command.number_within("--rate-error", question.rate_error, 0.0, 0.1,
                        "Relative error of the recordings' rate that intervals include; default: "
                        "0.001 (a quartz: 0.0001)");
  command.list("--column", question.columns,
               "Headers or numbers (from 1) of the channels; default: the only one");
  command.option("--force-column", question.force_column,
                 "Channel of what struck, N: impulses for --places");
  command.one_of("--quantity", options->quantity, {"acceleration", "velocity", "displacement"},
                 "What was measured; default: acceleration");
  command.number_within("--scale", options->scale, 1e-12, 1e12,
                        "SI units (m/s2, m/s, m) per unit of the recordings, where these are "
                        "others");
  command.option(
      "--band", options->band,
      "LOW:HIGH in Hz; default: 10 to the highest peak of the recordings, or the protocol's "
      "band limit");
  command.number_within("--skip", question.finding.skip_s, 0.0, 1.0,
                        "Seconds after a tap's peak before it rings freely");
  command.number_within("--longest", question.finding.max_s, 0.05, 60.0,
                        "Seconds of free decay of a tap at most");
  command.option("--speeds", question.speeds,
                 "CSV with a column speed_m_s: the speed of each impact, in order");
  command.option(
      "--places", question.places,
      "CSV with columns x_m and y_m: where each impact tapped the plate, in order, or with place, "
      "x_m and y_m: where each response was measured; modes are then matched by their shapes, too");
  command.option("--at", options->at,
                 "X,Y of the place tapped, m: writes recordings.yaml for technique recorded");
  command.flag("--all", options->wants_all,
               "List what is no mode for certain, too: hum, doubtful ones, combinations");
  command.flag("--json", options->wants_json, "Output as JSON");
  command.on_run([options] { run_identify(*options); });
}
}  // namespace tapstudy::runner
