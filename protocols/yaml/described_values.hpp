#pragma once
// What a JSON schema says of the values that a MapReader reads.
#include <optional>
#include <string>
#include <vector>

#include "protocols/yaml/description.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
SchemaJson described(const Range& range);
SchemaJson described_integer(int low, int high);
SchemaJson described_text(TextLines lines, TextLanguages languages);
SchemaJson described_name();
// Without a file there are no names of other sections, or nameless ones (and "." of a body's
// point): then any name.
SchemaJson described_words(const std::vector<std::string>& allowed);
SchemaJson described_named(SchemaJson value, std::size_t least);
SchemaJson described_empty(bool is_optional);
SchemaJson described_empty_list(bool is_optional);
// A mapping that may also be given as a list of the values of these keys.
void make_list_too(SchemaJson& mapping, const std::vector<std::string>& keys);
// In whose place this word may stand.
void make_word_too(SchemaJson& mapping, const std::string& word);

template <class Value>
SchemaJson described_default(const std::optional<Value>& otherwise) {
  return otherwise ? SchemaJson(*otherwise) : SchemaJson{};
}

// The word of this pass.
std::string described_word(Description& pass, const Key& key,
                           const std::vector<std::string>& allowed,
                           const std::optional<std::string>& otherwise);
// How far above `low` the integer of this pass is: with few values, what is read may depend on it.
std::size_t chosen_integer(Description& pass, const std::string& key, int low, int high,
                           const std::optional<int>& otherwise);
}  // namespace tapstudy::protocols
