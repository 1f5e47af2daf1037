#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>

#include "core/files/sha256.hpp"
#include "core/text/hexadecimal.hpp"
#include "results/compression.hpp"
#include "results/journal/journal.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
using Json = nlohmann::ordered_json;
constexpr const char* format = "tapstudy-journal/4";
constexpr std::string_view chain_key = ",\"chain\":\"";

// Bytes that are not UTF-8 become replacement characters: the journal is text.
std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}
template <class Value>
std::optional<Value> optional_of(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional{json.get<Value>()};
}

StudyRow study_from(const Json& line) {
  if (line.at("format") != format) {
    throw StoreError{"is not in a format that this program reads"};
  }
  StudyRow study{line.at("title"),
                 line.at("protocol_file"),
                 line.at("protocol_text"),
                 line.at("protocol_sha256"),
                 {}};
  for (const Json& surface : line.at("surfaces")) {
    const auto bytes = decompressed(core::from_hex(surface.at("zstd_hex").get<std::string>()),
                                    surface.at("size"), surface.at("file").get<std::string>());
    SurfaceRow row{surface.at("file"), surface.at("sha256"), {}};
    std::ranges::transform(bytes, std::back_inserter(row.bytes), std::to_integer<char>);
    study.surfaces.push_back(std::move(row));
  }
  return study;
}

SessionRow session_from(const Json& line) {
  SessionRow session;
  session.id = line.at("session_id");
  session.participant_id = line.at("participant_id");
  session.participant_index = line.at("participant_index");
  session.order_index = line.at("order_index");
  session.mode = mode_from(line.at("mode"));
  session.seed = line.at("seed");
  session.planned_order = line.at("planned_order");
  session.language = line.at("language");
  session.resumes = optional_of<std::int64_t>(line.at("resumes"));
  session.rate_hz = line.at("rate_hz");
  session.rig_text = line.at("rig_text");
  session.device = line.at("device");
  session.scheduler = line.at("scheduler");
  session.doctor = line.at("doctor");
  session.program_version = line.at("program_version");
  session.git_hash = line.at("git_hash");
  session.compiler = line.at("compiler");
  session.started_utc = line.at("started_utc");
  if (line.contains("group")) {
    session.group = group_from(line.at("group"), line.at("group_assignment"));
  }
  if (line.contains("planned_session")) {
    session.planned_session = line.at("planned_session");
  }
  if (line.contains("protocol_text")) {
    session.protocol_text = line.at("protocol_text");
  }
  return session;
}

JournalledAnswer answer_from(const Json& line) {
  JournalledAnswer answer;
  constexpr TrialStatus status = TrialStatus::answered;
  answer.trial = {
      line.at("session_id"), line.at("number"),      line.at("attempt"),         line.at("block"),
      line.at("task"),       line.at("is_practice"), line.at("repetition"),      status,
      line.at("duration_s"), line.at("is_catch"),    line.at("is_of_real_plate")};
  for (const Json& alternative : line.at("alternatives")) {
    answer.alternatives.push_back({static_cast<int>(answer.alternatives.size()),
                                   alternative.at("label"), alternative.at("stimulus"),
                                   alternative.at("axis_values"), alternative.at("is_comparison")});
  }
  answer.response = {line.at("response"), optional_of<bool>(line.at("is_correct")),
                     line.at("response_time_s"),
                     optional_of<double>(line.at("time_from_first_contact_s")),
                     optional_of<int>(line.at("confidence"))};
  return answer;
}

void add_line(const Json& line, JournalContent& content) {
  const std::string kind = line.at("kind");
  if (kind == "study" && !content.study.protocol_text.empty()) {
    throw StoreError{"begins a second study"};
  }
  if (kind == "study") {
    content.study = study_from(line);
  } else if (kind == "session") {
    content.sessions.push_back(session_from(line));
  } else if (kind == "answer") {
    content.entries.answers.push_back(answer_from(line));
  } else if (kind == "correction") {
    content.entries.corrections.push_back({line.at("session_id"), line.at("number"),
                                           line.at("response"),
                                           optional_of<bool>(line.at("is_correct")),
                                           given_by_from(line.at("given_by")), line.at("ordinal")});
  } else if (kind == "form_answer") {
    content.entries.form_answers.push_back({line.at("session_id"), line.at("t_s"), line.at("form"),
                                            line.at("asked"), line.at("item"),
                                            optional_of<std::string>(line.at("answer"))});
  } else if (kind == "operator_action") {
    content.entries.actions.push_back({line.at("session_id"), line.at("t_s"), line.at("action"),
                                       optional_of<int>(line.at("number")), line.at("detail")});
  } else {
    throw StoreError{"is of an unknown kind"};
  }
}
}  // namespace

JournalLine split_line(const std::string& line) {
  const auto at = line.rfind(chain_key);
  if (at == std::string::npos || !line.ends_with("\"}")) {
    return {line, ""};
  }
  const std::size_t chain_at = at + chain_key.size();
  return {line.substr(0, at) + "}", line.substr(chain_at, line.size() - chain_at - 2)};
}

std::string join_line(const JournalLine& line) {
  return fmt::format("{}{}{}\"}}", line.body.substr(0, line.body.size() - 1), chain_key,
                     line.chain);
}

std::string chain_of(const std::string& chain_before, const std::string& body) {
  return core::sha256(chain_before + body);
}

std::string to_line(const StudyRow& study) {
  Json line{{"kind", "study"},
            {"format", format},
            {"title", study.title},
            {"protocol_file", study.protocol_file},
            {"protocol_sha256", study.protocol_sha256},
            {"protocol_text", study.protocol_text},
            {"surfaces", Json::array()}};
  for (const SurfaceRow& surface : study.surfaces) {
    line["surfaces"].push_back(
        {{"file", surface.file},
         {"sha256", surface.sha256},
         {"size", surface.bytes.size()},
         {"zstd_hex", core::to_hex(compressed(std::as_bytes(std::span{surface.bytes})))}});
  }
  return dumped(line);
}

std::string to_line(const SessionRow& session) {
  Json line{{"kind", "session"},
            {"session_id", session.id},
            {"participant_id", session.participant_id},
            {"mode", to_text(session.mode)},
            {"participant_index", session.participant_index},
            {"order_index", session.order_index},
            {"seed", session.seed},
            {"resumes", or_null(session.resumes)},
            {"started_utc", session.started_utc},
            {"rate_hz", session.rate_hz},
            {"device", session.device},
            {"scheduler", session.scheduler},
            {"program_version", session.program_version},
            {"git_hash", session.git_hash},
            {"compiler", session.compiler},
            {"planned_order", session.planned_order},
            {"language", session.language},
            {"rig_text", session.rig_text},
            {"doctor", session.doctor}};
  if (session.group) {
    line["group"] = session.group->name;
    line["group_assignment"] = assignment_of(*session.group);
  }
  if (session.planned_session) {
    line["planned_session"] = *session.planned_session;
  }
  if (session.protocol_text) {
    line["protocol_text"] = *session.protocol_text;
  }
  return dumped(line);
}

namespace {
std::string to_line(const JournalledAnswer& answer) {
  Json alternatives = Json::array();
  for (const AlternativeRow& alternative : answer.alternatives) {
    alternatives.push_back({{"label", alternative.label},
                            {"stimulus", alternative.stimulus},
                            {"axis_values", alternative.axis_values},
                            {"is_comparison", alternative.is_comparison}});
  }
  return dumped({{"kind", "answer"},
                 {"session_id", answer.trial.session_id},
                 {"number", answer.trial.number},
                 {"attempt", answer.trial.attempt},
                 {"block", answer.trial.block},
                 {"task", answer.trial.task},
                 {"is_practice", answer.trial.is_practice},
                 {"is_catch", answer.trial.is_catch},
                 {"is_of_real_plate", answer.trial.is_of_real_plate},
                 {"repetition", answer.trial.repetition},
                 {"duration_s", answer.trial.duration_s},
                 {"alternatives", alternatives},
                 {"response", answer.response.response},
                 {"is_correct", or_null(answer.response.is_correct)},
                 {"response_time_s", answer.response.response_time_s},
                 {"time_from_first_contact_s", or_null(answer.response.time_from_first_contact_s)},
                 {"confidence", or_null(answer.response.confidence)}});
}

std::string to_line(const CorrectionRow& correction) {
  return dumped({{"kind", "correction"},
                 {"session_id", correction.session_id},
                 {"number", correction.number},
                 {"ordinal", correction.ordinal},
                 {"given_by", to_text(correction.given_by)},
                 {"response", correction.response},
                 {"is_correct", or_null(correction.is_correct)}});
}

std::string to_line(const OperatorActionRow& action) {
  return dumped({{"kind", "operator_action"},
                 {"session_id", action.session_id},
                 {"t_s", action.t_s},
                 {"action", action.action},
                 {"number", or_null(action.number)},
                 {"detail", action.detail}});
}

std::string to_line(const FormAnswerRow& answer) {
  return dumped({{"kind", "form_answer"},
                 {"session_id", answer.session_id},
                 {"t_s", answer.t_s},
                 {"form", answer.form},
                 {"asked", answer.asked},
                 {"item", answer.item},
                 {"answer", or_null(answer.answer)}});
}
}  // namespace

std::vector<std::string> to_lines(const JournalEntries& entries) {
  std::vector<std::string> lines;
  const auto add = [&](const auto& rows) {
    std::ranges::transform(rows, std::back_inserter(lines),
                           [](const auto& row) { return to_line(row); });
  };
  add(entries.answers);
  add(entries.corrections);
  add(entries.actions);
  add(entries.form_answers);
  return lines;
}

JournalContent read_journal(const std::string& directory) {
  const std::string file = journal_file(directory);
  std::ifstream stream{file};
  if (!stream) {
    throw StoreError{file + ": cannot be read"};
  }
  JournalContent content;
  std::string chain;
  int number = 0;
  for (std::string text; std::getline(stream, text) && !stream.eof();) {
    ++number;
    const JournalLine line = split_line(text);
    if (line.chain != chain_of(chain, line.body)) {
      throw StoreError{fmt::format(
          "{}, line {}: was changed, or a line before it was (hash chain broken)", file, number)};
    }
    chain = line.chain;
    try {
      add_line(Json::parse(line.body), content);
    } catch (const StoreError& error) {
      throw StoreError{fmt::format("{}, line {}: {}", file, number, error.what())};
    } catch (const Json::exception&) {
      throw StoreError{
          fmt::format("{}, line {}: is not a line as tapstudy writes it", file, number)};
    }
  }
  if (content.study.protocol_text.empty()) {
    throw StoreError{file + ": names no study"};
  }
  return content;
}

namespace {
void add_to_summary(const std::string& line, JournalSummary& summary) {
  constexpr std::string_view hash_key = "\"protocol_sha256\":\"";
  const auto hash_at = line.find(hash_key);
  if (!summary.has_lines && hash_at != std::string::npos) {  // not parsed: it has all surfaces
    const std::size_t begin = hash_at + hash_key.size();
    summary.protocol_sha256 = line.substr(begin, line.find('"', begin) - begin);
  }
  summary.has_lines = true;
  summary.answers += line.starts_with(R"({"kind":"answer")") ? 1U : 0U;
  if (!line.starts_with(R"({"kind":"session")")) {
    return;
  }
  try {
    const Json json = Json::parse(line);
    SessionRow session;
    session.id = json.at("session_id");
    session.participant_id = json.at("participant_id");
    session.seed = json.at("seed");
    session.started_utc = json.at("started_utc");
    summary.sessions.push_back(std::move(session));
  } catch (const Json::exception&) {  // NOLINT(bugprone-empty-catch): whoever reads it all says so
  }
}
}  // namespace

JournalSummary summary_of_journal(const std::string& directory) {
  std::ifstream stream{journal_file(directory)};
  JournalSummary summary;
  for (std::string line; std::getline(stream, line) && !stream.eof();) {
    add_to_summary(line, summary);
  }
  return summary;
}

std::string where_answers_are(const std::string& database_file) {
  const std::string directory = std::filesystem::path{database_file}.parent_path().string();
  const JournalSummary journal = summary_of_journal(directory);
  std::error_code error;
  const bool is_in_the_way = std::filesystem::exists(database_file, error);
  return journal.has_lines
             ? fmt::format(
                   "; {} holds what was answered ({} answers to trials): {} `tapstudy report {}` "
                   "reads it (a new study needs another --out)",
                   journal_file(directory), journal.answers,
                   is_in_the_way ? "move study.db to another folder, and" : "put study.db back, or",
                   directory)
             : "";
}

namespace {
// The keys whose values the two lines have not both.
std::string differing_keys(const std::string& one, const std::string& other) {
  const nlohmann::ordered_json first = nlohmann::ordered_json::parse(one);
  const nlohmann::ordered_json second = nlohmann::ordered_json::parse(other);
  std::vector<std::string> keys;
  for (const auto& [key, value] : first.items()) {
    if (!second.contains(key) || second.at(key) != value) {
      keys.push_back(key);
    }
  }
  for (const auto& [key, value] : second.items()) {
    if (!first.contains(key)) {
      keys.push_back(key);
    }
  }
  return fmt::format("{}", fmt::join(keys, ", "));
}

}  // namespace

std::vector<std::string> differing_study_and_sessions(const StudyRow& study,
                                                      const std::vector<SessionRow>& sessions,
                                                      const JournalContent& journal) {
  std::vector<std::string> differences;
  if (core::sha256(study.protocol_text) != study.protocol_sha256) {
    differences.emplace_back("study: protocol_sha256 is not that of protocol_text");
  }
  if (const auto keys = differing_keys(to_line(study), to_line(journal.study)); !keys.empty()) {
    differences.push_back(fmt::format("study: {} not as in answers.journal", keys));
  }
  for (const SessionRow& journalled : journal.sessions) {
    const auto stored = std::ranges::find(sessions, journalled.id, &SessionRow::id);
    if (stored == sessions.end()) {
      differences.push_back(fmt::format("session {}: missing in study.db", journalled.id));
    } else if (const auto keys = differing_keys(to_line(*stored), to_line(journalled));
               !keys.empty()) {
      differences.push_back(fmt::format("session {} (participant {}): {} not as in answers.journal",
                                        journalled.id, journalled.participant_id, keys));
    }
  }
  for (const SessionRow& session : sessions) {
    if (std::ranges::find(journal.sessions, session.id, &SessionRow::id) ==
        journal.sessions.end()) {
      differences.push_back(fmt::format("session {} (participant {}): not in answers.journal",
                                        session.id, session.participant_id));
    }
  }
  return differences;
}
}  // namespace tapstudy::results
