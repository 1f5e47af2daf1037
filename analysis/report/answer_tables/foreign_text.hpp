#pragma once
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>
namespace tapstudy::analysis {
// The bytes of a file as UTF-8. `encoding` is a name that iconv knows; empty: UTF-8, with or
// without a byte order mark. A line "sep=;" before the header, as spreadsheets write it, becomes
// empty. Throws InvalidInput, with the file, for bytes that are not of the encoding and for one
// that is not known.
std::string utf8_of(const std::string& bytes, const std::string& encoding, const std::string& file);

// Empties lines of a table that other programs add to it: the file's name above E-Prime's header,
// and "END OF FILE" below Gorilla's rows. Says which, for people: "the first line, …,".
std::vector<std::string> without_lines_of_programs(std::string& text);

// The same for names that people read as one: whatever their case, the spaces in and around them
// (no-break spaces included), how their letters are composed (Unicode, NFKC), marks that are not
// seen and zeros before a number.
std::string as_read(const std::string& name);

class Spellings {
 public:
  // The first of the names so far that people would read as this one, also because letters of Greek
  // and Cyrillic look like Latin ones.
  const std::string& first_like(const std::string& name);

 private:
  std::unordered_map<std::string, std::string> first_;  // by what is read
};
// The first two of the names that people would read as one.
std::optional<std::pair<std::string, std::string>> first_alike(
    const std::vector<std::string>& names);
}  // namespace tapstudy::analysis
