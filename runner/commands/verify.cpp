#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "analysis/report/writers.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "results/journal/journal.hpp"
#include "results/store/store.hpp"
#include "results/store_error.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/studies/mixed_models/fit_in_r.hpp"
#include "runner/studies/stored_study.hpp"
#include "runner/studies/study_summary.hpp"
#include "runner/studies/study_verification.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
// A report that lies in a study's directory, against one made anew from the stored answers.
struct PublishedReport {
  bool is_there{};
  std::string not_compared{};              // why, in words; empty: it was
  std::string not_fitted{};                // why R did not fit its models again; empty: it did
  std::vector<std::string> differences{};  // "report.json /blocks/0/…: 61, made anew 41", files
  // Sentences on earlier versions that this one adds, and that were left out of the comparison.
  std::vector<std::string> added{};
};
// Compares what report.json, the tables beside it and the page hold; where it was made is left out,
// what R fits now is that to a thousandth, as it is of R's version, and what it leaves out (--only)
// is not missed; one that differs and is older than the journal's last entry is not compared.
// Throws StoreError if report.json is none.
PublishedReport published_report(const std::string& directory, results::Store& store);

namespace {
using analysis::MixedModelRow;
using namespace nlohmann::literals;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string shortened(const ordered_json& value) {
  constexpr std::size_t longest = 60;
  return core::shortened(value.dump(-1, ' ', false, ordered_json::error_handler_t::replace),
                         longest);
}

// Collects the entries of the first that the second lacks or states otherwise.
void compare(const ordered_json& published, const ordered_json& anew, const std::string& path,
             std::vector<std::string>& differences) {
  if (published.is_object() && anew.is_object()) {
    for (const auto& [key, value] : published.items()) {
      compare(value, anew.contains(key) ? anew.at(key) : ordered_json{}, path + "/" + key,
              differences);
    }
  } else if (published.is_array() && anew.is_array() && published.size() == anew.size()) {
    for (std::size_t i = 0; i < published.size(); ++i) {
      compare(published[i], anew[i], fmt::format("{}/{}", path, i), differences);
    }
  } else if (published != anew) {
    differences.push_back(fmt::format("report.json {}: {}, made anew {}", path,
                                      shortened(published), shortened(anew)));
  }
}

ordered_json block_named(const ordered_json& report, const ordered_json& name) {
  for (const ordered_json& block : report.at("blocks")) {
    if (block.contains("block") && block.at("block") == name) {
      return block;
    }
  }
  return {};
}

// False for a report of parts of the study (--only).
bool is_whole(const ordered_json& published, const ordered_json& anew) {
  const auto names_of = [](const ordered_json& report) {
    std::vector<std::string> names;
    for (const auto& [key, value] : report.items()) {
      names.push_back(key);
    }
    const ordered_json of_study = report.value("study", ordered_json::object());
    for (const auto& [key, value] : of_study.items()) {
      names.push_back(key);
    }
    for (const ordered_json& block : report.at("blocks")) {
      names.push_back(block.value("block", ordered_json{}).dump());
    }
    return names;
  };
  return names_of(published) == names_of(anew);
}

// Sections of the study share one list of remarks: without those of sections that were left out.
ordered_json with_remarks_of(const ordered_json& published, ordered_json anew) {
  const auto path = "/study/remarks"_json_pointer;
  if (published.contains(path) && anew.contains(path) && !is_whole(published, anew)) {
    const ordered_json& said = published.at(path);
    ordered_json kept = ordered_json::array();
    for (const ordered_json& remark : anew.at(path)) {
      if (std::ranges::find(said, remark) != said.end()) {
        kept.push_back(remark);
      }
    }
    anew.at(path) = std::move(kept);
  }
  return anew;
}

void compare_reports(const ordered_json& published, const ordered_json& anew,
                     std::vector<std::string>& differences) {
  for (const ordered_json& block : published.at("blocks")) {
    const ordered_json name = block.value("block", ordered_json{});
    compare(block, block_named(anew, name), "/blocks/" + shortened(name), differences);
  }
  for (const char* const key : {"participants", "excluded", "study", "loop"}) {
    if (published.contains(key)) {
      compare(published.at(key), anew.value(key, ordered_json{}), std::string{"/"} + key,
              differences);
    }
  }
}

ordered_json json_of(const analysis::Summary& summary) {
  std::ostringstream text;
  analysis::write_json(text, summary);
  return ordered_json::parse(text.str());
}

std::string contents(const fs::path& file) {
  std::ifstream stream{file, std::ios::binary};
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void compare_file(const std::string& directory, const std::string& name, const std::string& text,
                  std::vector<std::string>& differences) {
  std::error_code ignored;
  const fs::path file = fs::path{directory} / name;
  if (fs::exists(file, ignored) && contents(file) != text) {
    differences.push_back(name + ": is not what a report made anew has");
  }
}

void compare_figures(const std::string& directory, const analysis::Summary& summary,
                     std::vector<std::string>& differences) {
  for (const auto& [name, svg] : analysis::figure_files(summary)) {
    compare_file(directory, "figures/" + name + ".svg", svg, differences);
  }
}

void compare_tables(const std::string& directory, const analysis::Summary& summary,
                    std::vector<std::string>& differences) {
  for (const auto& [name, text] : analysis::table_files(summary)) {
    compare_file(directory, name, text, differences);
  }
}

// Compares the page that people read, and the entries of report.json that concern the whole study.
void compare_whole(const std::string& directory, const ordered_json& published,
                   const ordered_json& anew, const analysis::Summary& summary,
                   std::vector<std::string>& differences) {
  for (const char* const key : {"deviations", "unfinished", "methods"}) {
    compare(published.value(key, ordered_json{}), anew.value(key, ordered_json{}),
            std::string{"/"} + key, differences);
  }
  std::ostringstream page;
  analysis::write_html(page, summary);
  compare_file(directory, "report.html", page.str(), differences);
  std::ostringstream tables;
  analysis::write_latex(tables, summary);
  compare_file(directory, "tables.tex", tables.str(), differences);
}

ordered_json read_published(const fs::path& file) {
  ordered_json published = ordered_json::parse(contents(file), nullptr, false);
  if (!published.is_object() || !published.contains("blocks") ||
      !published.at("blocks").is_array() || !published.value("modes", ordered_json{}).is_string()) {
    throw results::StoreError{file.string() + ": is not a report of tapstudy"};
  }
  return published;
}

// A report made before this version lacks what this version says of the earlier ones: so does, for
// the comparison, the one made anew. Returns what was left out.
std::vector<std::string> without_added_sentences(const ordered_json& published,
                                                 results::Store& store, results::Mode mode,
                                                 analysis::Summary& summary) {
  const ordered_json said = published.value("deviations", ordered_json::array());
  const auto excluded = store.excluded_participants();
  std::vector<results::SessionRow> sessions = store.sessions();
  std::erase_if(sessions, [&](const results::SessionRow& session) {
    return session.mode != mode || excluded.contains(session.participant_id);
  });
  std::vector<std::string> added;
  for (const std::string& sentence :
       rendered_by_earlier_versions(stored_protocol(store), sessions)) {
    if (std::ranges::find(said, ordered_json(sentence)) == said.end() &&
        std::erase(summary.deviations, sentence) > 0) {
      added.push_back(sentence);
    }
  }
  return added;
}

bool is_older(const fs::path& file, const fs::path& than) {
  std::error_code error;
  const auto of_file = fs::last_write_time(file, error);
  const auto of_other = fs::last_write_time(than, error);
  return !error && of_file < of_other;
}

// Earlier versions wrote it beside study.db.
std::string directory_of_report(const std::string& study) {
  const fs::path folder = fs::path{study} / report_folder;
  std::error_code ignored;
  return fs::exists(folder / "report.json", ignored) ? folder.string() : study;
}

bool is_fitted(const MixedModelRow& row) {
  return row.estimate || row.p;
}

bool are_close(const std::optional<double>& stated, const std::optional<double>& anew) {
  constexpr double relative = 1e-3;  // other versions of R end their iterations elsewhere
  constexpr double absolute = 1e-4;
  return stated.has_value() == anew.has_value() &&
         (!stated || std::abs(*stated - *anew) <=
                         absolute + relative * std::max(std::abs(*stated), std::abs(*anew)));
}

// Holds the fitted rows of a report against those of the same models that R has fitted now.
void compare_models(const std::vector<MixedModelRow>& stated,
                    const std::vector<MixedModelRow>& anew, std::vector<std::string>& differences) {
  const auto key = [](const MixedModelRow& row) {
    return std::tuple{row.block, row.model, row.term};
  };
  std::map<std::tuple<std::string, std::string, std::string>, const MixedModelRow*> found;
  for (const MixedModelRow& row : anew) {
    found.emplace(key(row), &row);
  }
  for (const MixedModelRow& row : stated) {
    const auto again = found.find(key(row));
    const bool is_same = again != found.end() && are_close(row.estimate, again->second->estimate) &&
                         are_close(row.standard_error, again->second->standard_error) &&
                         are_close(row.statistic, again->second->statistic) &&
                         are_close(row.p, again->second->p);
    if (is_fitted(row) && !is_same) {
      differences.push_back(
          fmt::format("mixed_models.csv, {} of {}: R fits another model now", row.term, row.block));
    }
  }
}

// As the report in the directory has them, so that all its files are held against one another;
// without an R the fits are only taken from there, which is said.
std::vector<MixedModelRow> checked_models(const std::string& directory, const results::Table& data,
                                          PublishedReport& found) {
  std::vector<MixedModelRow> stated;
  try {
    stated = mixed_models_of_report(directory);
  } catch (const core::InvalidInput& error) {
    found.differences.emplace_back(error.what());
  }
  if (std::ranges::any_of(stated, is_fitted)) {
    const std::vector<MixedModelRow> anew = fit_mixed_models_in_r(data);
    if (!anew.empty() && anew.back().block.empty()) {
      found.not_fitted = anew.back().note;
    } else {
      compare_models(stated, anew, found.differences);
    }
  }
  return stated;
}
}  // namespace

PublishedReport published_report(const std::string& study_directory, results::Store& store) {
  PublishedReport found;
  const std::string directory = directory_of_report(study_directory);
  const fs::path file = fs::path{directory} / "report.json";
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {
    return found;
  }
  found.is_there = true;
  const ordered_json published = read_published(file);
  results::Mode mode{};
  analysis::Summary summary;
  try {
    mode = results::mode_from(published.at("modes").get<std::string>());
    summary = summary_of_study(
        {{study_directory, &store}}, mode, Detail::all, {},
        [&](const results::Table& data) { return checked_models(directory, data, found); });
  } catch (const core::Error& error) {  // of another version
    found.not_compared = error.what();
    return found;
  }
  found.added = without_added_sentences(published, store, mode, summary);
  const ordered_json anew = json_of(summary);
  if (published.value("participants", ordered_json{}) < anew.at("participants")) {
    found.not_compared = "it was made of fewer participants than there are now";
    return found;
  }
  compare_reports(published, with_remarks_of(published, anew), found.differences);
  compare_tables(directory, summary, found.differences);
  compare_figures(directory, summary, found.differences);
  if (is_whole(published, anew)) {
    compare_whole(directory, published, anew, summary, found.differences);
  }
  if (!found.differences.empty() && is_older(file, results::journal_file(study_directory))) {
    found.differences.clear();
    found.not_compared =
        "it is older than the last entry of answers.journal (make it anew: report --replace)";
  }
  return found;
}

namespace {
struct VerifyOptions {
  std::string directory;
};

constexpr std::size_t max_printed = 20;

// Prints the first of them; returns a description of the fault, or an empty text.
std::string print_wrong(const std::vector<std::string>& wrong, const char* before,
                        const char* description) {
  constexpr std::size_t longest = 300;
  for (std::size_t i = 0; i < std::min(wrong.size(), max_printed); ++i) {
    fmt::print("{}{}\n", before, core::shortened(wrong[i], longest));
  }
  return wrong.empty() ? "" : fmt::format("{}: {}", description, wrong.size());
}

// Returns a description of the fault, or an empty text.
std::string print_recomputed(const Verification& found) {
  const results::Recomputation& recomputed = found.recomputed;
  std::string fault = print_wrong(recomputed.differences,
                                  "differs: ", "stored values that differ from those recomputed");
  fmt::print("recomputed       {} events from their traces, {} answers by their task's rule{}\n",
             recomputed.events, recomputed.answers,
             recomputed.unknown_blocks == 0 ? ""
                                            : fmt::format(" ({} of blocks that the protocol lacks)",
                                                          recomputed.unknown_blocks));
  if (found.actuator_samples > 0) {
    fmt::print("                 {} samples of actuators, rendered from the traces again\n",
               found.actuator_samples);
  }
  return fault;
}

// Compares journal and database; returns a description of the fault, or an empty text.
std::string print_compared(const Verification& found) {
  if (!found.journal_fault.empty()) {
    return found.journal_fault;
  }
  fmt::print("answers.journal  {} answers: hash chain intact\n", found.journalled_answers);
  print_wrong(found.not_in_journal, "not in answers.journal: ", "");
  print_wrong(found.not_in_database, "not in study.db: ", "");
  const std::size_t missing = found.not_in_journal.size() + found.not_in_database.size();
  if (missing > 0) {
    return fmt::format("answers or actions that are not the same in both: {}", missing);
  }
  fmt::print("their answers and actions agree\n");
  return "";
}

// Returns a description of the fault, or an empty text.
std::string print_published(const PublishedReport& report) {
  if (!report.is_there) {
    return "";
  }
  if (!report.not_compared.empty()) {
    fmt::print("report.json      not compared: {}\n", report.not_compared);
    return "";
  }
  const std::string fault = print_wrong(
      report.differences,
      "differs: ", "places where its report differs from a regenerated one (is it older?)");
  for (const std::string& sentence : report.added) {
    fmt::print("report.json      lacks what this version says of earlier ones: {}\n", sentence);
  }
  if (!report.not_fitted.empty()) {
    fmt::print("report.json      its mixed models are taken as they stand there: {}\n",
               report.not_fitted);
  }
  if (report.differences.empty()) {
    fmt::print("report.json      its tables and page: identical to a regenerated report\n");
    return "";
  }
  return fault;
}

void verify(const VerifyOptions& options) {
  results::Store store = results::Store::open_existing(options.directory);
  Progress progress{"verifying " + options.directory};
  const Verification found = verification_of(store, options.directory, progress.count());
  fmt::print("study.db         {} trials, {} answers, {} ticks: sound\n", found.trials,
             found.answers, found.recomputed.ticks);
  for (const std::string& remark : found.remarks) {
    warn(remark);
  }
  std::vector<std::string> wrong{
      print_recomputed(found), print_wrong(found.broken, "wrong: ", "rules that rows break"),
      print_wrong(found.study_and_sessions,
                  "differs: ", "rows of the study and its sessions that differ"),
      print_compared(found)};
  if (found.is_sound()) {  // else a report made anew would be wrong, too
    wrong.push_back(print_published(published_report(options.directory, store)));
  }
  std::erase(wrong, "");
  if (!wrong.empty()) {
    throw results::StoreError{fmt::format("{}: {}", options.directory, fmt::join(wrong, "; "))};
  }
}
}  // namespace

void add_verify(CommandParser& line) {
  Command command = line.add(
      "verify",
      "Check a study's database, its traces and its journal of answers, and recompute what "
      "follows from them");
  const auto options = std::make_shared<VerifyOptions>();
  command.argument("directory", options->directory, "Directory of a study", Need::required);
  command.on_run([options] { verify(*options); });
}
}  // namespace tapstudy::runner
