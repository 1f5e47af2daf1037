#include "runner/console/pages.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>
namespace tapstudy::runner {
namespace {
struct Embedded {
  const char* name;
  const char* begin;
  const char* end;
};
#include "embedded_pages.inc"

std::string_view media_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> types{
      {{".html", "text/html; charset=utf-8"},
       {".css", "text/css; charset=utf-8"},
       {".js", "text/javascript; charset=utf-8"},
       {".json", "application/json"},
       {".svg", "image/svg+xml"}}};
  const auto found =
      std::ranges::find_if(types, [&](const auto& type) { return name.ends_with(type.first); });
  return found == types.end() ? "application/octet-stream" : found->second;
}
}  // namespace

const Page* find_page(std::string_view name) {
  static const std::vector<Page> pages = [] {
    std::vector<Page> all;
    for (const Embedded& file : embedded) {
      all.push_back({file.name, {file.begin, file.end}, media_type(file.name)});
    }
    return all;
  }();
  const auto found = std::ranges::find(pages, name, &Page::name);
  return found == pages.end() ? nullptr : &*found;
}

bool pages_speak(std::string_view language) {
  const std::string_view words = find_page("messages.json")->content;
  return words.find("\"" + std::string{language} + "\": {") != std::string_view::npos;
}
}  // namespace tapstudy::runner
