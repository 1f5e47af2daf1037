// Studies of several sites, put together on a PostgreSQL server.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "core/files/sha256.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "results/server/assigned_rows.hpp"
#include "results/server/pull.hpp"
#include "results/server/push.hpp"
#include "results/store/store.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
namespace fs = std::filesystem;
constexpr const char* server_help = "postgresql://USER@HOST/DATABASE";

struct SiteOptions {
  std::string study;
  std::string server;
  std::string site;
  std::string participant;
  std::string out;
};

void push(const SiteOptions& options) {
  results::ServerConnection server{options.server};
  Progress progress{"pushing rows of " + options.study};
  const results::Pushed pushed =
      results::push_store(options.study, options.site, server, progress.count());
  if (pushed.other_text) {
    warn(
        fmt::format("{} has '{}' with another text of the protocol, too (SHA-256 {}…, of {}): a "
                    "report takes one of them (--study)",
                    server.name(), pushed.other_text->title,
                    pushed.other_text->protocol_sha256.substr(0, 8), pushed.other_text->site));
  }
  fmt::print("{} of {} rows added: {} has all of {}\n", pushed.rows, pushed.all_rows, server.name(),
             options.study);
}

void pull(const SiteOptions& options) {
  results::ServerConnection server{options.server};
  std::vector<std::string> names;
  core::write_new_directory(options.out, [&](const std::string& unfinished) {
    names = results::pull_study(server, options.study, unfinished);
  });
  for (const std::string& name : names) {
    fmt::print("{}/study.db\n", (fs::path{options.out} / name).string());
  }
}

// Where the study has begun, its own text counts: texts for people may have changed since.
results::StudyOfServer study_of(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    const results::StudyRow study = results::Store::open_existing(path).study();
    return {study.title, study.protocol_sha256};
  }
  const protocols::Protocol protocol = protocols::read_protocol(path);
  return {protocol.title, core::sha256(protocol.text)};
}

void schedule(const SiteOptions& options) {
  check_participant_id("--participant", options.participant);
  const results::StudyOfServer study = study_of(options.study);
  results::ServerConnection server{options.server};
  fmt::print("{}\n", results::assigned_row(study, options.site, options.participant, server));
}
}  // namespace

void add_push(CommandParser& line) {
  Command command = line.add("push", "Add a study's new rows to a PostgreSQL server");
  const auto options = std::make_shared<SiteOptions>();
  command.argument("directory", options->study, "Directory of the study");
  command.argument("server", options->server, server_help);
  command.option("--site", options->site, "Name of this machine among those of the study",
                 Need::required);
  command.on_run([options] { push(*options); });
}

void add_pull(CommandParser& line) {
  Command command = line.add("pull", "Write what all sites have pushed, one directory each");
  const auto options = std::make_shared<SiteOptions>();
  command.argument("server", options->server, server_help);
  command.option("--study", options->study,
                 "Title, or how the SHA-256 of the protocol begins; default: the only one");
  command.option("--out", options->out, "Directory of the directories; nothing is overwritten",
                 Need::required);
  command.on_run([options] { pull(*options); });
}

void add_schedule(CommandParser& line) {
  Command command = line.add(
      "schedule", "Print the row of the balanced orders (run --row) that a participant has");
  const auto options = std::make_shared<SiteOptions>();
  command.argument("study", options->study,
                   "Protocol (YAML), or the study's directory where it has begun");
  command.argument("server", options->server, server_help);
  command.option("--site", options->site, "Name of this machine among those of the study",
                 Need::required);
  command.option("--participant", options->participant, "Participant's id", Need::required);
  command.on_run([options] { schedule(*options); });
}
}  // namespace tapstudy::runner
