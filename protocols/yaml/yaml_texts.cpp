// Texts, in one language or in several.
#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "core/text/plain_text.hpp"
#include "protocols/yaml/described_values.hpp"
#include "protocols/yaml/problems.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
bool is_language(const std::string& text) {
  const auto is_small_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return text.size() == 2 && std::ranges::all_of(text, is_small_letter);
}

std::set<std::string> languages_of(const Translations& translations) {
  std::set<std::string> all;
  for (const auto& [path, languages] : translations.given) {
    all.insert(languages.begin(), languages.end());
  }
  return all;
}

std::vector<std::string> texts_without(const std::string& language,
                                       const Translations& translations) {
  std::vector<std::string> paths;
  for (const auto& [path, languages] : translations.given) {
    if (!languages.empty() && std::ranges::find(languages, language) == languages.end()) {
      paths.push_back(path);
    }
  }
  return paths;
}

void MapReader::leave_out_of_data(const std::string& key) {
  if (translations_ != nullptr) {
    translations_->texts[path_of(key)] = InData::nothing;
  }
}

std::string MapReader::text_at(const YAML::Node& node, const std::string& path, TextLines lines) {
  const bool is_text = node.IsScalar() && core::is_plain_text(node.Scalar());
  const bool is_line = is_text && !node.Scalar().empty() &&
                       node.Scalar().find_first_of("\n\r\t") == std::string::npos;
  if (lines == TextLines::one ? !is_line : !is_text) {
    reject_at(node, path,
              fmt::format("{} is not {}", kind_of(node),
                          lines == TextLines::one ? "one line of text" : "text"));
    return "";
  }
  if (lines == TextLines::one && as_it_reads(node.Scalar()).empty()) {
    reject_at(node, path, fmt::format("{} holds nothing but blanks", kind_of(node)));
  }
  return node.Scalar();
}

std::string MapReader::any_text(const Key& key, const std::optional<std::string>& otherwise,
                                TextLines lines, TextLanguages languages) {
  if (pass_ != nullptr) {
    pass_->add(key, described_text(lines, languages), !otherwise, described_default(otherwise));
    return otherwise.value_or("");
  }
  const auto node = find(key.name, !otherwise);
  if (!node) {
    return otherwise.value_or("");
  }
  if (lines == TextLines::several && languages == TextLanguages::one && translations_ != nullptr) {
    leave_out_of_data(key.name);
  }
  return languages == TextLanguages::one ? text_at(*node, path_of(key.name), lines)
                                         : translation_at(*node, path_of(key.name), lines);
}

std::string MapReader::text(const Key& key, const std::optional<std::string>& otherwise) {
  return any_text(key, otherwise, TextLines::one, TextLanguages::one);
}

std::string MapReader::paragraphs(const Key& key, const std::optional<std::string>& otherwise) {
  return any_text(key, otherwise, TextLines::several, TextLanguages::one);
}

std::string MapReader::translated(const Key& key, const std::optional<std::string>& otherwise) {
  return any_text(key, otherwise, TextLines::one, TextLanguages::several);
}

std::string MapReader::translated_paragraphs(const Key& key,
                                             const std::optional<std::string>& otherwise) {
  return any_text(key, otherwise, TextLines::several, TextLanguages::several);
}

std::vector<std::pair<std::string, std::string>> MapReader::languages_at(const YAML::Node& node,
                                                                         const std::string& path,
                                                                         TextLines lines) {
  if (!node.IsMap()) {
    return {{"", text_at(node, path, lines)}};
  }
  std::vector<std::pair<std::string, std::string>> texts;
  for (const auto& entry : node) {
    const std::string language = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (!is_language(language)) {
      reject_at(entry.first, path,
                fmt::format("{} is not a language (two small letters, such as en)",
                            kind_of(entry.first)));
    } else if (std::ranges::find(texts, language, &decltype(texts)::value_type::first) !=
               texts.end()) {
      reject_at(entry.first, path, fmt::format("'{}' is there twice", language));
    } else {
      texts.emplace_back(language, text_at(entry.second, path + "." + language, lines));
    }
  }
  if (texts.empty()) {
    reject_at(node, path, "has a text in no language");
    texts.emplace_back("", "");
  }
  return texts;
}

std::string MapReader::translation_at(const YAML::Node& node, const std::string& path,
                                      TextLines lines) {
  const auto texts = languages_at(node, path, lines);
  if (translations_ == nullptr) {
    return texts.front().second;
  }
  translations_->texts[path] = InData::nothing;
  std::vector<std::string>& given = translations_->given[path];
  for (const auto& [language, text] : texts) {
    if (!language.empty()) {
      given.push_back(language);
    }
  }
  const auto wanted =
      std::ranges::find(texts, translations_->language, &decltype(texts)::value_type::first);
  return (wanted == texts.end() ? texts.front() : *wanted).second;
}

void MapReader::is_in_data(const std::string& key) {
  if (pass_ == nullptr && translations_ != nullptr && has(key)) {
    translations_->texts[path_of(key)] = InData::presence;
  }
}

std::string MapReader::language_among(const std::string& key,
                                      const std::vector<std::string>& given) {
  if (translations_ == nullptr) {
    return given.front();
  }
  translations_->given[path_of(key)] = given;
  const auto wanted = std::ranges::find(given, translations_->language);
  return wanted == given.end() ? given.front() : *wanted;
}

std::vector<std::pair<std::string, std::string>> MapReader::translated_list(const Key& key) {
  std::vector<std::pair<std::string, std::string>> all;
  if (pass_ != nullptr) {
    pass_->add(key,
               {{"type", "array"},
                {"items", described_text(TextLines::one, TextLanguages::several)},
                {"minItems", 1},
                {"uniqueItems", true}},
               true);
    return all;
  }
  const auto node = find(key.name, true);
  if (node && (!node->IsSequence() || node->size() == 0)) {
    reject_at(*node, path_of(key.name), "is not a list of texts");
    return all;
  }
  for (std::size_t i = 0; node && i < node->size(); ++i) {
    const YAML::Node item = (*node)[i];
    const std::string path = fmt::format("{}[{}]", path_of(key.name), i);
    const std::string name = languages_at(item, path, TextLines::one).front().second;
    if (std::ranges::find(all, name, &decltype(all)::value_type::first) != all.end()) {
      reject_at(item, path, fmt::format("'{}' is listed twice", name));
    } else {
      all.emplace_back(name, translation_at(item, path, TextLines::one));
      if (translations_ != nullptr) {
        translations_->texts[path] = InData::first_text;
      }
    }
  }
  return all;
}

void MapReader::each_translated(
    const Key& key, Presence presence,
    const std::function<void(const std::string&, const std::string&)>& take) {
  if (pass_ != nullptr) {
    pass_->add(key, described_named(described_text(TextLines::one, TextLanguages::several), 1),
               presence != Presence::optional, described_empty(presence == Presence::optional));
    return;
  }
  each_named(key, presence, [&](MapReader& texts, const std::string& name) {
    take(name, texts.translated(Key{name}));
  });
}
}  // namespace tapstudy::protocols
