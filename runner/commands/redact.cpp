#include <fmt/format.h>

#include <memory>
#include <set>

#include "core/files/output_files.hpp"
#include "results/store/redacted_copy.hpp"
#include "results/store/store.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/studies/stored_study.hpp"
namespace tapstudy::runner {
namespace {
struct RedactOptions {
  std::string directory;
  std::string out;
  std::string prefix{results::Redaction{}.prefix};
};

// Numbers, scales and choices; what the protocol does not have is taken for text.
std::set<std::pair<std::string, std::string>> items_without_text(
    const protocols::Protocol& protocol) {
  std::set<std::pair<std::string, std::string>> items;
  for (const auto& [name, form] : protocol.forms) {
    for (const protocols::FormItem& item : form.items) {
      if (item.kind != protocols::ItemKind::text) {
        items.emplace(name, item.name);
      }
    }
  }
  return items;
}

void redact(const RedactOptions& options) {
  core::check_is_new(options.out);
  check_participant_id("--prefix", options.prefix + "-001");
  results::Store store = results::Store::open_existing(options.directory);
  const protocols::Protocol protocol = checked_protocol(store);
  core::write_new_directory(options.out, [&](const std::string& unfinished) {
    results::write_redacted_copy(options.directory, unfinished,
                                 {items_without_text(protocol), options.prefix});
  });
  fmt::print(
      "{}: participants are called {}-001 and so on; operators' words and free text are "
      "removed, the journal is written anew\n"
      "kept: the protocol, rigs, dates, other answers to questionnaires, traces\n",
      options.out, options.prefix);
}
}  // namespace

void add_redact(CommandParser& line) {
  Command command = line.add(
      "redact", "Copy a study without participants' names, operators' notes and free text");
  const auto options = std::make_shared<RedactOptions>();
  command.argument("directory", options->directory, "Directory of a study", Need::required);
  command.option("--out", options->out, "Directory of the copy; nothing is overwritten",
                 Need::required);
  command.option_with_default(
      "--prefix", options->prefix,
      "What participants are called before their number; one for each site of a study");
  command.on_run([options] { redact(*options); });
}
}  // namespace tapstudy::runner
