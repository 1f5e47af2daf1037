#include "protocols/yaml/description.hpp"

#include <algorithm>
#include <memory>
#include <optional>
namespace tapstudy::protocols {
std::string Description::name_of(const Question& question) {
  return std::to_string(static_cast<int>(question.kind)) + question.key;
}

std::size_t Description::ask(Question question) {
  const std::string name = name_of(question);
  const auto chosen = chosen_.find(name);
  const std::size_t answer = chosen == chosen_.end() ? question.usual : chosen->second;
  const auto is_this = [&](const Question& other) { return name_of(other) == name; };
  if (std::ranges::none_of(asked_, is_this)) {
    asked_.push_back(std::move(question));
  }
  return answer;
}

const Description::Property* Description::find(const std::string& key) const {
  const auto found = std::ranges::find(properties_, key, &Property::name);
  return found == properties_.end() ? nullptr : &*found;
}

void Description::add(const Key& key, SchemaJson value, bool is_required,
                      const SchemaJson& otherwise) {
  if (find(key.name) != nullptr) {
    return;
  }
  value["description"] = key.meaning;
  if (!otherwise.is_null() && key.meaning.find("unset: ") == std::string::npos) {
    value["default"] = otherwise;
  }
  if (!key.example.empty()) {
    value["examples"] = {key.example};
  }
  properties_.push_back({key.name, std::move(value), is_required});
}

void Description::remove(const std::string& key) {
  std::erase_if(properties_, [&](const Property& property) { return property.name == key; });
}

void Description::narrow(const std::string& key, const SchemaJson& members) {
  const auto found = std::ranges::find(properties_, key, &Property::name);
  if (found != properties_.end()) {
    found->schema.update(members);
  }
}

void Description::choose(const std::string& how_many, const std::vector<std::string>& keys) {
  SchemaJson& choice = choices_[how_many] = SchemaJson::array();
  for (const std::string& key : keys) {
    choice.push_back({{"required", {key}}});
    for (Property& property : properties_) {
      if (property.name == key) {
        property.schema.erase("default");
      }
    }
  }
}

namespace {
// A pass, and those that differ from it by one answer each.
struct Branch;
struct Node {
  Description pass;
  std::vector<Branch> branches;
};
struct Branch {
  std::size_t question{};  // of the pass before
  std::size_t answer{};
  std::unique_ptr<Node> node;
};

std::set<std::string> names_of(const std::vector<Description::Question>& questions) {
  std::set<std::string> names;
  std::ranges::transform(questions, std::inserter(names, names.end()), Description::name_of);
  return names;
}

Node explored(const std::function<void(Description&)>& read, const Description& usual,
              const Description::Answers& chosen, std::set<std::string> answered) {
  Node node{usual, {}};
  const std::vector<Description::Question>& asked = node.pass.asked();
  const std::set<std::string> before = answered;
  answered.merge(names_of(asked));
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const std::string name = Description::name_of(asked[i]);
    for (std::size_t answer = 0; answer < asked[i].answers.size(); ++answer) {
      if (!before.contains(name) && answer != asked[i].usual) {
        Description::Answers other = chosen;
        other[name] = answer;
        Description pass{other, node.pass.known_mappings()};
        read(pass);
        node.branches.push_back(
            {i, answer, std::make_unique<Node>(explored(read, pass, other, answered))});
      }
    }
  }
  return node;
}

void visit(const Node& node, const std::function<void(const Description&)>& take) {
  take(node.pass);
  for (const Branch& branch : node.branches) {
    visit(*branch.node, take);
  }
}

// Leaves the end of a range that allows more: the lower of two low ends, the higher of two high
// ones, and none if one of the ranges is open there.
void merge_end(SchemaJson& into, const SchemaJson& other, const char* open, const char* closed,
               bool is_low) {
  const auto end = [&](const SchemaJson& schema) -> std::optional<std::pair<double, bool>> {
    if (schema.contains(closed)) {
      return std::pair{schema[closed].get<double>(), true};
    }
    return schema.contains(open) ? std::optional{std::pair{schema[open].get<double>(), false}}
                                 : std::nullopt;
  };
  const auto one = end(into);
  const auto two = end(other);
  into.erase(open);
  into.erase(closed);
  if (!one || !two) {
    return;
  }
  const bool is_second = is_low ? two->first < one->first : two->first > one->first;
  const auto chosen = one->first == two->first ? std::pair{one->first, one->second || two->second}
                                               : (is_second ? *two : *one);
  into[chosen.second ? closed : open] = chosen.first;
}

void merge_count(SchemaJson& into, const SchemaJson& other, const char* name, bool is_least) {
  if (!into.contains(name) || !other.contains(name)) {
    into.erase(name);
    return;
  }
  const auto one = into[name].get<std::size_t>();
  const auto two = other[name].get<std::size_t>();
  into[name] = is_least ? std::min(one, two) : std::max(one, two);
}

SchemaJson common(const SchemaJson& one, const SchemaJson& two) {
  SchemaJson both = SchemaJson::array();
  std::ranges::copy_if(one, std::back_inserter(both), [&](const SchemaJson& item) {
    return std::ranges::find(two, item) != two.end();
  });
  return both;
}

SchemaJson common_properties(const SchemaJson& one, const SchemaJson& two) {
  SchemaJson both = SchemaJson::object();
  for (const auto& [key, schema] : one.items()) {
    if (two.contains(key) && two[key] == schema) {
      both[key] = schema;
    }
  }
  return both;
}

// Of what follows from one condition in each, what follows in both.
SchemaJson common_demands(const SchemaJson& one, const SchemaJson& two) {
  SchemaJson both = SchemaJson::object();
  for (const auto& [name, demanded] : one.items()) {
    SchemaJson shared;
    if (name == "required" && two.contains(name)) {
      shared = common(demanded, two[name]);
    } else if (name == "properties" && two.contains(name)) {
      shared = common_properties(demanded, two[name]);
    }
    if (!shared.empty()) {
      both[name] = std::move(shared);
    }
  }
  return both;
}

// The rules of both, under one condition each.
SchemaJson common_rules(const SchemaJson& one, const SchemaJson& two) {
  SchemaJson rules = SchemaJson::array();
  for (const SchemaJson& rule : one) {
    const auto same = std::ranges::find_if(
        two, [&](const SchemaJson& other) { return other["if"] == rule["if"]; });
    if (same == two.end()) {
      continue;
    }
    if (SchemaJson then = common_demands(rule["then"], (*same)["then"]); !then.empty()) {
      rules.push_back({{"if", rule["if"]}, {"then", std::move(then)}});
    }
  }
  return rules;
}

SchemaJson merged(const SchemaJson& one, const SchemaJson& two);

void merge_properties(SchemaJson& into, const SchemaJson& other) {
  for (const auto& [name, schema] : other.items()) {
    into[name] = into.contains(name) ? merged(into[name], schema) : schema;
  }
}

void keep_if_same(SchemaJson& into, const SchemaJson& other, const char* name) {
  if (into.contains(name) && (!other.contains(name) || other[name] != into[name])) {
    into.erase(name);
  }
}

void merge_words(SchemaJson& into, const SchemaJson& other) {
  for (const SchemaJson& word : other) {
    if (std::ranges::find(into, word) == into.end()) {
      into.push_back(word);
    }
  }
}

void merge_lists(SchemaJson& into, const SchemaJson& other) {
  const auto other_list = [&](const char* name) { return other.value(name, SchemaJson::array()); };
  if (into.contains("enum")) {
    merge_words(into["enum"], other_list("enum"));
  }
  if (into.contains("required")) {
    into["required"] = common(into["required"], other_list("required"));
  }
  if (into.contains("allOf")) {
    into["allOf"] = common_rules(into["allOf"], other_list("allOf"));
  }
}

// What allows all that either allows.
SchemaJson merged(const SchemaJson& one, const SchemaJson& two) {
  if (one == two || !one.is_object() || !two.is_object()) {
    return one;
  }
  SchemaJson both = one;
  merge_end(both, two, "exclusiveMinimum", "minimum", true);
  merge_end(both, two, "exclusiveMaximum", "maximum", false);
  for (const char* const least : {"minItems", "minLength", "minProperties"}) {
    merge_count(both, two, least, true);
  }
  merge_count(both, two, "maxItems", false);
  for (const char* const same : {"anyOf", "oneOf", "contains", "not", "const"}) {
    keep_if_same(both, two, same);
  }
  merge_lists(both, two);
  for (const char* const name : {"items", "additionalProperties"}) {
    if (both.contains(name) && two.contains(name)) {
      both[name] = merged(both[name], two[name]);
    }
  }
  if (both.contains("properties") && two.contains("properties")) {
    merge_properties(both["properties"], two["properties"]);
  }
  return both;
}

SchemaJson demands(const SchemaJson& schema, const SchemaJson& all);

// Null if there are none.
SchemaJson demands_on_properties(const SchemaJson& properties, const SchemaJson& all) {
  SchemaJson more;
  for (const auto& [key, inner] : all.items()) {
    SchemaJson own = properties.contains(key) ? demands(properties[key], inner) : SchemaJson(false);
    if (!own.is_object() || !own.empty()) {
      more[key] = std::move(own);
    }
  }
  return more;
}

// What this schema demands beyond the merged one.
SchemaJson demands(const SchemaJson& schema, const SchemaJson& all) {
  static const std::set<std::string> said{"description", "default", "examples"};
  SchemaJson more = SchemaJson::object();
  for (const auto& [name, value] : schema.items()) {
    if (said.contains(name) || (all.contains(name) && all[name] == value)) {
      continue;
    }
    if (name == "properties") {
      if (SchemaJson inner = demands_on_properties(value, all[name]); !inner.is_null()) {
        more[name] = std::move(inner);
      }
    } else if (value.is_object() && all.contains(name) && all[name].is_object()) {
      more[name] = demands(value, all[name]);
    } else {
      more[name] = value;
    }
  }
  return more;
}

class Rules {
 public:
  explicit Rules(const SchemaJson& properties) : all_{&properties} {}
  void add(const Node& node, const std::vector<SchemaJson>& context);
  SchemaJson listed() const {
    SchemaJson rules = SchemaJson::array();
    for (const auto& [condition, then] : rules_) {
      rules.push_back({{"if", condition}, {"then", then}});
    }
    return rules;
  }

 private:
  using Key = std::string;
  using Guards = std::vector<const Branch*>;
  using Condition = std::optional<std::vector<SchemaJson>>;  // all of them; nullopt: not stated

  static std::set<Key> possible(const Node& node) {
    std::set<Key> keys;
    visit(node, [&](const Description& pass) {
      for (const auto& property : pass.properties()) {
        keys.insert(property.name);
      }
    });
    return keys;
  }
  static bool requires_key(const Node& node, const Key& key) {
    const auto* const property = node.pass.find(key);
    return property != nullptr && property->is_required;
  }
  static bool is_about(const Node& node, const Branch& branch, const Key& key) {
    const auto& question = node.pass.asked()[branch.question];
    return question.kind == Description::Question::Kind::given && question.key == key;
  }
  static Guards those(const Node& node, const std::function<bool(const Branch&)>& is_one) {
    Guards found;
    for (const Branch& branch : node.branches) {
      if (is_one(branch)) {
        found.push_back(&branch);
      }
    }
    return found;
  }

  static SchemaJson answered(const Description::Question& question,
                             const std::set<std::size_t>& answers) {
    if (question.kind == Description::Question::Kind::given) {
      const SchemaJson given{{"required", {question.key}}};
      return answers.contains(1) ? given : SchemaJson{{"not", given}};
    }
    SchemaJson values = SchemaJson::array();
    for (const std::size_t answer : answers) {
      values.push_back(question.answers[answer]);
    }
    SchemaJson condition;
    condition["properties"][question.key] =
        values.size() == 1 ? SchemaJson{{"const", values.front()}} : SchemaJson{{"enum", values}};
    if (!answers.contains(question.usual)) {
      condition["required"] = {question.key};
    }
    return condition;
  }

  static std::set<std::size_t> other_answers(const Description::Question& question,
                                             const std::set<std::size_t>& chosen) {
    std::set<std::size_t> others;
    for (std::size_t i = 0; i < question.answers.size(); ++i) {
      if (!chosen.contains(i)) {
        others.insert(i);
      }
    }
    return others;
  }

  // Whether one of the branches is taken, or none.
  static Condition with(const Node& node, const std::vector<SchemaJson>& context,
                        const Guards& guards, bool is_taken) {
    std::map<std::size_t, std::set<std::size_t>> answers;
    for (const Branch* const branch : guards) {
      answers[branch->question].insert(branch->answer);
    }
    SchemaJson any = SchemaJson::array();
    for (const auto& [index, chosen] : answers) {
      const Description::Question& question = node.pass.asked()[index];
      if (question.kind == Description::Question::Kind::hidden) {
        return std::nullopt;
      }
      const bool is_other = answers.size() == 1 && !is_taken;
      any.push_back(answered(question, is_other ? other_answers(question, chosen) : chosen));
    }
    std::vector<SchemaJson> all = context;
    const SchemaJson one = any.size() == 1 ? any.front() : SchemaJson{{"anyOf", any}};
    all.push_back(any.size() == 1 || is_taken ? one : SchemaJson{{"not", one}});
    return all;
  }

  SchemaJson& then(const std::vector<SchemaJson>& conditions) {
    const SchemaJson condition =
        conditions.size() == 1 ? conditions.front() : SchemaJson{{"allOf", conditions}};
    for (auto& [known, rule] : rules_) {
      if (known == condition) {
        return rule;
      }
    }
    return rules_.emplace_back(condition, SchemaJson::object()).second;
  }
  void allow(const Condition& condition, const Key& key, const SchemaJson& what) {
    if (condition) {
      then(*condition)["properties"][key] = what;
    }
  }
  void require(const Condition& condition, const Key& key) {
    if (condition) {
      SchemaJson& required = then(*condition)["required"];
      if (required.is_null() || std::ranges::find(required, SchemaJson(key)) == required.end()) {
        required.push_back(key);
      }
    }
  }
  void refine(const Condition& condition, const Key& key, const SchemaJson& schema) {
    const SchemaJson more = demands(schema, (*all_)[key]);
    if (!more.empty()) {
      allow(condition, key, more);
    }
  }
  static std::set<Key> still_possible(const Node& node, const Branch& branch);
  void add_key_of_branch(const Node& node, const Branch& branch, const Key& key,
                         const Condition& condition);
  void add_usual(const Node& node, const std::vector<SchemaJson>& context);
  void add_branch(const Node& node, const Branch& branch, const std::vector<SchemaJson>& context);
  static Guards offering(const Node& node, const Key& key) {
    return those(node, [&](const Branch& b) { return possible(*b.node).contains(key); });
  }
  static Guards removing(const Node& node, const Key& key) {
    return those(node, [&](const Branch& b) { return !requires_key(*b.node, key); });
  }
  static Guards changing(const Node& node, const Key& key, const SchemaJson& schema) {
    return those(node, [&](const Branch& b) {
      const auto* const other = b.node->pass.find(key);
      return other != nullptr && other->schema != schema;
    });
  }

  const SchemaJson* all_;
  std::vector<std::pair<SchemaJson, SchemaJson>> rules_;
};

// What holds unless another answer is given.
void Rules::add_usual(const Node& node, const std::vector<SchemaJson>& context) {
  for (const Key& key : possible(node)) {
    const auto* const property = node.pass.find(key);
    if (property == nullptr) {
      const Guards guards = offering(node, key);
      if (std::ranges::none_of(guards, [&](auto* b) { return is_about(node, *b, key); })) {
        allow(with(node, context, guards, false), key, false);
      }
      continue;
    }
    if (const Guards removers = removing(node, key); property->is_required && !removers.empty()) {
      require(with(node, context, removers, false), key);
    }
    if (const Guards changers = changing(node, key, property->schema); !changers.empty()) {
      refine(with(node, context, changers, false), key, property->schema);
    }
  }
}

// The keys that the branch may offer, and those that questions which it asks as well may bring.
std::set<Rules::Key> Rules::still_possible(const Node& node, const Branch& branch) {
  const std::set<std::string> reached = names_of(branch.node->pass.asked());
  std::set<Key> still = possible(*branch.node);
  for (const Branch& other : node.branches) {
    if (other.question != branch.question &&
        reached.contains(Description::name_of(node.pass.asked()[other.question]))) {
      std::ranges::copy_if(possible(*other.node), std::inserter(still, still.end()),
                           [&](const Key& key) { return node.pass.find(key) == nullptr; });
    }
  }
  return still;
}

void Rules::add_key_of_branch(const Node& node, const Branch& branch, const Key& key,
                              const Condition& condition) {
  const auto* const before = node.pass.find(key);
  const auto* const now = branch.node->pass.find(key);
  if (now == nullptr) {
    return;
  }
  const bool is_new = before == nullptr || !before->is_required;
  if (now->is_required && is_new && !is_about(node, branch, key) &&
      removing(*branch.node, key).empty()) {
    require(condition, key);
  }
  if ((before == nullptr || before->schema != now->schema) &&
      changing(*branch.node, key, now->schema).empty()) {
    refine(condition, key, now->schema);
  }
}

void Rules::add_branch(const Node& node, const Branch& branch,
                       const std::vector<SchemaJson>& context) {
  const Condition condition = with(node, context, {&branch}, true);
  if (!condition) {
    return;
  }
  const std::set<Key> still = still_possible(node, branch);
  for (const Key& key : possible(node)) {
    const Guards guards = offering(node, key);
    const bool is_said =
        node.pass.find(key) == nullptr && std::ranges::all_of(guards, [&](auto* b) {
          return b->question == branch.question && !is_about(node, *b, key);
        });
    if (!still.contains(key) && !is_said) {
      allow(condition, key, false);
    }
    add_key_of_branch(node, branch, key, condition);
  }
  add(*branch.node, *condition);
}

void Rules::add(const Node& node, const std::vector<SchemaJson>& context) {
  add_usual(node, context);
  for (const Branch& branch : node.branches) {
    add_branch(node, branch, context);
  }
}

// All keys, each after the one that is read before it.
std::vector<Description::Property> all_properties(const Node& root) {
  std::vector<Description::Property> all;
  visit(root, [&](const Description& pass) {
    auto place = all.begin();
    for (const Description::Property& property : pass.properties()) {
      const auto known = std::ranges::find(all, property.name, &Description::Property::name);
      if (known == all.end()) {
        place = std::next(all.insert(place, property));
      } else {
        known->schema = merged(known->schema, property.schema);
        place = std::next(known);
      }
    }
  });
  visit(root, [&](const Description& pass) {
    for (Description::Property& property : all) {
      const auto* const here = pass.find(property.name);
      property.is_required = property.is_required && here != nullptr && here->is_required;
    }
  });
  return all;
}
}  // namespace

SchemaJson described_mapping(const std::string& path, KnownMappings& known,
                             const std::function<void(Description&)>& pass) {
  Description usual{{}, known};
  pass(usual);
  for (const KnownMapping& mapping : known[path]) {
    if (mapping.asked == usual.asked() && mapping.properties == usual.properties()) {
      return mapping.schema;
    }
  }
  const Node root = explored(pass, usual, {}, {});
  SchemaJson schema{{"type", "object"}, {"properties", SchemaJson::object()}};
  SchemaJson required = SchemaJson::array();
  for (const Description::Property& property : all_properties(root)) {
    schema["properties"][property.name] = property.schema;
    if (property.is_required) {
      required.push_back(property.name);
    }
  }
  schema["required"] = required;
  schema["additionalProperties"] = false;
  schema.update(root.pass.choices());
  Rules rules{schema["properties"]};
  rules.add(root, {});
  if (SchemaJson all = rules.listed(); !all.empty()) {
    schema["allOf"] = std::move(all);
  }
  known[path].push_back({usual.asked(), usual.properties(), schema});
  return schema;
}
}  // namespace tapstudy::protocols
