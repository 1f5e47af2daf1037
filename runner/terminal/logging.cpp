#include "runner/terminal/logging.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
namespace tapstudy::runner {
void set_up_logging() {
  auto logger = spdlog::stderr_color_mt("tapstudy");
  logger->set_pattern("tapstudy: %^%v%$");
  spdlog::set_default_logger(logger);
}

void warn(const std::string& what) {
  spdlog::warn("{}", what);
}
}  // namespace tapstudy::runner
