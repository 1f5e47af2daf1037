#include "runner/experiments/published_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/report/figure_files.hpp"
#include "analysis/report/table_files.hpp"
#include "analysis/report/writers.hpp"
#include "core/error.hpp"
#include "core/plain_text.hpp"
#include "results/journal.hpp"
#include "results/store_error.hpp"
#include "runner/experiments/study_summary.hpp"
namespace tapstudy::runner {
namespace {
using nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string shortened(const ordered_json& value) {
  constexpr std::size_t longest = 60;
  return core::shortened(value.dump(-1, ' ', false, ordered_json::error_handler_t::replace),
                         longest);
}

// What the first says that the second does not.
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

// Not one of parts of the study (--only).
bool is_whole(const ordered_json& published, const ordered_json& anew) {
  const auto names_of = [](const ordered_json& report) {
    std::vector<std::string> names;
    for (const auto& [key, value] : report.items()) {
      names.push_back(key);
    }
    for (const ordered_json& block : report.at("blocks")) {
      names.push_back(block.value("block", ordered_json{}).dump());
    }
    return names;
  };
  return names_of(published) == names_of(anew);
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

// What people read, and what in report.json is of the study as a whole.
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

bool is_older(const fs::path& file, const fs::path& than) {
  std::error_code error;
  const auto of_file = fs::last_write_time(file, error);
  const auto of_other = fs::last_write_time(than, error);
  return !error && of_file < of_other;
}
}  // namespace

PublishedReport published_report(const std::string& directory, results::Store& store) {
  PublishedReport found;
  const fs::path file = fs::path{directory} / "report.json";
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {
    return found;
  }
  found.is_there = true;
  const ordered_json published = read_published(file);
  analysis::Summary summary;
  try {
    summary = summary_of_study({{directory, &store}},
                               results::mode_from(published.at("modes").get<std::string>()));
  } catch (const core::Error& error) {  // of another version
    found.not_compared = error.what();
    return found;
  }
  const ordered_json anew = json_of(summary);
  if (published.value("participants", ordered_json{}) < anew.at("participants")) {
    found.not_compared = "it was made of fewer participants than there are now";
    return found;
  }
  compare_reports(published, anew, found.differences);
  compare_tables(directory, summary, found.differences);
  compare_figures(directory, summary, found.differences);
  if (is_whole(published, anew)) {
    compare_whole(directory, published, anew, summary, found.differences);
  }
  if (!found.differences.empty() && is_older(file, results::journal_file(directory))) {
    found.differences.clear();
    found.not_compared =
        "it is older than the last entry of answers.journal (make it anew: report --replace)";
  }
  return found;
}
}  // namespace tapstudy::runner
