#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "core/error.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/laboratory/trade/trade_report.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
struct TradeOptions {
  std::string protocol;
  std::string stimulus;
  Tolerance tolerance;
  bool is_quick{false};
  bool wants_json{false};
  std::string out;
};

// A range check accepts NaN.
void check(const Tolerance& tolerance) {
  if (std::isnan(tolerance.frequency) || std::isnan(tolerance.level_db)) {
    throw core::InvalidInput{"--frequency-tolerance, --level-tolerance-db: must be numbers"};
  }
}

void run_trade(const TradeOptions& options) {
  const protocols::Protocol protocol = protocols::read_protocol(options.protocol);
  if (protocol.rendering.crossover) {
    throw core::InvalidInput{
        "trade measures what one device renders: the protocol has rendering.crossover_hz"};
  }
  const protocols::Stimulus& stimulus = protocol.stimulus(options.stimulus);
  check(options.tolerance);
  if (!options.out.empty()) {
    create_trade_directory(options.out);
  }
  Progress progress{fmt::format("measuring '{}'", options.stimulus)};
  const Trade trade = at_its_line(protocols::stimulus_with(protocol, stimulus), [&] {
    return measure_trade(protocol, stimulus, options.tolerance,
                         options.is_quick ? Effort::quick : Effort::full, progress.hook());
  });
  const Stability stability = measure_stability(protocol, stimulus, progress.hook());
  if (!options.out.empty()) {
    write_files(options.out, trade, stability);
  }
  if (options.wants_json) {
    fmt::print("{}\n", json_of(trade, stability));
  } else {
    print(trade, stability, options.out);
  }
}
}  // namespace

void add_trade(CommandParser& line) {
  Command command = line.add("trade", "Speed against accuracy, and stability at extreme values");
  const auto options = std::make_shared<TradeOptions>();
  command.shipped_file("protocol", options->protocol, "Study (YAML)");
  command.option("--stimulus", options->stimulus, "Which stimulus", Need::required);
  command.number_within("--frequency-tolerance", options->tolerance.frequency, 1e-6, 10.0,
                        "Largest relative error of a natural frequency");
  command.number_within("--level-tolerance-db", options->tolerance.level_db, 1e-6, 100.0,
                        "Largest error of the vibration's level");
  command.flag("--quick", options->is_quick,
               "Without the finest mesh: less accurate, about ten times faster");
  command.flag("--json", options->wants_json, "Output as JSON");
  command.option("--out", options->out,
                 "Write trade.csv, trade.json, trade.svg and stability.csv into this directory");
  command.on_run([options] { run_trade(*options); });
}
}  // namespace tapstudy::runner
