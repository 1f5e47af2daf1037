#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// What is drawn of the plates: neutral shapes, the same for every material and technique. Numbered,
// so that a page loads each once. In the plate frame, moved so that a box's origin is the middle of
// its upper face.
class Scenes {
 public:
  // placement: of the protocol, or of the rig where that has its own.
  Scenes(const protocols::Protocol& protocol, const core::Placement& placement);
  // nullopt where the block's plates look different, or vary in size: the picture would tell which
  // one it is, or be wrong.
  std::optional<int> number_of(const std::string& stimulus, const protocols::Block& block) const;
  int count() const { return static_cast<int>(all_.size()); }
  const std::string& json(int number) const { return at(number).json; }
  double surface_along_normal_m() const;  // device frame
  const core::Placement& placement() const { return placement_; }
  core::Vec3 to_scene(int number, const core::Vec3& device_position_m) const;

 private:
  struct Scene {
    const protocols::Plate* plate;
    core::Placement placement;
    std::string json;
    std::string shape;  // the same without fixations, which are drawn only where the study says so
  };
  int place_of(const std::string& stimulus) const;
  const Scene& at(int number) const { return all_.at(static_cast<std::size_t>(number)); }
  const protocols::Protocol& protocol_;
  core::Placement placement_;
  std::vector<Scene> all_;
  std::set<std::string> varying_;  // stimuli whose size varies
};
}  // namespace tapstudy::runner
