// The JSON schemas of the YAML files and the reference of their keys, made from the readers, and
// the SQL of a server's tables, made from the store's.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "core/files/output_files.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "results/server/server_schema.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/commands/key_reference.hpp"
#include "runner/session/devices/rigs.hpp"
namespace tapstudy::runner {
namespace {
struct KeyDocument {
  std::string name;
  std::string file;
  std::string (*text)();
};

std::string reference() {
  return key_reference({protocols::protocol_schema(), rig_schema(), calibration_schema()});
}

const std::vector<KeyDocument>& key_documents() {
  static const std::vector<KeyDocument> table{
      {"protocol", "schema/protocol.schema.json", protocols::protocol_schema},
      {"rig", "schema/rig.schema.json", rig_schema},
      {"calibration", "schema/calibration.schema.json", calibration_schema},
      {"reference", "keys.md", reference}};
  return table;
}
}  // namespace

void write_key_documents(const std::string& directory) {
  std::vector<core::NewFile> files;
  for (const KeyDocument& document : key_documents()) {
    files.push_back({std::filesystem::path{directory} / document.file, document.text()});
  }
  core::write_all_or_none(files, core::Existing::replaced);
}

void add_schema(CommandParser& line) {
  std::vector<std::string> names;
  std::ranges::transform(key_documents(), std::back_inserter(names), &KeyDocument::name);
  const std::string server = "postgresql";
  names.push_back(server);
  auto name = std::make_shared<std::string>();
  Command command = line.add(
      "schema", "Print the JSON schema of a kind of YAML file, or what all their keys mean");
  command.one_of("kind", *name, names,
                 "JSON schema of this kind of file; reference: every key of all, in Markdown; "
                 "postgresql: the SQL of a server's tables (push)");
  command.on_run([name, server] {
    fmt::print("{}", *name == server
                         ? results::server_schema_sql()
                         : std::ranges::find(key_documents(), *name, &KeyDocument::name)->text());
  });
}
}  // namespace tapstudy::runner
