#include "protocols/read_protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/error.hpp"
#include "protocols/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
constexpr std::size_t largest_file = 4'000'000;

std::string contents_of(const std::string& file) {
  std::error_code error;
  std::ifstream stream{file, std::ios::binary};
  if (!stream || std::filesystem::is_directory(file, error)) {
    throw core::InvalidInput{file + ": cannot be read"};
  }
  std::string text(largest_file + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) {
    throw core::InvalidInput{file + ": cannot be read"};
  }
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > largest_file) {
    throw core::InvalidInput{
        fmt::format("{}: is too long for a protocol (at most {} bytes)", file, largest_file)};
  }
  return text;
}

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

Rig parse_rig(const std::string& text, const std::string& file) {
  Problems problems{file};
  MapReader top = MapReader::whole_file(text, file, problems);
  Rig rig;
  rig.text = text;
  top.word("format", "format", {"tapstudy-rig/1"});
  rig.device = top.word("device", "device", {"simulated_hand"});
  rig.limits.max_force_n = top.number("max_force_n", Range::positive(100.0));
  rig.limits.max_rate_n_per_s = top.number("max_force_rate_n_per_s", Range::positive(1e6));
  read_placement(top, MapReader::Presence::optional,
                 [&](const core::Placement& placement) { rig.placement = placement; });
  top.finish();
  problems.throw_if_any();
  return rig;
}

Protocol read_protocol(const std::string& file) {
  return parse_protocol(contents_of(file), file);
}

Rig read_rig(const std::string& file) {
  return parse_rig(contents_of(file), file);
}

Rig simulated_rig() {
  return parse_rig(
      "format: tapstudy-rig/1\n"
      "device: simulated_hand\n"
      "max_force_n: 10\n"
      "max_force_rate_n_per_s: 10000\n",
      "simulated rig");
}

std::set<std::string> keys_asked_for(const std::string& text, const std::string& file) {
  Problems problems{file};
  parse(text, file, problems);
  return problems.asked();
}
}  // namespace tapstudy::protocols
