#include <filesystem>

#include "core/output_directory.hpp"
#include "core/output_file.hpp"
#include "runner/recordings/writers.hpp"
namespace tapstudy::runner {
void write_files(const std::string& directory, const TapIdentification& found) {
  core::write_new_directory(directory, [&](const std::string& unfinished) {
    const auto in = [&](const std::string& file) {
      return (std::filesystem::path{unfinished} / file).string();
    };
    core::write_new_file(in("identified.yaml"), [&](std::ostream& out) { out << yaml_of(found); });
    if (found.question.at_m) {
      core::write_new_file(in("recordings.yaml"),
                           [&](std::ostream& out) { out << playback_of(found, found.finger_kg); });
    }
    core::write_new_file(in("identified.json"),
                         [&](std::ostream& out) { out << json_of(found) << '\n'; });
    for (const NamedFigure& one : figures_of(found)) {
      analysis::draw_svg(one.figure, in(one.name));
    }
  });
}
}  // namespace tapstudy::runner
