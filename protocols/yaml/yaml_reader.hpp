#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocols/yaml/key.hpp"
#include "protocols/yaml/problems.hpp"
namespace tapstudy::protocols {
// What of a text for people is in the data: nothing; which text it is in the first language, by
// which it is stored; that there is one, which allows an answer.
enum class InData { nothing, first_text, presence };

// Texts for participants, which a file may give in several languages: {en: Which plate?, ja: …}.
// Languages are two letters (ISO 639-1).
struct Translations {
  std::string language{};  // that is wanted; where a text lacks it, the first that is given
  // By key path, of every text that was read; empty where it is given once for all languages.
  std::map<std::string, std::vector<std::string>> given{};
  // By key path, of every text for people that the file has, and of plans: what of it is in the
  // data, too.
  std::map<std::string, InData> texts{};
  // How the file was read, which its text alone does not say; by key path and place in the text.
  using Place = std::pair<std::string, int>;
  std::map<Place, std::string> values{};  // numbers and truth values, however they are written
  // Mappings in which no order is read; of a list in place of one, what the keys would be.
  std::map<Place, std::vector<std::string>> keys{};
};
// The key paths of those that are given in some languages, but not in this one.
std::vector<std::string> texts_without(const std::string& language,
                                       const Translations& translations);
// All languages that a text is given in.
std::set<std::string> languages_of(const Translations& translations);
bool is_language(const std::string& text);
// The same for texts that people read as one: blanks collapsed, as a page does, what is not seen
// left out, and Latin capitals small. The text is UTF-8.
std::string as_it_reads(const std::string& text);
enum class TextLines { one, several };
enum class TextLanguages { one, several };
}  // namespace tapstudy::protocols

namespace YAML {  // NOLINT(readability-identifier-naming): the library's own name
class Node;
}
namespace tapstudy::protocols {
// Allowed numbers: from low to high, the ends included or not.
struct Range {
  double low{};
  double high{};
  bool low_included{true};
  bool high_included{true};
  bool contains(double x) const;
  std::string words() const;

  static Range positive(double high = 1e30) { return {0.0, high, false, true}; }
};
class Description;

// 1 to 64 letters, digits, '_', '-', '+' or '.', not starting with '-', '+' or '.'.
bool is_name(const std::string& text);

// One mapping of a YAML file, read key by key. Errors are added to Problems, and a safe default is
// returned so that reading can continue; finish() reports unknown keys.
// A key read with a default is optional; one without is required.
class MapReader {
 public:
  // The whole file. Throws InvalidInput if it cannot be read or is not YAML.
  static MapReader whole_file(const std::string& text, const std::string& file, Problems& problems,
                              Translations* translations = nullptr);
  // The same, but only the first of the documents in it is read.
  static MapReader first_document(const std::string& text, const std::string& file,
                                  Problems& problems, Translations* translations = nullptr);
  // The JSON schema of what a reader reads, made by running it without a file.
  static std::string schema_of(const std::string& title, const std::string& about,
                               const std::function<void(MapReader&)>& read);
  ~MapReader();
  MapReader(MapReader&& other) noexcept;
  MapReader(const MapReader& other) = delete;
  MapReader& operator=(const MapReader& other) = delete;
  MapReader& operator=(MapReader&& other) = delete;

  enum class Presence { required, at_least_one, optional };  // at_least_one: of a list
  bool has(const std::string& key);
  // How many of these are given; at least one, or exactly one, has to be.
  int count_given(const std::vector<std::string>& keys, Presence presence);
  // The condition, which other sections decide: a schema allows either. Where it is false, unknown
  // keys may be what is wrong in another section.
  bool depends_on_others(bool condition);
  // A range as it is without a file, and as it is with the other keys of this one.
  Range narrowed(const Range& stated, const Range& here) const;
  // The key is left as it is: what it depends on was rejected.
  void leave(const std::string& key) { known_.push_back(key); }
  // Nothing of the key's value is in the data: as after a text for people, a study goes on with
  // another.
  void leave_out_of_data(const std::string& key);
  // Rejects the key if it is given: it is not for what the other keys say.
  void refuse(const std::string& key, const std::string& what);
  // The same of keys that say another way what the chosen one says; of several given, the first.
  void refuse_beside(const std::string& chosen, const std::vector<std::string>& others);
  // Rejects a key of an earlier version, by the name of the one that says it now.
  void refuse_former(const std::string& key, const std::string& now);
  // Rejects the key's value if it is not right; `schema` says the same in JSON schema's members.
  void check(const std::string& key, bool is_right, const std::string& schema,
             const std::string& what);
  // Rejects a list of names that has fewer or more.
  void check_count(const std::string& key, const std::vector<std::string>& names, std::size_t least,
                   std::size_t most, const std::string& what);
  // The key `format`, which says this.
  void check_format(const std::string& version);
  double number(const Key& key, const Range& range, std::optional<double> otherwise = {});
  int integer(const Key& key, int low, int high, std::optional<int> otherwise = {});
  bool yes_or_no(const Key& key, std::optional<bool> otherwise = {});
  // Any text on one line; paragraphs may have several.
  std::string text(const Key& key, const std::optional<std::string>& otherwise = {});
  std::string paragraphs(const Key& key, const std::optional<std::string>& otherwise = {});
  // The same of what participants read: a text, or one for each language.
  std::string translated(const Key& key, const std::optional<std::string>& otherwise = {});
  std::string translated_paragraphs(const Key& key,
                                    const std::optional<std::string>& otherwise = {});
  // A list of such texts, each once: its name in the data, which is the first text, and its label.
  std::vector<std::pair<std::string, std::string>> translated_list(const Key& key);
  // A mapping from free names to such texts.
  void each_translated(const Key& key, Presence presence,
                       const std::function<void(const std::string&, const std::string&)>& take);
  // That the text is given at all is a matter of the data.
  void is_in_data(const std::string& key);
  // Of a text that this key stands for: the wanted language if it is given, else the first.
  std::string language_among(const std::string& key, const std::vector<std::string>& given);
  // A name that is valid in data, tables and file names: see is_name.
  std::string name(const Key& key);
  // `size` numbers in brackets.
  Eigen::VectorXd numbers(const Key& key, Eigen::Index size, const Range& range);
  // As many as there are, at least one.
  std::vector<double> number_list(const Key& key, const Range& range);
  // One of the given words; kind names what they are.
  std::string word(const Key& key, const std::string& kind, const std::vector<std::string>& allowed,
                   const std::optional<std::string>& otherwise = {});
  std::vector<std::string> words(const Key& key, const std::string& kind,
                                 const std::vector<std::string>& allowed,
                                 const std::optional<std::vector<std::string>>& otherwise = {});
  template <class Value>
  Value one_of(const Key& key, const std::vector<std::pair<std::string, Value>>& table,
               const std::optional<std::string>& otherwise = {}) {
    std::vector<std::string> allowed;
    for (const auto& [name, value] : table) {
      allowed.push_back(name);
    }
    const std::string chosen = word(key, "value", allowed, otherwise);
    for (const auto& [name, value] : table) {
      if (name == chosen) {
        return value;
      }
    }
    return table.front().second;
  }
  // Of an enumeration whose names stand in its order.
  template <class Enumeration, std::size_t Size>
  Enumeration one_of(const Key& key, const std::array<std::string_view, Size>& names,
                     const std::optional<std::string>& otherwise = {}) {
    const std::string chosen = word(key, "value", {names.begin(), names.end()}, otherwise);
    const auto at = std::ranges::find(names, chosen);
    return static_cast<Enumeration>(at == names.end() ? 0 : at - names.begin());
  }
  using ReadMap = std::function<void(MapReader&)>;
  using ReadNamed = std::function<void(const std::string& name, MapReader&)>;
  void map(const Key& key, Presence presence, const ReadMap& read);
  // The same, also written as a list: the values of these keys in their order, the last of which
  // may be left out.
  void map_or_list(const Key& key, Presence presence, const std::vector<std::string>& keys,
                   const ReadMap& read);
  // The same, or in its place one word.
  void map_or_word(const Key& key, Presence presence, const std::string& word,
                   const std::function<void()>& take, const ReadMap& read);
  // A mapping from free names to mappings / to two numbers / to text; a list of mappings.
  void each(const Key& key, Presence presence, const ReadNamed& read);
  void each_point(const Key& key, Presence presence,
                  const std::function<void(const std::string&, const Eigen::Vector2d&)>& take);
  void each_text(const Key& key, Presence presence,
                 const std::function<void(const std::string&, const std::string&)>& take);
  // A mapping from free names to lists of words, each of which `read` reads by its name.
  void each_list(const Key& key, Presence presence,
                 const std::function<void(MapReader& inner, const std::string& name)>& read);
  void list(const Key& key, Presence presence, const ReadMap& read);

  // "file:line:column: key.path" of this mapping, or of one of its keys.
  std::string stated_at() const;
  std::string stated_at(const std::string& key) const;
  // A problem with this mapping as a whole, or with one of its keys, found by looking at values
  // that were read: not told where any of the mapping's could not be.
  void reject(const std::string& what);
  void reject(const std::string& key, const std::string& what);
  std::size_t problems_in_file() const { return problems_->count(); }  // so far
  void finish();

 private:
  enum class Shape { mapping, named, list };
  // Without a file: what the inner reader asks for.
  void describe_inner(const Key& key, Presence presence, Shape shape, const ReadMap& read,
                      const std::vector<std::string>& as_list = {}, const std::string& word = {});
  MapReader(const YAML::Node& node, std::string path, std::string pattern, Problems& problems,
            Translations* translations);
  std::string any_text(const Key& key, const std::optional<std::string>& otherwise, TextLines lines,
                       TextLanguages languages);
  std::string text_at(const YAML::Node& node, const std::string& path, TextLines lines);
  // By language; a text that is one for all languages has none.
  std::vector<std::pair<std::string, std::string>> languages_at(const YAML::Node& node,
                                                                const std::string& path,
                                                                TextLines lines);
  std::string translation_at(const YAML::Node& node, const std::string& path, TextLines lines);
  // The value under the key, or nothing after noting that it is missing.
  std::optional<YAML::Node> find(const std::string& key, bool required);
  std::string path_of(const std::string& key) const;
  std::string pattern_of(const std::string& key) const;
  void reject_at(const YAML::Node& node, const std::string& path, const std::string& what,
                 const std::optional<std::string>& may_follow = {});
  void reject_decimal_commas();
  void reject_unknown(const YAML::Node& node, const std::string& key);
  const YAML::Node& written() const { return list_ ? *list_ : *node_; }
  std::optional<double> as_number(const YAML::Node& node, const std::string& path,
                                  const Range& range);
  void note_value(const YAML::Node& node, const std::string& path, const std::string& value);
  void read_inner(const YAML::Node& node, const std::string& path, const std::string& pattern,
                  const ReadMap& read);
  // Each key of a mapping from free names, in the file's order.
  void each_named(const Key& key, Presence presence,
                  const std::function<void(MapReader& inner, const std::string& name)>& read);
  std::optional<YAML::Node> find_map(const std::string& key, Presence presence);
  bool check_name(const YAML::Node& node, const std::string& path);
  bool is_allowed(const YAML::Node& node, const std::string& path, const std::string& kind,
                  const std::vector<std::string>& allowed);

  std::unique_ptr<YAML::Node> node_;
  std::unique_ptr<YAML::Node> list_;  // of which node_ was made; else nullptr
  std::string path_;
  std::string pattern_;
  std::set<std::string> decimals_;  // behind a comma, which makes them keys
  bool has_free_names_{false};
  bool is_choice_unread_{false};  // a word that may decide which keys there are
  bool depends_on_others_{false};
  std::vector<std::string> known_;
  std::vector<std::string> looked_for_;  // by `has`: keys that may be given, read or not
  Problems* problems_;
  Translations* translations_;  // nullptr: one language is all that is read
  Description* pass_{nullptr};  // nullptr: a file is read
};
}  // namespace tapstudy::protocols
