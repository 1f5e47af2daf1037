#include "analysis/gnuplot.hpp"

#include <cctype>
#include <cstdio>
#include <filesystem>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
void run_gnuplot(const std::string& script) {
  FILE* const gnuplot = popen("gnuplot >/dev/null 2>&1", "w");
  const bool is_written =
      gnuplot != nullptr && std::fwrite(script.data(), 1, script.size(), gnuplot) == script.size();
  if (gnuplot == nullptr || pclose(gnuplot) != 0 || !is_written) {
    throw core::InvalidInput{"figures need gnuplot, which is not installed or failed"};
  }
}
}  // namespace

// gnuplot reads '' inside a single-quoted text as one quote and knows no other escape; a line's end
// would end the command, so no control character gets through.
std::string quoted(const std::string& text) {
  std::string safe{"'"};
  for (const char c : text) {
    if (c == '\'') {
      safe += "''";
    } else {
      safe += std::iscntrl(static_cast<unsigned char>(c)) != 0 ? ' ' : c;
    }
  }
  return safe + "'";
}

void draw_with_gnuplot(const std::string& script, const std::string& file) {
  std::error_code error;
  if (std::filesystem::exists(file, error)) {
    throw core::InvalidInput{file + ": exists already and is not overwritten"};
  }
  run_gnuplot(script);
  if (std::filesystem::file_size(file, error) == 0 || error) {
    throw core::InvalidInput{file + ": cannot be written"};
  }
}
}  // namespace tapstudy::analysis
