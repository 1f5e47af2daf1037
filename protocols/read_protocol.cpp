#include "protocols/read_protocol.hpp"

#include <filesystem>

#include "protocols/read_sections.hpp"
#include "protocols/text_file.hpp"
namespace tapstudy::protocols {
namespace {
Protocol parse(const std::string& text, const std::string& file, Problems& problems) {
  const std::string directory = std::filesystem::path{file}.parent_path().string();
  MapReader top = MapReader::whole_file(text, file, problems);
  Protocol protocol;
  protocol.text = text;
  top.word("format", "format", {"tapstudy/1"});
  protocol.title = top.text("title");
  protocol.notes = top.paragraphs("notes", "");
  read_rendering(top, protocol);
  read_placement(top, MapReader::Presence::required,
                 [&](const core::Placement& placement) { protocol.placement = placement; });
  read_materials(top, protocol);
  read_plates(top, protocol, directory);
  read_stimuli(top, protocol);
  read_blocks(top, protocol);
  read_hypotheses(top, protocol);
  read_simulation(top, protocol);
  top.finish();
  return protocol;
}
}  // namespace

Protocol parse_protocol(const std::string& text, const std::string& file) {
  Problems problems{file};
  Protocol protocol = parse(text, file, problems);
  problems.throw_if_any();
  return protocol;
}

Protocol read_protocol(const std::string& file) {
  return parse_protocol(contents_of(file), file);
}

std::set<std::string> keys_asked_for(const std::string& text, const std::string& file) {
  Problems problems{file};
  parse(text, file, problems);
  return problems.asked();
}
}  // namespace tapstudy::protocols
