// Pictures beside what participants read.
#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "protocols/reader/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

// Read once, however often it is shown: what is shown is what is stored.
Picture picture_of(const std::string& file, const ReadFile& read_file, Protocol& protocol) {
  const auto known = std::ranges::find(protocol.pictures, file, &Picture::file);
  if (known != protocol.pictures.end()) {
    return *known;
  }
  const auto bytes = std::make_shared<const std::string>(read_file(file));
  return protocol.pictures.emplace_back(
      Picture{file, {}, media_type_of_picture(file, *bytes), bytes});
}

Picture read_one(MapReader& reader, const ReadFile& read_file, Protocol& protocol) {
  const std::size_t earlier_problems = reader.problems_in_file();
  const std::string file = reader.text(
      {"file",
       "SVG without scripts, PNG or JPEG, at most 1 MB; relative to the protocol's folder"});
  const std::string text = reader.translated(
      {"text", "what it shows, for those who cannot see it, and at the terminal"});
  Picture picture;
  if (reader.problems_in_file() == earlier_problems && read_file) {  // a schema has no files
    try {
      picture = picture_of(file, read_file, protocol);
    } catch (const core::InvalidInput& error) {
      reader.reject("file", error.what());
    }
  }
  picture.text = text;
  return picture;
}
}  // namespace

std::optional<Picture> read_picture(MapReader& reader, const Key& key, const ReadFile& read_file,
                                    Protocol& protocol) {
  std::optional<Picture> picture;
  reader.map(key, Presence::optional,
             [&](MapReader& inner) { picture = read_one(inner, read_file, protocol); });
  return picture;
}

std::vector<Picture> read_pictures(MapReader& reader, const Key& key, std::size_t count,
                                   const ReadFile& read_file, Protocol& protocol) {
  std::vector<Picture> pictures;
  reader.list(key, Presence::optional,
              [&](MapReader& inner) { pictures.push_back(read_one(inner, read_file, protocol)); });
  if (!pictures.empty() && pictures.size() != count) {
    if (read_file) {  // a schema has neither options nor files
      reader.reject(key.name, fmt::format("{} are given (must be {}: one for each option)",
                                          pictures.size(), count));
    }
    pictures.clear();
  }
  return pictures;
}

std::optional<Picture> read_instructions_picture(MapReader& reader, const std::string& instructions,
                                                 const ReadFile& read_file, Protocol& protocol) {
  std::optional<Picture> picture = read_picture(
      reader, {"instructions_picture", "after the instructions; unset: none"}, read_file, protocol);
  if (picture && instructions.empty() && read_file) {
    reader.reject("instructions_picture", "stands beside `instructions`, which are not given");
  }
  return picture;
}
}  // namespace tapstudy::protocols
