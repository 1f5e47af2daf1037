#include "runner/experiments/published_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/report/table_files.hpp"
#include "analysis/report/writers.hpp"
#include "core/error.hpp"
#include "core/plain_text.hpp"
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

void compare_tables(const std::string& directory, const analysis::Summary& summary,
                    std::vector<std::string>& differences) {
  std::error_code ignored;
  for (const auto& [name, text] : analysis::table_files(summary)) {
    const fs::path file = fs::path{directory} / name;
    if (fs::exists(file, ignored) && contents(file) != text) {
      differences.push_back(name + ": is not what a report made anew has");
    }
  }
}

ordered_json read_published(const fs::path& file) {
  ordered_json published = ordered_json::parse(contents(file), nullptr, false);
  if (!published.is_object() || !published.contains("blocks") ||
      !published.at("blocks").is_array() || !published.value("modes", ordered_json{}).is_string()) {
    throw results::StoreError{file.string() + ": is not a report of tapstudy"};
  }
  return published;
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
  return found;
}
}  // namespace tapstudy::runner
