#pragma once
#include <string_view>
namespace tapstudy::runner {
// A file of the pages, as it is in this program.
struct Page {
  std::string_view name;
  std::string_view content;
  std::string_view media_type;
};
// nullptr if there is none of that name.
const Page* find_page(std::string_view name);
// Whether the pages' own words are given in it (two letters).
bool pages_speak(std::string_view language);
}  // namespace tapstudy::runner
