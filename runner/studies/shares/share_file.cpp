#include "runner/studies/shares/share_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "core/text/plain_text.hpp"
#include "runner/build_info/build_info.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
using Json = nlohmann::ordered_json;
namespace {
std::string share_file_in(const std::string& directory) {
  return (std::filesystem::path{directory} / "share.json").string();
}

// Numbers are texts: JSON has neither infinity nor NaN, and no whole numbers of 64 bits.
template <class Number>
std::string text_of(Number number) {
  return fmt::format("{}", number);
}
template <class Number>
Number number_of(const Json& text) {
  const auto number = core::number_in<Number>(text.get<std::string>());
  if (!number) {
    throw core::InvalidInput{"'" + text.get<std::string>() + "' is no number"};
  }
  return *number;
}

Json to_json(const ResultOfStudy& result) {
  Json json{{"block", result.block},
            {"name", result.name},
            {"estimate", text_of(result.estimate)},
            {"low", text_of(result.low)},
            {"high", text_of(result.high)}};
  if (result.p) {
    json["p"] = text_of(*result.p);
  }
  return json;
}

ResultOfStudy result_from(const Json& json) {
  ResultOfStudy result{json.at("block"), json.at("name"), number_of<double>(json.at("estimate")),
                       number_of<double>(json.at("low")), number_of<double>(json.at("high"))};
  if (json.contains("p")) {
    result.p = number_of<double>(json.at("p"));
  }
  return result;
}

constexpr int share_format = 1;

Json to_json(const ShareFile& share) {
  const SharedSimulation& of = share.of;
  Json json{
      {"schema_version", share_format},  {"share", of.share.number}, {"of", of.share.of},
      {"participants", of.participants}, {"studies", of.studies},    {"seed", text_of(of.seed)},
      {"traces", of.keeps_traces},       {"inputs", of.inputs},      {"program", of.program}};
  for (const ResultsOfStudy& study : share.results) {
    Json& results = json["results"].emplace_back(Json::array());
    for (const ResultOfStudy& result : study) {
      results.push_back(to_json(result));
    }
  }
  return json;
}

ShareFile share_from_json(const Json& json) {
  if (json.at("schema_version") != share_format) {
    throw core::InvalidInput{"it is of another version of tapstudy"};
  }
  ShareFile share{{{json.at("share"), json.at("of")},
                   json.at("participants"),
                   json.at("studies"),
                   number_of<std::uint64_t>(json.at("seed")),
                   json.at("traces"),
                   json.at("inputs"),
                   json.at("program")}};
  for (const Json& study : json.value("results", Json::array())) {
    ResultsOfStudy& results = share.results.emplace_back();
    for (const Json& result : study) {
      results.push_back(result_from(result));
    }
  }
  return share;
}
}  // namespace

SharedSimulation shared_simulation(const Share& share, const protocols::Protocol& protocol) {
  const results::StudyRow study = study_row(protocol, "");
  std::string inputs = study.protocol_sha256;
  for (const results::SurfaceRow& file : study.surfaces) {
    inputs += " " + file.sha256;
  }
  return {.share = share,
          .inputs = inputs,
          .program = fmt::format("{} ({}, {})", program_version(), git_hash(), compiler())};
}

std::optional<ShareFile> share_in(const std::string& directory) {
  const std::string file = share_file_in(directory);
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    return std::nullopt;
  }
  std::ifstream stream{file};
  try {
    return share_from_json(Json::parse(stream));
  } catch (const std::exception& problem) {
    throw core::InvalidInput{fmt::format("{}: is not as tapstudy wrote it: {}", file,
                                         core::shortened(problem.what(), 120))};
  }
}

std::string difference_between(const SharedSimulation& one, const SharedSimulation& other) {
  const auto differ = [](const char* what, const auto& first, const auto& second) {
    return first == second ? std::string{}
                           : fmt::format("their {} differ ({} and {})", what, first, second);
  };
  for (const std::string& difference :
       {one.inputs == other.inputs ? std::string{} : "their protocols differ",
        differ("versions of tapstudy", one.program, other.program),
        differ("seeds", one.seed, other.seed),
        differ("numbers of studies", one.studies, other.studies),
        differ("numbers of participants", one.participants, other.participants),
        differ("numbers of shares", one.share.of, other.share.of),
        one.keeps_traces == other.keeps_traces ? std::string{} : "only one of them has traces"}) {
    if (!difference.empty()) {
      return difference;
    }
  }
  return "";
}

namespace {
bool is_complete(const std::string& directory, const SharedSimulation& share) {
  std::error_code error;
  if (!std::filesystem::exists(directory, error)) {
    return false;
  }
  const std::optional<ShareFile> there = share_in(directory);
  if (!there || !difference_between(there->of, share).empty() || there->of.share != share.share) {
    throw core::InvalidInput{directory +
                             ": exists already, and is not this share (choose another --out)"};
  }
  return true;
}
}  // namespace

void write_complete_share(const std::string& directory, const SharedSimulation& share,
                          const ComputeShare& compute) {
  if (is_complete(directory, share)) {
    warn(fmt::format("{}: share {} is complete already: nothing is computed", directory,
                     to_text(share.share)));
    return;
  }
  core::write_new_directory(directory, [&](const std::string& unfinished) {
    const std::vector<ResultsOfStudy> results = compute(unfinished);
    core::write_new_file(share_file_in(unfinished), to_json({share, results}).dump(1) + "\n");
  });
}
}  // namespace tapstudy::runner
