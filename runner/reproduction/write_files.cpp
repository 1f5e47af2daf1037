#include <fmt/format.h>

#include <filesystem>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/output_directory.hpp"
#include "core/output_file.hpp"
#include "runner/reproduction/claim_table.hpp"
#include "runner/reproduction/writers.hpp"
namespace tapstudy::runner {
namespace {
constexpr const char* page_file = "reproduction.html";
constexpr const char* json_file = "reproduction.json";

std::string in(const std::string& directory, std::string_view name) {
  return (std::filesystem::path{directory} / name).string();
}

std::string written(void (*write)(std::ostream&, const Reproduction&),
                    const Reproduction& reproduction) {
  std::ostringstream text;
  write(text, reproduction);
  return text.str();
}
}  // namespace

void make_room_for_reproduction(const std::string& directory) {
  core::make_directories(directory);
  core::check_is_new(in(directory, page_file));
  core::check_is_new(in(directory, json_file));
  core::check_is_new(in(directory, strike_animation_file));
}

void write_files(const std::string& directory, const Reproduction& reproduction) {
  std::vector<core::NewFile> files{{in(directory, page_file), written(write_html, reproduction)},
                                   {in(directory, json_file), written(write_json, reproduction)}};
  for (const MeasuredGroup& group : reproduction.groups) {
    for (const Claim& claim : group.claims) {
      for (const Animation& animation : claim.animations) {
        files.push_back({in(directory, animation.file), animation.png});
      }
    }
  }
  core::write_all_or_none(files, core::Existing::kept);
}

std::string command_of(const Reproduction& reproduction) {
  std::string only;
  for (const std::string& name : reproduction.only) {
    only += " --only " + name;
  }
  return fmt::format("tapstudy reproduce{}{} --seed {} --out DIR", only,
                     reproduction.effort == Effort::quick ? " --quick" : "", reproduction.seed);
}

void print(const Reproduction& reproduction) {
  for (const MeasuredGroup& group : reproduction.groups) {
    fmt::print("{}\n", group.title);
    for (const Claim& claim : group.claims) {
      fmt::print("  {:<8} {}\n", name(claim.verdict()), claim.statement);
    }
  }
}
}  // namespace tapstudy::runner
