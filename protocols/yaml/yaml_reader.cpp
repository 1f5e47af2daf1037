#include "protocols/yaml/yaml_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utf8cpp/utf8.h>
#include <yaml-cpp/anchor.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/yaml/described_values.hpp"
#include "protocols/yaml/problems.hpp"
namespace tapstudy::protocols {
// Throws YAML::Exception if the text is not YAML.
bool holds_two_documents(const std::string& text);

// What an error of the YAML parser, which notices it late, is likely to come from. error_line: from
// 0.
std::string likely_cause(const std::string& text, int error_line);

namespace {
// Sees a document go by and keeps nothing of it.
class Passing final : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnScalar(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {}
  void OnSequenceStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/,
                       YAML::anchor_t /*anchor*/, YAML::EmitterStyle::value /*style*/) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {}
  void OnMapEnd() override {}
};

}  // namespace

// Not by YAML::LoadAll: a comma where no document can begin is an endless number of them to it.
bool holds_two_documents(const std::string& text) {
  std::istringstream stream{text};
  YAML::Parser parser{stream};
  Passing passing;
  return parser.HandleNextDocument(passing) && parser.HandleNextDocument(passing);
}

std::string likely_cause(const std::string& text, int error_line) {
  std::istringstream lines{text};
  std::string line;
  for (int number = 1; number <= error_line + 1 && std::getline(lines, line); ++number) {
    const auto indentation = line.find_first_not_of(" \t");
    if (line.substr(0, std::min(indentation, line.size())).find('\t') != std::string::npos) {
      return fmt::format("line {} is indented with a tab: use spaces", number);
    }
    if (line.find_first_of("#'") == std::string::npos && std::ranges::count(line, '"') % 2 == 1) {
      return fmt::format("is the quote in line {} closed?", number);
    }
  }
  return "is this line indented like its neighbours? A text with any of ? : , # [ { goes in quotes";
}

bool is_name(const std::string& text) {
  const auto is_inner = [](unsigned char c) {
    return c < 128 && (std::isalnum(c) != 0 || c == '_' || c == '-' || c == '+' || c == '.');
  };
  const bool means_missing = text == "NA";  // in tables
  return !means_missing && !text.empty() && text.size() <= 64 &&
         std::ranges::all_of(text, is_inner) && text.find_first_of("-+.") != 0;
}

std::string as_it_reads(const std::string& text) {
  constexpr std::u32string_view blanks = U" \t\n\r\u00a0\u2002\u2003\u2009\u202f\u3000";
  constexpr std::u32string_view unseen = U"\u00ad\u200b\u200c\u200d\u2060\ufeff";
  std::string read;
  for (auto next = text.begin(); next != text.end();) {
    const auto start = next;
    const char32_t character = utf8::unchecked::next(next);
    if (blanks.find(character) != std::u32string_view::npos) {
      read += read.empty() || read.back() == ' ' ? "" : " ";
    } else if (unseen.find(character) == std::u32string_view::npos) {
      read += core::lower_case(std::string{start, next});
    }
  }
  return read.ends_with(' ') ? read.substr(0, read.size() - 1) : read;
}

bool Range::contains(double x) const {
  return std::isfinite(x) && (low_included ? x >= low : x > low) &&
         (high_included ? x <= high : x < high);
}

std::string Range::words() const {
  return fmt::format("{} {} and {} {}", low_included ? "at least" : "greater than", low,
                     high_included ? "at most" : "less than", high);
}

MapReader::MapReader(const YAML::Node& node, std::string path, std::string pattern,
                     Problems& problems, Translations* translations)
    : node_{std::make_unique<YAML::Node>(node)},
      path_{std::move(path)},
      pattern_{std::move(pattern)},
      problems_{&problems},
      translations_{translations} {}
MapReader::~MapReader() = default;
MapReader::MapReader(MapReader&& other) noexcept = default;

namespace {
// The first document; `check` is of the text as YAML.
YAML::Node loaded(const std::string& text, const std::string& file, Problems& problems,
                  const std::function<void()>& check) {
  problems.read_from(text);
  if (!utf8::is_valid(text.begin(), text.end())) {
    throw core::InvalidInput{fmt::format("{}:1:1: not UTF-8 text", file)};
  }
  try {
    check();
    YAML::Node document = YAML::Load(text);
    if (!document.IsMap()) {
      throw core::InvalidInput{fmt::format("{}:1:1: not a mapping of keys to values", file)};
    }
    return document;
  } catch (const YAML::Exception& error) {
    throw core::InvalidInput{fmt::format("{}: not YAML: {} ({})",
                                         problems.place(error.mark.line, error.mark.column, ""),
                                         error.msg, likely_cause(text, error.mark.line))};
  }
}
}  // namespace

MapReader MapReader::whole_file(const std::string& text, const std::string& file,
                                Problems& problems, Translations* translations) {
  const auto check_is_one = [&] {
    if (holds_two_documents(text)) {
      throw core::InvalidInput{fmt::format("{}: holds more than one YAML document", file)};
    }
  };
  return {loaded(text, file, problems, check_is_one), "", "", problems, translations};
}

MapReader MapReader::first_document(const std::string& text, const std::string& file,
                                    Problems& problems, Translations* translations) {
  return {loaded(text, file, problems, [] {}), "", "", problems, translations};
}

std::string MapReader::path_of(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}
std::string MapReader::pattern_of(const std::string& key) const {
  if (has_free_names_) {
    return pattern_ + ".*";
  }
  return pattern_.empty() ? key : pattern_ + "." + key;
}

void MapReader::reject_at(const YAML::Node& node, const std::string& path, const std::string& what,
                          const std::optional<std::string>& may_follow) {
  if (pass_ != nullptr) {
    return;
  }
  problems_->add(std::max(0, node.Mark().line), std::max(0, node.Mark().column), path, what,
                 may_follow);
}
void MapReader::reject(const std::string& what) {
  reject_at(written(), path_, what, path_);
}
void MapReader::reject(const std::string& key, const std::string& what) {
  const YAML::Node& whole = *node_;
  const YAML::Node value = whole[key];
  reject_at(value.IsDefined() ? value : written(), path_of(key), what, path_);
  if (std::ranges::find(known_, key) == known_.end()) {
    known_.push_back(key);  // it has its error
  }
}

std::string MapReader::stated_at() const {
  const YAML::Mark mark = written().Mark();
  return problems_->place(std::max(0, mark.line), std::max(0, mark.column), path_);
}
std::string MapReader::stated_at(const std::string& key) const {
  const YAML::Node& whole = *node_;
  const YAML::Node value = whole[key];
  const YAML::Mark mark = value.IsDefined() ? value.Mark() : written().Mark();
  return problems_->place(std::max(0, mark.line), std::max(0, mark.column), path_of(key));
}

bool MapReader::has(const std::string& key) {
  if (pass_ != nullptr) {
    return pass_->ask({Description::Question::Kind::given, key, {false, true}}) == 1;
  }
  looked_for_.push_back(key);
  const YAML::Node& whole = *node_;
  return whole[key].IsDefined();
}

std::optional<YAML::Node> MapReader::find(const std::string& key, bool required) {
  known_.push_back(key);
  problems_->asked_for(pattern_of(key));
  const YAML::Node& whole = *node_;  // through const, so that asking does not insert
  const YAML::Node value = whole[key];
  if (value.IsDefined()) {
    return value;
  }
  if (required) {
    reject_at(written(), path_of(key), key_is_missing);
  }
  return std::nullopt;
}

namespace {
// As YAML 1.2 has whole numbers (core schema, 10.3.2): decimal, zeros before it or not, 0o octal,
// 0x hexadecimal. Unset: it is none, or beyond 64 bits.
std::optional<std::int64_t> whole_number_in(std::string_view text) {
  const bool is_negative = text.starts_with('-');
  const bool is_signed = is_negative || text.starts_with('+');
  std::string_view digits = text.substr(is_signed ? 1 : 0);
  int base = 10;
  if (!is_signed && (digits.starts_with("0o") || digits.starts_with("0x"))) {
    base = digits[1] == 'o' ? 8 : 16;
    digits.remove_prefix(2);
  }
  std::int64_t number{};
  const char* const end = digits.data() + digits.size();
  const auto [stopped, error] = std::from_chars(digits.data(), end, number, base);
  const bool is_whole =
      error == std::errc{} && stopped == end && !digits.empty() && digits.front() != '-';
  return is_whole ? std::optional{is_negative ? -number : number} : std::nullopt;
}

bool is_all_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// What somebody means who writes a decimal comma, or the unit that the key states.
std::string hint_for_number(const YAML::Node& node) {
  const std::string text = node.IsScalar() ? node.Scalar() : "";
  double number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string_view rest{end, static_cast<std::size_t>(text.data() + text.size() - end)};
  if (error != std::errc{} || rest.empty()) {
    return "";
  }
  if (rest.front() == ',') {
    return " (decimals take a point, and nothing separates thousands)";
  }
  const auto unit =
      static_cast<unsigned char>(rest[std::min(rest.find_first_not_of(' '), rest.size() - 1)]);
  // 0b10 is a number in other languages, and nothing has a unit
  const bool is_unit = (std::isalpha(unit) != 0 || unit == '%' || unit >= 0x80) && number != 0.0;
  return is_unit ? " (the number stands alone, in the unit that the key states)" : "";
}
}  // namespace

// {mass_kg: 0,058} has a key 058 without a value.
void MapReader::reject_decimal_commas() {
  std::optional<std::pair<YAML::Node, YAML::Node>> before;
  for (const auto& entry : *node_) {
    if (before && before->second.IsScalar() && entry.first.IsScalar() &&
        is_all_digits(entry.first.Scalar()) && entry.second.IsNull() &&
        whole_number_in(before->second.Scalar())) {
      reject_at(before->second, path_of(before->first.Scalar()),
                fmt::format("{},{} is not a number (decimals take a point)",
                            before->second.Scalar(), entry.first.Scalar()));
      decimals_.insert(entry.first.Scalar());
    }
    before.emplace(entry.first, entry.second);
  }
}

void MapReader::note_value(const YAML::Node& node, const std::string& path,
                           const std::string& value) {
  if (translations_ != nullptr) {
    translations_->values[{path, node.Mark().pos}] = value;
  }
}

std::optional<double> MapReader::as_number(const YAML::Node& node, const std::string& path,
                                           const Range& range) {
  const auto whole = node.IsScalar() ? whole_number_in(node.Scalar()) : std::nullopt;
  auto value = static_cast<double>(whole.value_or(0));
  if (!node.IsScalar() || (!whole && !YAML::convert<double>::decode(node, value))) {
    reject_at(node, path,
              fmt::format("{} is not a number{}", kind_of(node), hint_for_number(node)));
    return std::nullopt;
  }
  if (!range.contains(value)) {
    reject_at(node, path, fmt::format("{} is not allowed ({})", value, range.words()));
    return std::nullopt;
  }
  note_value(node, path, fmt::format("{}", value));
  return value;
}

double MapReader::number(const Key& key, const Range& range, std::optional<double> otherwise) {
  const double harmless = otherwise.value_or(range.low_included ? range.low : range.high);
  if (pass_ != nullptr) {
    problems_->add_unread();
    pass_->add(key, described(range), !otherwise, described_default(otherwise));
    return harmless;
  }
  const auto node = find(key.name, !otherwise);
  return node ? as_number(*node, path_of(key.name), range).value_or(harmless) : harmless;
}

int MapReader::integer(const Key& key, int low, int high, std::optional<int> otherwise) {
  if (pass_ != nullptr) {
    problems_->add_unread();
    pass_->add(key, described_integer(low, high), !otherwise, described_default(otherwise));
    return low + static_cast<int>(chosen_integer(*pass_, key.name, low, high, otherwise));
  }
  const auto node = find(key.name, !otherwise);
  if (!node) {
    return otherwise.value_or(low);
  }
  const auto value = node->IsScalar() ? whole_number_in(node->Scalar()) : std::nullopt;
  if (!value) {
    reject_at(*node, path_of(key.name),
              fmt::format("{} is not a whole number{} (from {} to {})", kind_of(*node),
                          hint_for_number(*node), low, high));
    return low;
  }
  if (*value < low || *value > high) {
    reject_at(*node, path_of(key.name),
              fmt::format("{} is not allowed (from {} to {})", *value, low, high));
    return low;
  }
  note_value(*node, path_of(key.name), fmt::format("{}", *value));
  return static_cast<int>(*value);
}

bool MapReader::yes_or_no(const Key& key, std::optional<bool> otherwise) {
  if (pass_ != nullptr) {
    pass_->add(key, {{"type", "boolean"}}, !otherwise, described_default(otherwise));
    return pass_->ask({Description::Question::Kind::value,
                       key.name,
                       {false, true},
                       otherwise.value_or(false) ? std::size_t{1} : std::size_t{0}}) == 1;
  }
  const auto node = find(key.name, !otherwise);
  bool value = otherwise.value_or(false);
  if (node && !YAML::convert<bool>::decode(*node, value)) {
    reject_at(*node, path_of(key.name),
              fmt::format("{} is neither true nor false", kind_of(*node)));
    is_choice_unread_ = true;
  } else if (node) {
    note_value(*node, path_of(key.name), fmt::format("{}", value));
  }
  return value;
}

bool MapReader::check_name(const YAML::Node& node, const std::string& path) {
  if (node.IsScalar() && is_name(node.Scalar())) {
    return true;
  }
  if (node.IsScalar() && node.Scalar() == "<<") {
    reject_at(node, path, merges_are_not_read);
    return false;
  }
  reject_at(node, path,
            fmt::format("{} is not a name (1 to 64 letters, digits, '_', '-', '+' or '.', starting "
                        "with a letter, a digit or '_'; not NA)",
                        kind_of(node)));
  return false;
}

std::string MapReader::name(const Key& key) {
  if (pass_ != nullptr) {
    pass_->add(key, described_name(), true);
    return "";
  }
  const auto node = find(key.name, true);
  return node && check_name(*node, path_of(key.name)) ? node->Scalar() : "";
}

std::vector<double> MapReader::number_list(const Key& key, const Range& range) {
  std::vector<double> values;
  if (pass_ != nullptr) {
    problems_->add_unread();
    pass_->add(key, {{"type", "array"}, {"items", described(range)}, {"minItems", 1}}, true);
    return values;
  }
  const auto node = find(key.name, true);
  if (!node) {
    return values;
  }
  if (!node->IsSequence() || node->size() == 0) {
    reject_at(*node, path_of(key.name), "is not a list of numbers");
    return values;
  }
  for (std::size_t i = 0; i < node->size(); ++i) {
    const std::string path = fmt::format("{}[{}]", path_of(key.name), i);
    values.push_back(as_number((*node)[i], path, range).value_or(range.high));
  }
  return values;
}

Eigen::VectorXd MapReader::numbers(const Key& key, Eigen::Index size, const Range& range) {
  Eigen::VectorXd values = Eigen::VectorXd::Constant(size, range.high);
  if (pass_ != nullptr) {
    problems_->add_unread();
    pass_->add(
        key,
        {{"type", "array"}, {"items", described(range)}, {"minItems", size}, {"maxItems", size}},
        true);
    return values;
  }
  const auto node = find(key.name, true);
  if (!node) {
    return values;
  }
  if (!node->IsSequence() || node->size() != static_cast<std::size_t>(size)) {
    const bool is_longer = node->IsSequence() && node->size() > static_cast<std::size_t>(size);
    reject_at(
        *node, path_of(key.name),
        fmt::format(
            "is not a list of {} numbers{}", size,
            is_longer ? fmt::format(": it has {} (decimals take a point)", node->size()) : ""));
    return values;
  }
  for (Eigen::Index i = 0; i < size; ++i) {
    const std::string path = fmt::format("{}[{}]", path_of(key.name), i);
    values[i] = as_number((*node)[i], path, range).value_or(range.high);
  }
  return values;
}

bool MapReader::is_allowed(const YAML::Node& node, const std::string& path, const std::string& kind,
                           const std::vector<std::string>& allowed) {
  if (node.IsScalar() && std::ranges::find(allowed, node.Scalar()) != allowed.end()) {
    return true;
  }
  const std::string hint = node.IsScalar() ? did_you_mean(node.Scalar(), allowed) : "";
  reject_at(node, path,
            fmt::format("{} is not a known {} (one of: {}{})", kind_of(node), kind,
                        fmt::join(allowed, ", "), hint),
            allowed.empty() ? std::optional<std::string>{""} : std::nullopt);  // who names them?
  return false;
}

std::string MapReader::word(const Key& key, const std::string& kind,
                            const std::vector<std::string>& allowed,
                            const std::optional<std::string>& otherwise) {
  if (pass_ != nullptr) {
    return described_word(*pass_, key, allowed, otherwise);
  }
  const auto node = find(key.name, !otherwise);
  if (node && is_allowed(*node, path_of(key.name), kind, allowed)) {
    return node->Scalar();
  }
  is_choice_unread_ = is_choice_unread_ || node || !otherwise;
  return otherwise.value_or("");
}

void MapReader::check_format(const std::string& version) {
  word({"format", "version of the file format"}, "format", {version});
}

std::vector<std::string> MapReader::words(
    const Key& key, const std::string& kind, const std::vector<std::string>& allowed,
    const std::optional<std::vector<std::string>>& otherwise) {
  if (pass_ != nullptr) {
    problems_->add_unread();
    pass_->add(key,
               {{"type", "array"},
                {"items", described_words(allowed)},
                {"minItems", 1},
                {"uniqueItems", true}},
               !otherwise, described_default(otherwise));
    return {};
  }
  const auto node = find(key.name, !otherwise);
  if (!node) {
    return otherwise.value_or(std::vector<std::string>{});
  }
  if (!node->IsSequence() || node->size() == 0) {
    reject_at(*node, path_of(key.name), fmt::format("is not a list of at least one {}", kind));
    return {};
  }
  std::vector<std::string> chosen;
  for (std::size_t i = 0; i < node->size(); ++i) {
    const std::string path = fmt::format("{}[{}]", path_of(key.name), i);
    const YAML::Node item = (*node)[i];
    if (!is_allowed(item, path, kind, allowed)) {
      continue;
    }
    if (std::ranges::find(chosen, item.Scalar()) != chosen.end()) {
      reject_at(item, path, fmt::format("'{}' is listed twice", item.Scalar()));
      continue;
    }
    chosen.push_back(item.Scalar());
  }
  return chosen;
}
}  // namespace tapstudy::protocols
