#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "core/error.hpp"
#include "device/hand/prescribed_hand.hpp"
#include "protocols/yaml/yaml_reader.hpp"
#include "results/store/store.hpp"
#include "runner/session/devices/device_kind.hpp"
namespace tapstudy::runner {
namespace {
struct ReplaySection final : protocols::DeviceSection {
  std::string directory;  // of the study that holds the trial
  std::int64_t trial_id{};
};

class ReplayedDevice final : public SessionDevice {
 public:
  explicit ReplayedDevice(device::ReplayHand hand) : hand_{std::move(hand)} {}
  device::Device& device() override { return hand_; }
  void get_ready() override { hand_.rewind(); }

 private:
  device::ReplayHand hand_;
};

// The hand of a stored trial. A tick with a fault has no position to go to.
device::ReplayHand hand_of(const ReplaySection& section) {
  const std::vector<core::TraceSample> trace =
      results::Store::open_existing(section.directory).trace(section.trial_id);
  std::string source = fmt::format("trial {} of {}", section.trial_id, section.directory);
  std::vector<core::HandState> states;
  states.reserve(trace.size());
  for (const core::TraceSample& sample : trace) {
    if (sample.fault == core::TickFault::none) {
      states.push_back(
          {core::Vec3{sample.position_m[0], sample.position_m[1], sample.position_m[2]},
           core::Vec3{sample.velocity_m_s[0], sample.velocity_m_s[1], sample.velocity_m_s[2]}});
    }
  }
  if (states.empty()) {
    throw core::InvalidInput{"rig: replay: there is no trace of " + source};
  }
  return {std::move(states), std::move(source)};
}

class ReplayKind final : public DeviceKind {
 public:
  std::string_view name() const override { return "replay"; }
  bool has_hardware() const override { return false; }
  bool has_participant() const override { return false; }
  std::shared_ptr<const protocols::DeviceSection> read_section(
      protocols::MapReader& top, const protocols::RigText& rig) const override {
    auto section = std::make_shared<ReplaySection>();
    top.map({"replay", "replays the hand of a stored trial",
             "replay: {directory: my_study, trial_id: 1}"},
            protocols::MapReader::Presence::required, [&](protocols::MapReader& reader) {
              section->directory =
                  (std::filesystem::path{rig.directory} /
                   reader.text(
                       {"directory", "study that contains the trial; path relative to the rig"}))
                      .string();
              section->trial_id = reader.integer({"trial_id", "number of the trial in the study"},
                                                 1, 2'000'000'000);
            });
    return section;
  }
  std::unique_ptr<SessionDevice> open(const DeviceRequest& request) const override {
    return std::make_unique<ReplayedDevice>(
        hand_of(dynamic_cast<const ReplaySection&>(*request.rig.section)));
  }
};
}  // namespace

const DeviceKind& replayed_hand() {
  static const ReplayKind kind;
  return kind;
}
}  // namespace tapstudy::runner
