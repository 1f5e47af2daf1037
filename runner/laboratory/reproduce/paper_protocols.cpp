#include "runner/laboratory/reproduce/paper_protocols.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>
#include <variant>

#include "core/error.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/laboratory/reproduce/claims.hpp"
namespace tapstudy::runner {
namespace {
using Named = std::pair<std::string_view, std::string_view>;  // file, text
constexpr auto embedded = std::to_array<Named>({
#include "embedded_protocols.inc"
});
}  // namespace

std::string shipped_text(const std::string& file) {
  const auto* const found = std::ranges::find(embedded, file, &Named::first);
  if (found == embedded.end()) {
    throw core::InvalidInput{file + ": is not shipped with this program"};
  }
  return std::string{found->second};
}

protocols::Protocol shipped_protocol(const std::string& file) {
  return protocols::parse_protocol(shipped_text(file), file);
}

const std::vector<Route>& routes() {
  static const std::vector<Route> all{
      {std::string{method::printed}, "protocols/paper/forces.yaml", "aluminium", true},
      {std::string{method::recommended}, "protocols/recommended/forces.yaml", "aluminium"},
      {"5 mm thick", "protocols/recommended/forces_thin.yaml", "aluminium"},
      {"5 mm thick, aluminium of 70 GPa", "protocols/recommended/forces_thin.yaml", "metal", false,
       true},
  };
  return all;
}

std::string modes_command(const std::string& file, const std::string& stimulus) {
  return fmt::format("tapstudy modes {} --stimulus {}", file, stimulus);
}

std::string tap_command(const std::string& file, const std::string& stimulus,
                        const std::string& point, const std::string& options) {
  return fmt::format("tapstudy tap {} --stimulus {} --at {} {}", file, stimulus, point, options);
}

protocols::Protocol with_thin_plates(protocols::Protocol protocol) {
  const auto thin =
      shipped_protocol("protocols/recommended/forces_thin.yaml").plates.begin()->second;
  for (auto& [name, plate] : protocol.plates) {
    protocols::Plate changed = *plate;
    std::get<core::Box>(changed.shape).size_m.z() = std::get<core::Box>(thin->shape).size_m.z();
    changed.mesh = thin->mesh;
    const auto changed_plate = std::make_shared<const protocols::Plate>(changed);
    for (protocols::Stimulus& stimulus : protocol.stimuli) {
      stimulus.plate = stimulus.plate == plate ? changed_plate : stimulus.plate;
    }
    plate = changed_plate;
  }
  return protocol;
}
}  // namespace tapstudy::runner
