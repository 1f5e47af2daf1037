#include "runner/commands/key_reference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
namespace tapstudy::runner {
namespace {
using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

// By the end of the key's name; the first that fits.
constexpr std::array<std::pair<std::string_view, std::string_view>, 20> units{
    {{"_kg_per_m3", "kg/m³"},
     {"_n_s_per_m", "N s/m"},
     {"_n_per_m", "N/m"},
     {"_n_per_s", "N/s"},
     {"_per_s", "1/s"},
     {"_m_s", "m/s"},
     {"_rad", "rad"},
     {"_m3", "m³"},
     {"_db_fs", "dB FS"},
     {"_db", "dB"},
     {"_hz", "Hz"},
     {"_kg", "kg"},
     {"_pa", "Pa"},
     {"metres_per_unit", "m/unit"},
     {"metres_per_count", "m/count"},
     {"volts_per_newton", "V/N"},
     {"dac_counts_per_volt", "counts/V"},
     {"_m", "m"},
     {"_n", "N"},
     {"_s", "s"}}};

std::string unit_of(const std::string& key) {
  const auto unit =
      std::ranges::find_if(units, [&](const auto& row) { return key.ends_with(row.first); });
  return unit == units.end() ? "" : std::string{unit->second};
}

std::string code(const Json& value) {
  const bool is_word = value.is_string() && !value.get_ref<const std::string&>().empty();
  return fmt::format("`{}`", is_word ? value.get<std::string>() : value.dump());
}

std::string codes(const Json& values) {
  Words words;
  std::ranges::transform(values, std::back_inserter(words), code);
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string bounds(const Json& schema) {
  const auto number = [&](const char* name) {
    return fmt::format("{:.7g}", schema[name].get<double>());
  };
  if (schema.contains("minimum") && schema.contains("maximum")) {
    return number("minimum") + " to " + number("maximum");
  }
  Words words;
  for (const auto& [name, said] : {std::pair{"exclusiveMinimum", "above "},
                                   {"minimum", "at least "},
                                   {"exclusiveMaximum", "below "},
                                   {"maximum", "at most "}}) {
    if (schema.contains(name)) {
      words.push_back(said + number(name));
    }
  }
  if (schema.contains("not") && schema["not"].contains("const")) {
    words.push_back("not " + schema["not"]["const"].dump());
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

bool is_translated(const Json& schema) {
  return schema.contains("patternProperties");
}

std::string list_range(const Json& schema) {
  const Json& items = schema["items"];
  const bool are_numbers = items.value("type", Json{}) == "number";
  const std::string kind = items.contains("properties") ? "mappings"
                           : is_translated(items)       ? "texts, each one or one for each language"
                           : are_numbers                ? "numbers"
                                                        : "names";
  const std::size_t low = schema.value("minItems", std::size_t{0});
  Words words;
  if (schema.contains("maxItems")) {
    const auto high = schema["maxItems"].get<std::size_t>();
    words.push_back("list of " +
                    (low == high ? fmt::format("{} ", low) : fmt::format("{} to {} ", low, high)) +
                    kind);
  } else {
    words.push_back("list of " + kind);
    if (low > 0) {
      words.push_back(fmt::format("at least {}", low));
    }
  }
  if (are_numbers) {
    words.push_back("each " + bounds(items));
  }
  if (schema.contains("uniqueItems")) {
    words.emplace_back("all different");
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string range_of_listable(const Json& schema) {
  Words keys;
  for (const auto& entry : schema["properties"].items()) {
    keys.push_back(code(entry.key()));
  }
  return fmt::format("mapping, or list of {}", fmt::join(keys, ", "));
}

std::string range_of_mapping(const Json& schema) {
  if (schema.contains("properties")) {
    return "mapping";
  }
  return schema.contains("minProperties") ? "mapping of names, at least 1" : "mapping of names";
}

std::string range_of_type(const Json& type, const Json& schema) {
  if (type == "array") {
    return list_range(schema);
  }
  if (type == "object") {
    return range_of_mapping(schema);
  }
  if (type.is_array()) {
    return "a name";
  }
  if (type == "string") {
    return schema.contains("minLength") ? "one line of text" : "text";
  }
  return type == "boolean" ? "`true`, `false`"
                           : (type == "integer" ? "whole, " : "") + bounds(schema);
}

std::string range_of(const Json& schema) {
  if (schema.contains("const")) {
    return code(schema["const"]);
  }
  if (schema.contains("enum")) {
    return codes(schema["enum"]);
  }
  if (schema.contains("prefixItems")) {
    return range_of_listable(schema);
  }
  if (schema.contains("properties") && schema.contains("pattern")) {
    const auto pattern = schema["pattern"].get<std::string>();
    return fmt::format("mapping, or {}", code(pattern.substr(1, pattern.size() - 2)));
  }
  return is_translated(schema) ? "text, or one for each language"
                               : range_of_type(schema.value("type", Json{}), schema);
}

// The keys that have to be given; empty where something else is demanded, too.
std::string keys_given(const Json& condition) {
  Words words;
  for (const Json& one :
       condition.contains("anyOf") ? condition["anyOf"] : Json::array({condition})) {
    if (!one.contains("required") || one.contains("properties")) {
      return {};
    }
    words.push_back(codes(one["required"]));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

// Under which other keys, or values of them, a condition holds; empty where it is another one.
std::string condition_words(const Json& condition) {
  if (condition.contains("properties") && condition["properties"].size() == 1) {
    const auto entry = condition["properties"].begin();
    const std::string& key = entry.key();
    const Json& value = entry.value();
    return fmt::format(
        "with `{}` {}", key,
        value.contains("const") ? code(value["const"]) : codes(value.value("enum", Json::array())));
  }
  const bool is_not = condition.contains("not");
  const std::string named = keys_given(is_not ? condition["not"] : condition);
  return named.empty() ? "" : (is_not ? "without " : "with ") + named;
}

const Json& properties_of(const Json& schema) {
  static const Json none = Json::object();
  const auto found = schema.find("properties");
  return found == schema.end() ? none : *found;
}

std::string default_of(const std::string& key, const Json& value, const Json& schema) {
  const auto holds = [&](const Json& required) {
    return std::ranges::find(required, Json(key)) != required.end();
  };
  if (holds(schema.value("required", Json::array()))) {
    return "required";
  }
  Words words;
  for (const Json& rule : schema.value("allOf", Json::array())) {
    if (holds(rule["then"].value("required", Json::array()))) {
      words.push_back(condition_words(rule["if"]));
    }
  }
  std::erase(words, "");
  if (!words.empty()) {
    return fmt::format("required {}", fmt::join(words, "; "));
  }
  return value.contains("default") ? code(value["default"]) : "unset";
}

std::string cell(std::string text) {
  for (auto bar = text.find('|'); bar != std::string::npos; bar = text.find('|', bar + 2)) {
    text.insert(bar, "\\");
  }
  return text;
}

void add_table(const std::string& path, const Json& schema, std::string& text) {
  std::string rows;
  const auto add = [&](const std::string& key, const std::string& unit, const Json& value,
                       const std::string& otherwise) {
    rows += fmt::format("| `{}` | {} | {} | {} | {} |\n", key, unit, cell(otherwise),
                        cell(range_of(value)), cell(value.value("description", "")));
  };
  for (const auto& [key, value] : properties_of(schema).items()) {
    add(key, unit_of(key), value, default_of(key, value, schema));
  }
  const Json each = schema.value("additionalProperties", Json(false));
  if (each.is_object() && !each.contains("properties")) {
    const std::string name = path.substr(path.rfind('.') + 1);
    add(name + ".*", unit_of(name), each, "");
  }
  if (rows.empty()) {
    return;
  }
  text += "| key | unit | default | range | meaning |\n|---|---|---|---|---|\n" + rows + "\n";
  for (const auto& [how_many, words] :
       {std::pair{"oneOf", "Exactly one of"}, {"anyOf", "At least one of"}}) {
    if (schema.contains(how_many)) {
      Words keys;
      for (const Json& choice : schema[how_many]) {
        keys.push_back(codes(choice["required"]));
      }
      text += fmt::format("{}: {}.\n\n", words, fmt::join(keys, ", "));
    }
  }
}

std::string below(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

// The mappings in this one, each with its path.
std::vector<std::pair<std::string, Json>> inner(const std::string& path, const Json& schema) {
  std::vector<std::pair<std::string, Json>> found;
  const auto add = [&](std::string name, Json value) {
    if (value.value("type", Json{}) == "array") {
      name += "[]";
      value = Json(value["items"]);
    }
    const bool is_mapping =
        value.is_object() && !is_translated(value) &&
        (value.contains("properties") || value.value("type", Json{}) == "object");
    if (is_mapping) {
      found.emplace_back(std::move(name), std::move(value));
    }
  };
  for (const auto& [key, value] : properties_of(schema).items()) {
    add(below(path, key), value);
  }
  if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object()) {
    add(path + ".*", schema["additionalProperties"]);
  }
  return found;
}

void add_nested(const std::string& path, const Json& schema, const std::string& section,
                std::string& text) {
  std::string table;
  add_table(path, schema, table);
  if (!table.empty() && path != section) {
    text += fmt::format("#### `{}`\n\n", path);
  }
  text += table;
  for (const auto& [name, value] : inner(path, schema)) {
    add_nested(name, value, section, text);
  }
}

std::string sentence(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') {
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  }
  return text + ".";
}

void add_file(const Json& schema, std::string& text) {
  std::string title = schema["title"].get<std::string>().substr(sizeof "tapstudy");
  title = sentence(title);
  title.pop_back();
  text += fmt::format("## {}\n\n{}\n\n", title, schema["description"].get<std::string>());
  add_table("", schema, text);
  for (const auto& [path, value] : inner("", schema)) {
    const std::string section = path.substr(0, path.find('['));
    const Json& property = schema["properties"][section];
    text += fmt::format("### {}: `{}`\n\n{}\n\n", title, section,
                        sentence(property["description"].get<std::string>()));
    add_nested(path, value, section, text);
    for (const Json& example : property.value("examples", Json::array())) {
      text += fmt::format("For example:\n\n```yaml\n{}\n```\n\n", example.get<std::string>());
    }
  }
}
}  // namespace

std::string key_reference(const std::vector<std::string>& schemas) {
  std::string text =
      "# The keys of protocols, rigs and calibrations\n\n"
      "In the tables `.*` stands for any name, `[]` for any list index. A name is 1 to 64 letters, "
      "digits, `_`, `-`, `+` or `.`, and does not start with one of the last three.\n\n";
  for (const std::string& schema : schemas) {
    add_file(Json::parse(schema), text);
  }
  text.pop_back();
  return text;
}
}  // namespace tapstudy::runner
