#include "analysis/figures/gnuplot.hpp"

#include <sys/wait.h>

#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/error.hpp"
#include "core/output_file.hpp"
namespace tapstudy::analysis {
namespace {
void run_gnuplot(const std::string& script, const std::string& file) {
  FILE* const gnuplot = popen("gnuplot >/dev/null 2>&1", "w");
  const bool is_written =
      gnuplot != nullptr && std::fwrite(script.data(), 1, script.size(), gnuplot) == script.size();
  const int status = gnuplot == nullptr ? -1 : pclose(gnuplot);
  constexpr int not_found = 127;  // of the shell
  if (status != -1 && WIFEXITED(status) && WEXITSTATUS(status) == not_found) {
    throw core::InvalidInput{"figures need gnuplot, which is not installed"};
  }
  if (status != 0 || !is_written) {
    throw core::InvalidInput{file + ": gnuplot could not draw it"};
  }
}

// gnuplot does not report a full disk.
bool is_whole(const std::string& file) {
  std::ifstream stream{file};
  const std::string text{std::istreambuf_iterator<char>{stream}, {}};
  return text.find("</svg>") != std::string::npos;
}
}  // namespace

// Inside single quotes gnuplot reads '' as one quote and has no other escape; a newline would end
// the command, so control characters are replaced.
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
  core::write_new_file(file, [](std::ostream&) {});  // gnuplot does not report why it fails
  try {
    run_gnuplot(script, file);
    if (!is_whole(file)) {
      throw core::InvalidInput{file + ": writing failed (is the disk full?)"};
    }
  } catch (const core::InvalidInput&) {
    std::error_code error;
    std::filesystem::remove(file, error);
    throw;
  }
}
}  // namespace tapstudy::analysis
