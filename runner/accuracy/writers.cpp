#include "runner/accuracy/writers.hpp"

#include <filesystem>

#include "core/error.hpp"
#include "core/output_directory.hpp"
#include "core/output_file.hpp"
namespace tapstudy::runner {
namespace {
std::string in(const std::string& directory, const char* name) {
  return (std::filesystem::path{directory} / name).string();
}
}  // namespace

void make_room(const std::string& directory) {
  core::make_directories(directory);
  for (const char* const name : {"trade.csv", "stability.csv", "trade.json", "trade.svg"}) {
    core::check_is_new(in(directory, name));
  }
}

void write_files(const std::string& directory, const Trade& trade, const Stability& stability) {
  core::write_new_file(in(directory, "trade.csv"),
                       [&](std::ostream& out) { write_csv(out, trade); });
  core::write_new_file(in(directory, "stability.csv"),
                       [&](std::ostream& out) { write_csv(out, stability); });
  core::write_new_file(in(directory, "trade.json"),
                       [&](std::ostream& out) { out << json_of(trade, stability) << '\n'; });
  analysis::draw_svg(figure_of(trade), in(directory, "trade.svg"));
}
}  // namespace tapstudy::runner
