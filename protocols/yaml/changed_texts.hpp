#pragma once
#include <string>
#include <vector>

#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
// A file that was read, and which of its texts are for people.
struct ReadText {
  const std::string& text;
  const Translations& translations;
};

// A text for people that two files have otherwise. Of several lines the first that differs.
struct ChangedText {
  std::string key;
  std::string before;  // empty: none
  std::string now;
  int line_now{};  // where it stands in the file, from 1; before, where it is there no more
};

struct ChangesOfFile {
  std::vector<std::string> data_keys;  // of what may enter the data, in the file's order
  std::vector<ChangedText> texts;
};

// What one file says otherwise than an earlier one, as both were read: comments, layout, quotes and
// how a number is written aside. The order of what has names is of the data. Both have been read
// without a problem.
ChangesOfFile changes_between(const ReadText& before, const ReadText& now);
}  // namespace tapstudy::protocols
