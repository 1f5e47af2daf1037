#include "runner/session/engine/open_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/reader/earlier_defaults.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
using protocols::ChangedText;
using protocols::ChangesOfFile;
using protocols::Protocol;
namespace {
// A text of the same study, with the files that the study has.
Protocol parsed(const std::string& text, const results::StudyRow& study) {
  const protocols::ReadFile stored = files_of(study);
  return protocols::parse_protocol({text, "the study's protocol"}, {stored, stored}, {});
}

ChangesOfFile changes(const Protocol& before, const Protocol& now) {
  return protocols::changes_between({before.text, before.translations},
                                    {now.text, now.translations});
}

std::string quoted_text(const std::string& text) {
  constexpr std::size_t longest = 120;
  return text.empty() ? "nothing" : "'" + core::shortened(text, longest) + "'";
}

void refuse_other_data(const std::vector<std::string>& keys, const std::string& directory,
                       const results::StudyRow& stored) {
  constexpr std::size_t max_named = 8;
  const std::size_t named = std::min(keys.size(), max_named);
  throw core::InvalidInput{fmt::format(
      "{}: holds the study of another protocol, '{}', from which this one differs in {}{} (choose "
      "another --out; in a running study, only texts for people may change)",
      (std::filesystem::path{directory} / "study.db").string(), stored.title,
      fmt::join(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(named), ", "),
      keys.size() > named ? fmt::format(" and {} more keys", keys.size() - named) : "")};
}

void say_what_changed(const std::vector<ChangedText>& texts) {
  std::string lines = texts.empty()
                          ? "the protocol is written otherwise and says the same"
                          : "the protocol has other texts than in the session before; they are "
                            "stored with the sessions from now on:";
  for (const ChangedText& text : texts) {
    lines += fmt::format("\n  {} (line {})\n    before: {}\n    now:    {}", text.key,
                         text.line_now, quoted_text(text.before), quoted_text(text.now));
  }
  warn(lines);
}
}  // namespace

ChangesOfFile changes_in(const Protocol& of_study, const std::string& later_text) {
  return changes(of_study, parsed(later_text, study_row(of_study, "")));
}

std::string described(const ChangedText& text) {
  return fmt::format("{} is now {} (before: {})", text.key, quoted_text(text.now),
                     quoted_text(text.before));
}

results::Store open_study(const std::string& directory, const Protocol& protocol,
                          const std::string& protocol_file) {
  const auto accept = [&](const results::StudyRow& stored, const std::string& latest_text) {
    const ChangesOfFile since_begin = changes(parsed(stored.protocol_text, stored), protocol);
    if (!since_begin.data_keys.empty()) {
      refuse_other_data(since_begin.data_keys, directory, stored);
    }
    if (latest_text != protocol.text) {
      say_what_changed(changes(parsed(latest_text, stored), protocol).texts);
    }
  };
  return results::Store::open_or_create(directory, study_row(protocol, protocol_file), accept);
}
}  // namespace tapstudy::runner
