#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "protocols/rig.hpp"
namespace tapstudy::protocols {
class MapReader;

// Where a section's file names start from, and the text that the rig was read from, to which what
// is read from other files is added.
struct RigText {
  std::string directory;
  std::string* text{};
};

// A kind of device as the reader of rigs sees it. The kinds themselves are in runner/devices.
class RigDevice {
 public:
  virtual ~RigDevice() = default;
  virtual std::string_view name() const = 0;  // in rigs and stores
  // Whether it pushes on a person's hand: then the rig must limit that hand's motion.
  virtual bool has_hardware() const = 0;
  // Reads its section of the rig, if it has one; problems go to the reader.
  virtual std::shared_ptr<const DeviceSection> read_section(MapReader& top,
                                                            const RigText& rig) const = 0;
};
}  // namespace tapstudy::protocols
