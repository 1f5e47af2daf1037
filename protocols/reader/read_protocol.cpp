#include "protocols/reader/read_protocol.hpp"

#include <filesystem>

#include "core/error.hpp"
#include "protocols/reader/earlier_defaults.hpp"
#include "protocols/reader/read_sections.hpp"
#include "protocols/yaml/text_file.hpp"
namespace tapstudy::protocols {
namespace {
// File names are relative to the study's own file.
ReadFile beside(const std::string& file) {
  return [directory = std::filesystem::path{file}.parent_path()](const std::string& name) {
    const std::filesystem::path path = directory / name;
    std::error_code error;
    if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
      throw core::InvalidInput{path.string() + ": cannot be read (not a file)"};
    }
    return contents_of(path.string(), max_surface_bytes);
  };
}

void read_whole(MapReader& top, Protocol& protocol, const SurfaceFiles& files,
                const EarlierDefaults& defaults) {
  top.check_format("tapstudy/1");
  protocol.title = top.translated({"title",
                                   "of the study, as participants' pages and reports show it: it "
                                   "should not give the question away"});
  protocol.notes = top.paragraphs({"notes", "free text, printed in reports"}, "");
  const int planned =
      top.integer({"participants", "how many are planned, for check and simulate; unset: 10"}, 1,
                  max_participants, 1);
  if (top.has("participants")) {
    protocol.participants = planned;
    top.leave_out_of_data("participants");
  }
  protocol.instructions = top.translated_paragraphs(
      {"instructions", "for participants, shown before the first trial; paragraphs"}, "");
  protocol.instructions_picture =
      read_instructions_picture(top, protocol.instructions, files.contents, protocol);
  read_rendering(top, protocol);
  read_placement(
      top,
      {"placement",
       "position of the plate in the device's workspace; the scale along the normal is always 1"},
      MapReader::Presence::required,
      [&](const core::Placement& placement) { protocol.placement = placement; });
  read_materials(top, protocol);
  read_points(top, protocol);
  read_plates(top, protocol, files, defaults);
  read_recordings(top, protocol);
  read_contacts(top, protocol);
  read_stimuli(top, protocol);
  read_forms(top, files.contents, protocol);
  read_display(top, protocol);
  read_blocks(top, files.contents, protocol);
  read_planned_sessions(top, protocol);
  read_block_order(top, protocol);
  read_groups(top, protocol);
  read_hypotheses(top, protocol);
  read_masking(top, protocol);
  read_simulation(top, protocol);
}

Protocol parse(const StudyText& study, const SurfaceFiles& files, const EarlierDefaults& defaults,
               Problems& problems) {
  Protocol protocol;
  protocol.text = study.text;
  protocol.translations.language = study.language;
  MapReader top = MapReader::whole_file(study.text, study.file, problems, &protocol.translations);
  read_whole(top, protocol, files, defaults);
  top.finish();
  return protocol;
}
}  // namespace

std::string protocol_schema() {
  return MapReader::schema_of(
      "protocol", "A user study of tapped virtual plates. SI units, spelled in the keys.",
      [](MapReader& top) {
        Protocol protocol;
        read_whole(top, protocol, {}, {});
      });
}

Protocol parse_protocol(const std::string& text, const std::string& file) {
  return parse_protocol({text, file}, beside(file));
}

Protocol parse_protocol(const StudyText& study, const ReadFile& read_file) {
  return parse_protocol(study, SurfaceFiles{read_file}, {});
}

Protocol parse_protocol(const StudyText& study, const SurfaceFiles& files,
                        const EarlierDefaults& defaults) {
  Problems problems{study.file};
  Protocol protocol = parse(study, files, defaults, problems);
  problems.throw_if_any();
  return protocol;
}

Protocol read_protocol(const std::string& file, const std::string& language) {
  return read_protocol(file, language, {});
}

Protocol read_protocol(const std::string& file, const std::string& language,
                       const EarlierDefaults& defaults) {
  return parse_protocol({contents_of(file), file, language}, SurfaceFiles{beside(file)}, defaults);
}

std::set<std::string> keys_asked_for(const std::string& text, const std::string& file) {
  Problems problems{file};
  parse({text, file}, SurfaceFiles{beside(file)}, {}, problems);
  return problems.asked();
}
}  // namespace tapstudy::protocols
