#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>
namespace tapstudy::protocols {
// Texts for participants, which a file may give in several languages: {en: Which plate?, ja: …}.
// Languages are two letters (ISO 639-1).
struct Translations {
  std::string language{};  // that is wanted; where a text lacks it, the first that is given
  // By key path, of every text that was read; empty where it is given once for all languages.
  std::map<std::string, std::vector<std::string>> given{};
};
// The key paths of those that are given in some languages, but not in this one.
std::vector<std::string> texts_without(const std::string& language,
                                       const Translations& translations);
// All languages that a text is given in.
std::set<std::string> languages_of(const Translations& translations);
bool is_language(const std::string& text);
}  // namespace tapstudy::protocols
