#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "protocols/rig.hpp"
namespace tapstudy::protocols {
class MapReader;

// The base directory of a section's file names, and the rig's source text, to which the contents of
// other files are appended.
struct RigText {
  std::string directory;
  std::string* text{};
};

// A kind of device as the reader of rigs sees it. The kinds themselves are in runner/devices.
class RigDevice {
 public:
  virtual ~RigDevice() = default;
  virtual std::string_view name() const = 0;  // in rigs
  // Whether it exerts force on a person's hand: then the rig must limit the hand's motion.
  virtual bool has_hardware() const = 0;
  // Reads its section of the rig, if it has one; problems go to the reader.
  virtual std::shared_ptr<const DeviceSection> read_section(MapReader& top,
                                                            const RigText& rig) const = 0;
};
}  // namespace tapstudy::protocols
