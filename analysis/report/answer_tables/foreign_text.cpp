#include "analysis/report/answer_tables/foreign_text.hpp"

#include <fmt/format.h>
#include <glib.h>
#include <unicode/uchar.h>
#include <unicode/uscript.h>
#include <unicode/uspoof.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <regex>
#include <string_view>
#include <unordered_map>

#include "analysis/statistics/text_encoding.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
struct Free {
  void operator()(char* text) const { g_free(text); }
};
using Text = std::unique_ptr<char, Free>;

gssize size_of(const std::string& text) {
  return static_cast<gssize>(text.size());
}

std::size_t begin_of(const std::string& text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return text.starts_with(mark) ? mark.size() : 0;
}

std::string first_line(const std::string& text) {
  const std::size_t begin = begin_of(text);
  return text.substr(begin, text.find_first_of("\r\n", begin) - begin);
}

std::string without_separator_line(std::string text) {
  const std::size_t begin = begin_of(text);
  const std::string line = first_line(text);
  constexpr std::string_view key = "sep=";
  if (line.size() == key.size() + 1 && line.starts_with(key)) {
    text.erase(begin, line.size());  // its end stays, for the lines that are counted
  }
  return text;
}
}  // namespace

std::string utf8_of(const std::string& bytes, const std::string& encoding,
                    const std::string& file) {
  if (encoding.empty()) {
    if (bytes.find('\0') != std::string::npos || !is_utf8(bytes)) {
      throw core::InvalidInput{
          fmt::format("{}: is not UTF-8 text (--encoding says what it is in: probably {})", file,
                      likely_encoding(bytes))};
    }
    return without_separator_line(bytes);
  }
  const auto text = converted_to_utf8(bytes, encoding);
  if (!text) {
    throw core::InvalidInput{fmt::format("{}: is not text in {} (--encoding)", file, encoding)};
  }
  return without_separator_line(*text);
}

std::vector<std::string> without_lines_of_programs(std::string& text) {
  std::vector<std::string> told;
  const std::string line = first_line(text);
  std::string name = core::lower_case(line);
  name.erase(name.find_last_not_of(" \"0123456789") + 1);  // .edat2, .emrg3
  if (name.find('\t') == std::string::npos &&
      (name.ends_with(".edat") || name.ends_with(".emrg"))) {
    text.erase(begin_of(text), line.size());  // its end stays, for the lines that are counted
    told.emplace_back("the first line, in which E-Prime names its file,");
  }
  constexpr std::string_view fillers = "\r\n\t,; \"";
  const std::size_t last = text.find_last_not_of(fillers);
  const std::size_t end = last == std::string::npos ? last : text.find_last_of("\r\n", last);
  if (end != std::string::npos) {
    const std::size_t first = text.find_first_not_of(fillers, end);
    if (text.substr(first, last + 1 - first) == "END OF FILE") {
      text.erase(end + 1);
      told.emplace_back("the last line, 'END OF FILE', which Gorilla adds,");
    }
  }
  return told;
}

namespace {
// The same for readers: dashes and apostrophes of all kinds.
void plain_characters(std::string& text) {
  const auto replace_all = [&](std::string_view one, std::string_view other) {
    for (auto at = text.find(one); at != std::string::npos; at = text.find(one, at)) {
      text.replace(at, one.size(), other);
    }
  };
  for (const char* const dash : {"\u2010", "\u2011", "\u2012", "\u2013", "\u2014", "\u2212"}) {
    replace_all(dash, "-");
  }
  for (const char* const apostrophe : {"\u2018", "\u2019", "\u02bc"}) {
    replace_all(apostrophe, "'");
  }
}

struct CloseChecker {
  void operator()(USpoofChecker* checker) const { uspoof_close(checker); }
};

// What the character looks like, by Unicode's table of characters that are confused.
std::string look_of(std::string_view character) {
  UErrorCode status = U_ZERO_ERROR;
  static const std::unique_ptr<USpoofChecker, CloseChecker> checker{uspoof_open(&status)};
  std::array<char, 64> look{};
  const std::int32_t size = uspoof_getSkeletonUTF8(
      checker.get(), 0, character.data(), static_cast<std::int32_t>(character.size()), look.data(),
      static_cast<std::int32_t>(look.size()), &status);
  return U_SUCCESS(status) != 0 ? std::string{look.data(), static_cast<std::size_t>(size)}
                                : std::string{character};
}

bool is_greek_or_cyrillic(UChar32 character) {
  UErrorCode status = U_ZERO_ERROR;
  const UScriptCode script = uscript_getScript(character, &status);
  return script == USCRIPT_GREEK || script == USCRIPT_CYRILLIC;
}

enum class Letters { as_they_are, as_they_look };  // those of Greek and Cyrillic

// Without marks that are not seen. The text is UTF-8.
std::string seen_characters(const char* text, Letters letters) {
  std::string seen;
  for (const char* next = text; *text != '\0'; text = next) {
    next = g_utf8_next_char(text);
    const std::string_view bytes{text, static_cast<std::size_t>(next - text)};
    const auto character = static_cast<UChar32>(g_utf8_get_char(text));
    if (u_hasBinaryProperty(character, UCHAR_DEFAULT_IGNORABLE_CODE_POINT) == 0) {
      const bool is_replaced = letters == Letters::as_they_look && is_greek_or_cyrillic(character);
      seen += is_replaced ? look_of(bytes) : std::string{bytes};
    }
  }
  return seen;
}

std::string with_single_spaces(std::string_view text) {
  std::string read;
  for (const char c : text) {
    const bool is_space = c == ' ' || c == '\t' || c == '\n' || c == '\r';
    if (!is_space || (!read.empty() && read.back() != ' ')) {
      read += is_space ? ' ' : c;
    }
  }
  read.erase(read.find_last_not_of(' ') + 1);
  return read;
}

// "P01" and "P1", "2.0" and "2"; not of decimals (1.05).
std::string without_idle_zeros(const std::string& text) {
  static const std::regex leading{"(^|[^0-9.])0+(?=[0-9])"};
  static const std::regex decimals{"^([0-9]+)\\.0+$"};
  return std::regex_replace(std::regex_replace(text, leading, "$1"), decimals, "$1");
}

std::string read_as(const std::string& name, Letters letters) {
  const Text normal{g_utf8_normalize(name.data(), size_of(name), G_NORMALIZE_ALL_COMPOSE)};
  if (!normal) {
    return name;  // no UTF-8
  }
  const Text folded{g_utf8_casefold(seen_characters(normal.get(), letters).c_str(), -1)};
  const Text composed{g_utf8_normalize(folded.get(), -1, G_NORMALIZE_ALL_COMPOSE)};
  std::string read{composed.get()};
  plain_characters(read);
  return without_idle_zeros(with_single_spaces(read));
}
}  // namespace

std::string as_read(const std::string& name) {
  return read_as(name, Letters::as_they_are);
}

const std::string& Spellings::first_like(const std::string& name) {
  const std::array readings{as_read(name), read_as(name, Letters::as_they_look)};
  std::string first = name;
  for (const std::string& reading : readings) {
    const auto known = first_.find(reading);
    first = known == first_.end() ? first : known->second;
  }
  for (const std::string& reading : readings) {
    first_.try_emplace(reading, first);
  }
  return first_.at(readings.front());
}

std::optional<std::pair<std::string, std::string>> first_alike(
    const std::vector<std::string>& names) {
  Spellings spellings;
  for (const std::string& name : names) {
    if (const std::string& first = spellings.first_like(name); first != name) {
      return std::pair{first, name};
    }
  }
  return std::nullopt;
}
}  // namespace tapstudy::analysis
