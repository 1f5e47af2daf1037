#pragma once
#include <string_view>
namespace tapstudy::analysis {
// Whether the text begins with a minus sign, written as a hyphen, and not with one that joins words
// or numbers. before: the character before it; a space at the beginning.
inline bool is_minus(char before, std::string_view text) {
  return text.size() > 1 && text[0] == '-' && text[1] >= '0' && text[1] <= '9' &&
         (before == ' ' || before == '(');
}
}  // namespace tapstudy::analysis
