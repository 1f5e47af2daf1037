#pragma once
#include <string>
#include <vector>

#include "core/placement.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// What is drawn of the plates: neutral shapes, the same for every material and technique. Numbered,
// so that a page loads each once. In the plate frame, moved so that a box's origin is the middle of
// its upper face.
class Scenes {
 public:
  explicit Scenes(const protocols::Protocol& protocol);
  int number_of(const std::string& stimulus) const;
  int count() const { return static_cast<int>(all_.size()); }
  const std::string& json(int number) const { return at(number).json; }
  double surface_along_normal_m() const;  // device frame
  core::Vec3 to_scene(int number, const core::Vec3& device_position_m) const;

 private:
  struct Scene {
    const protocols::Plate* plate;
    core::Placement placement;
    std::string json;
  };
  const Scene& at(int number) const { return all_.at(static_cast<std::size_t>(number)); }
  const protocols::Protocol& protocol_;
  std::vector<Scene> all_;
};
}  // namespace tapstudy::runner
