#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>
namespace YAML {  // NOLINT(readability-identifier-naming): the library's own name
class Node;
}
namespace tapstudy::protocols {
// Text from a file made safe to quote in a message: short, without terminal control characters.
std::string printable(const std::string& text);
// A value as described in messages: 'text', a list, a mapping, nothing.
std::string kind_of(const YAML::Node& node);

inline constexpr const char* key_is_missing = "is missing";
inline constexpr const char* merges_are_not_read =
    "merges of mappings (<<) are not read: the keys are written out, or `*name` stands for a whole "
    "value";

// Collects all problems of one file, so that they are reported together; and every key that was
// looked up, so that the schema can be checked against the reader.
class Problems {
 public:
  explicit Problems(std::string file) : file_{std::move(file)} {}
  // The text of the file, so that columns can be told in characters.
  void read_from(const std::string& text);
  // line and column count from 0, the column in bytes, as the parser has it. Of one key the first
  // problem is kept: others follow from it. One that `may_follow` from what cannot be read at or
  // below that path (empty: anywhere) is told only where all of that can be read.
  void add(int line, int column, const std::string& key_path, const std::string& what,
           const std::optional<std::string>& may_follow = {});
  // The key is there, misspelt: it is not missing as well. False: nobody said that it was.
  bool withdraw_missing(const std::string& key_path);
  std::size_t count() const { return problems_.size() + unread_; }
  // A value that is described but not read counts as a problem: nothing can be made of it.
  void add_unread() { ++unread_; }
  // "file:line:column: key.path", both from 1, the column in characters
  std::string place(int line, int column, const std::string& key_path) const;
  // Throws InvalidInput if there are any, one line per problem, `file:line:column: key.path: what`,
  // in the order of the file.
  void throw_if_any() const;

  void asked_for(std::string key_path) { asked_.insert(std::move(key_path)); }
  // `*` stands for any name, `[]` for any place in a list.
  const std::set<std::string>& asked() const { return asked_; }

 private:
  struct Problem {
    int line;
    int column;
    std::string key_path;
    std::string what;
    std::optional<std::string> may_follow;
  };
  bool follows(const Problem& problem) const;

  std::string file_;
  std::vector<std::string> lines_;  // of the text
  std::vector<Problem> problems_;
  std::size_t unread_{0};
  std::set<std::string> places_;  // of these
  std::set<std::string> asked_;
};

// ", did you mean 'x'?" for the closest of the allowed words, or nothing if none is close.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& allowed);
}  // namespace tapstudy::protocols
