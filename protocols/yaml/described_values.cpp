#include "protocols/yaml/described_values.hpp"

#include <algorithm>
#include <cctype>
namespace tapstudy::protocols {
namespace {
constexpr double no_end = 1e30;
constexpr const char* printable_line = "^(?=.*\\S)[^\\u0000-\\u001f\\u007f]+$";
constexpr const char* free_name = "^(?!NA$)[A-Za-z0-9_][A-Za-z0-9_.+-]{0,63}$";
constexpr int few = 3;
}  // namespace

SchemaJson described(const Range& range) {
  SchemaJson schema{{"type", "number"}};
  if (range.low > -no_end) {
    schema[range.low_included ? "minimum" : "exclusiveMinimum"] = range.low;
  }
  if (range.high < no_end) {
    schema[range.high_included ? "maximum" : "exclusiveMaximum"] = range.high;
  }
  return schema;
}

SchemaJson described_integer(int low, int high) {
  return {{"type", "integer"}, {"minimum", low}, {"maximum", high}};
}

SchemaJson described_text(TextLines lines, TextLanguages languages) {
  SchemaJson text{{"type", "string"}};
  if (lines == TextLines::one) {
    text["minLength"] = 1;
    text["pattern"] = printable_line;
  }
  if (languages == TextLanguages::several) {
    const SchemaJson one = text;
    text["type"] = {"string", "object"};
    text["minProperties"] = 1;
    text["patternProperties"] = {{"^[a-z]{2}$", one}};
    text["additionalProperties"] = false;
  }
  return text;
}

// YAML takes names such as 1 and yes for other types.
SchemaJson described_name() {
  return {{"type", {"string", "number", "boolean"}}, {"pattern", free_name}};
}

SchemaJson described_words(const std::vector<std::string>& allowed) {
  const auto is_letter = [](unsigned char c) { return std::isalnum(c) != 0; };
  const bool are_names = allowed.empty() || std::ranges::none_of(allowed.front(), is_letter);
  if (are_names) {
    return {{"type", {"string", "number", "boolean"}}};
  }
  return allowed.size() == 1 ? SchemaJson{{"const", allowed.front()}}
                             : SchemaJson{{"enum", allowed}};
}

SchemaJson described_named(SchemaJson value, std::size_t least) {
  SchemaJson schema{{"type", "object"},
                    {"propertyNames", {{"pattern", free_name}}},
                    {"additionalProperties", std::move(value)}};
  if (least > 0) {
    schema["minProperties"] = least;
  }
  return schema;
}

SchemaJson described_empty(bool is_optional) {
  return is_optional ? SchemaJson::object() : SchemaJson{};
}
SchemaJson described_empty_list(bool is_optional) {
  return is_optional ? SchemaJson::array() : SchemaJson{};
}

void make_list_too(SchemaJson& mapping, const std::vector<std::string>& keys) {
  mapping["type"] = {"object", "array"};
  mapping["minItems"] = keys.size() - 1;
  mapping["items"] = false;
  for (const std::string& key : keys) {
    mapping["prefixItems"].push_back(mapping["properties"][key]);
  }
}

void make_word_too(SchemaJson& mapping, const std::string& word) {
  mapping["type"] = {"object", "string"};
  mapping["pattern"] = "^" + word + "$";
}

std::string described_word(Description& pass, const Key& key,
                           const std::vector<std::string>& allowed,
                           const std::optional<std::string>& otherwise) {
  SchemaJson schema = described_words(allowed);
  const bool is_known = schema.contains("enum") || schema.contains("const");
  pass.add(key, std::move(schema), !otherwise, described_default(otherwise));
  if (!is_known) {
    return "";
  }
  const auto usual = std::ranges::find(allowed, otherwise.value_or(allowed.front()));
  Description::Question question{Description::Question::Kind::value, key.name, {}, 0};
  question.answers.assign(allowed.begin(), allowed.end());
  question.usual = usual == allowed.end() ? 0 : static_cast<std::size_t>(usual - allowed.begin());
  return allowed[pass.ask(std::move(question))];
}

std::size_t chosen_integer(Description& pass, const std::string& key, int low, int high,
                           const std::optional<int>& otherwise) {
  const auto usual = static_cast<std::size_t>(otherwise.value_or(low) - low);
  if (high - low >= few) {
    return usual;
  }
  Description::Question question{Description::Question::Kind::value, key, {}, usual};
  for (int value = low; value <= high; ++value) {
    question.answers.push_back(value);
  }
  return pass.ask(std::move(question));
}
}  // namespace tapstudy::protocols
