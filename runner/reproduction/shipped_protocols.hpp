#pragma once
#include <string>

#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// The files below protocols/paper and protocols/recommended, as they were when the program was
// built. Names are from the sources' root: "protocols/paper/forces.yaml".

// Throws InvalidInput if there is none of that name.
std::string shipped_text(const std::string& file);
protocols::Protocol shipped_protocol(const std::string& file);
}  // namespace tapstudy::runner
