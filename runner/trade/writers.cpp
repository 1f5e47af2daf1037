#include "runner/trade/writers.hpp"

#include <filesystem>

#include "runner/output_file.hpp"
namespace tapstudy::runner {
void write_files(const std::string& directory, const Trade& trade, const Stability& stability) {
  const auto file = [&](const char* name) {
    return (std::filesystem::path{directory} / name).string();
  };
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  write_new_file(file("trade.csv"), [&](std::ostream& out) { write_csv(out, trade); });
  write_new_file(file("stability.csv"), [&](std::ostream& out) { write_csv(out, stability); });
  write_new_file(file("trade.json"),
                 [&](std::ostream& out) { out << json_of(trade, stability) << '\n'; });
  analysis::draw_svg(figure_of(trade), file("trade.svg"));
}
}  // namespace tapstudy::runner
