#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "protocols/yaml/key.hpp"
namespace tapstudy::protocols {
using SchemaJson = nlohmann::ordered_json;

struct KnownMapping;
// By the path of their keys. A mapping whose pass with the usual answers is as that of a known one
// is taken to be like it with all other answers: the same code reads it.
using KnownMappings = std::map<std::string, std::vector<KnownMapping>>;

// One pass of the code that reads a mapping, without a file: which keys it asks for, and every
// question on whose answer it may depend. Answers that are not chosen beforehand are the usual
// ones: a key is not given, a value is its default or the first of those allowed.
class Description {
 public:
  struct Question {
    enum class Kind { given, value, hidden };  // hidden: not answered by this mapping
    Kind kind{};
    std::string key;
    std::vector<SchemaJson> answers;
    std::size_t usual{};
    bool operator==(const Question& other) const = default;
  };
  struct Property {
    std::string name;
    SchemaJson schema;
    bool is_required{};
    bool operator==(const Property& other) const = default;
  };
  using Answers = std::map<std::string, std::size_t>;  // by name_of(question)

  Description(Answers chosen, KnownMappings& known) : chosen_{std::move(chosen)}, known_{&known} {}
  static std::string name_of(const Question& question);
  // The answer in this pass, an index.
  std::size_t ask(Question question);
  // Of one key the first description is kept.
  void add(const Key& key, SchemaJson value, bool is_required, const SchemaJson& otherwise = {});
  // In this pass the key is not allowed.
  void remove(const std::string& key);
  // The key, which was described in this pass, allows no more than this in it.
  void narrow(const std::string& key, const SchemaJson& members);
  // How many of the keys are given: "anyOf" or "oneOf".
  void choose(const std::string& how_many, const std::vector<std::string>& keys);

  const std::vector<Question>& asked() const { return asked_; }
  const std::vector<Property>& properties() const { return properties_; }
  const Property* find(const std::string& key) const;
  const SchemaJson& choices() const { return choices_; }
  KnownMappings& known_mappings() const { return *known_; }

 private:
  Answers chosen_;
  KnownMappings* known_;
  std::vector<Question> asked_;
  std::vector<Property> properties_;
  SchemaJson choices_ = SchemaJson::object();
};

struct KnownMapping {
  std::vector<Description::Question> asked;
  std::vector<Description::Property> properties;
  SchemaJson schema;
};

// The JSON schema of a mapping. The code that reads it is run once with the usual answers, and once
// more with each other answer to each question: where it asks for other keys then, or allows other
// values, the schema says so under that condition.
SchemaJson described_mapping(const std::string& path, KnownMappings& known,
                             const std::function<void(Description&)>& pass);
}  // namespace tapstudy::protocols
