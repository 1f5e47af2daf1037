#include "protocols/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::protocols {
namespace {
using namespace std::string_view_literals;
constexpr std::string_view blanks = " \t\r\n";

// "href" of "xlink:href".
std::string local_name(std::string_view name) {
  const auto colon = name.find(':');
  return core::lower_case(colon == name.npos ? name : name.substr(colon + 1));
}

// Within the file itself, or data that stand in it.
bool is_own(std::string_view reference) {
  const std::string target = core::lower_case(core::trimmed(reference));
  return target.starts_with('#') || target.starts_with("data:image/");
}

// Of style sheets, and of attributes that are such: url(#paint), url("https://…").
bool are_urls_own(std::string_view style) {
  const std::string lower = core::lower_case(style);
  for (auto at = lower.find("url("); at != lower.npos; at = lower.find("url(", at + 1)) {
    const auto from = lower.find_first_not_of(" \t\r\n'\"", at + 4);
    if (from == lower.npos || !is_own(std::string_view{lower}.substr(from))) {
      return false;
    }
  }
  return lower.find("@import") == lower.npos;
}

// What of an SVG file is no picture. Reads tags, not what they mean.
class SvgTags {
 public:
  explicit SvgTags(std::string_view text) : left_{text} {}

  // Empty: nothing is wrong.
  std::string wrong() {
    for (std::string_view before; problem_.empty() && has_next(before);) {
      if (!are_urls_own(before)) {
        problem_ = "refers to other files";
      } else if (!pass_comment()) {
        read_tag();
      }
    }
    return problem_.empty() && (!open_.empty() || !has_root_) ? "it is not well-formed SVG"
                                                              : problem_;
  }

 private:
  bool has_next(std::string_view& before) {
    const auto at = left_.find('<');
    before = left_.substr(0, at);
    left_ = at == left_.npos ? std::string_view{} : left_.substr(at);
    return at != left_.npos && !left_.empty();
  }

  // A comment, a declaration or marked text; false: it is a tag.
  bool pass_comment() {
    constexpr std::array<std::array<std::string_view, 2>, 3> kinds{
        {{"<!--", "-->"}, {"<?", "?>"}, {"<![CDATA[", "]]>"}}};
    for (const auto& [begin, end] : kinds) {
      if (left_.starts_with(begin)) {
        const auto at = left_.find(end, begin.size());
        const bool is_style = begin == "<![CDATA["sv && !are_urls_own(left_.substr(0, at));
        const bool is_sheet = left_.starts_with("<?xml-stylesheet");
        problem_ = at == left_.npos       ? "it is not well-formed SVG"
                   : is_style || is_sheet ? "refers to other files"
                                          : "";
        left_.remove_prefix(std::min(at, left_.size() - end.size()) + end.size());
        return true;
      }
    }
    return false;
  }

  // Up to its '>', which may also stand in the value of an attribute.
  std::string_view take_tag() {
    char quote = 0;
    for (std::size_t i = 1; i < left_.size(); ++i) {
      const char c = left_[i];
      if (quote == 0 && c == '>') {
        const std::string_view tag = left_.substr(1, i - 1);
        left_.remove_prefix(i + 1);
        return tag;
      }
      if (quote == 0 ? c == '"' || c == '\'' : c == quote) {
        quote = quote == 0 ? c : '\0';
      }
    }
    problem_ = "it is not well-formed SVG";
    return {};
  }

  void read_tag() {
    std::string_view tag = take_tag();
    if (tag.starts_with("!")) {
      problem_ = tag.find('[') == tag.npos ? "" : "declares entities";
      return;
    }
    if (tag.starts_with('/')) {
      const std::string name = core::trimmed(tag.substr(1));
      problem_ = !open_.empty() && open_.back() == name ? "" : "it is not well-formed SVG";
      open_.resize(open_.size() - (problem_.empty() ? 1 : 0));
      return;
    }
    const bool is_closed = tag.ends_with('/');
    tag.remove_suffix(is_closed ? 1 : 0);
    const std::string_view name = tag.substr(0, tag.find_first_of(blanks));
    check_element(local_name(name));
    check_attributes(tag.substr(name.size()));
    if (!is_closed) {
      open_.emplace_back(name);
    }
  }

  void check_element(const std::string& name) {
    if (name == "script" || name == "foreignobject") {
      problem_ = fmt::format("has an element '{}'", name);
    } else if (open_.empty() && (name != "svg" || has_root_)) {
      problem_ = "it is not well-formed SVG";
    }
    has_root_ = true;
  }

  void check_attributes(std::string_view text) {
    while (problem_.empty() && text.find_first_not_of(blanks) != text.npos) {
      const auto equals = text.find('=');
      const auto quoted = text.find_first_not_of(blanks, equals == text.npos ? equals : equals + 1);
      const auto end = quoted == text.npos ? quoted : text.find(text[quoted], quoted + 1);
      if (end == text.npos || (text[quoted] != '"' && text[quoted] != '\'')) {
        problem_ = "it is not well-formed SVG";
        return;
      }
      check_attribute(core::trimmed(text.substr(0, equals)),
                      text.substr(quoted + 1, end - quoted - 1));
      text.remove_prefix(end + 1);
    }
  }

  void check_attribute(const std::string& name, std::string_view value) {
    const std::string local = local_name(name);
    if (local.starts_with("on")) {
      problem_ = fmt::format("has an attribute '{}'", name);
    } else if (!name.starts_with("xmlns") &&
               (((local == "href" || local == "src") && !is_own(value)) || !are_urls_own(value))) {
      problem_ = "refers to other files";
    }
  }

  std::string_view left_;
  std::vector<std::string> open_;  // elements
  bool has_root_{false};
  std::string problem_;
};

struct Kind {
  std::string_view begins;
  std::string_view ends;  // found after everything else, but for what programs append
  std::string_view media_type;
};
constexpr std::array<Kind, 2> kinds{{{"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"sv, "IEND"sv, "image/png"},
                                     {"\xff\xd8\xff"sv, "\xff\xd9"sv, "image/jpeg"}}};

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw core::InvalidInput{fmt::format(
      "{}: is not a picture that is shown (SVG without scripts, PNG or JPEG): {}", file, why)};
}

bool is_svg(std::string_view text) {
  const auto from = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return from != text.npos && text[from] == '<' && text.find("<svg") != text.npos;
}
}  // namespace

std::string_view media_type_of_picture(const std::string& file, const std::string& bytes) {
  if (bytes.size() > max_picture_bytes) {
    refuse(file, fmt::format("it has {} bytes (at most {})", bytes.size(), max_picture_bytes));
  }
  for (const Kind& kind : kinds) {
    if (bytes.starts_with(kind.begins)) {
      if (bytes.find(kind.ends, kind.begins.size()) == bytes.npos) {
        refuse(file, "it breaks off");
      }
      return kind.media_type;
    }
  }
  if (!is_svg(bytes) || !core::is_plain_text(bytes)) {
    refuse(file, "it holds none of these");
  }
  if (const std::string wrong = SvgTags{bytes}.wrong(); !wrong.empty()) {
    refuse(file, wrong);
  }
  return "image/svg+xml";
}
}  // namespace tapstudy::protocols
