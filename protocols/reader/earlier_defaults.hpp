#pragma once
#include <string>

#include "core/model/element_order.hpp"
#include "protocols/reader/read_protocol.hpp"
namespace tapstudy::protocols {
// What keys mean that a study leaves out, where that has changed since it was begun.
struct EarlierDefaults {
  int element_order{core::chosen_order};  // plates.mesh.order
};

// As parse_protocol and read_protocol, of a study that has begun.
Protocol parse_protocol(const StudyText& study, const SurfaceFiles& files,
                        const EarlierDefaults& defaults);
Protocol read_protocol(const std::string& file, const std::string& language,
                       const EarlierDefaults& defaults);
}  // namespace tapstudy::protocols
