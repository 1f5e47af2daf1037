// The JSON schemas of the YAML files and the reference of their keys, made from the readers.
#include <fmt/format.h>

#include <memory>

#include "core/error.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/commands/key_reference.hpp"
#include "runner/session/devices/rigs.hpp"
namespace tapstudy::runner {
namespace {
struct SchemaOptions {
  std::string file_type;
  bool wants_reference{false};
};

void run_schema(const SchemaOptions& options) {
  if (options.wants_reference) {
    fmt::print("{}",
               key_reference({protocols::protocol_schema(), rig_schema(), calibration_schema()}));
  } else if (options.file_type == "protocol") {
    fmt::print("{}\n", protocols::protocol_schema());
  } else if (options.file_type == "rig") {
    fmt::print("{}\n", rig_schema());
  } else if (options.file_type == "calibration") {
    fmt::print("{}\n", calibration_schema());
  } else {
    throw core::InvalidInput{"schema: give protocol, rig, calibration, or --reference"};
  }
}
}  // namespace

void add_schema(CommandParser& line) {
  auto options = std::make_shared<SchemaOptions>();
  Command command =
      line.add("schema", "Print the JSON schema of a YAML file, or the reference of all keys");
  command.argument("file_type", options->file_type, "protocol, rig or calibration", Need::optional);
  command.flag("--reference", options->wants_reference, "The reference, in Markdown");
  command.on_run([options] { run_schema(*options); });
}
}  // namespace tapstudy::runner
