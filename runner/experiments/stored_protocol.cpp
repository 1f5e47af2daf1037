#include "runner/experiments/stored_protocol.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "protocols/read_protocol.hpp"
namespace tapstudy::runner {
protocols::Protocol stored_protocol(const results::StudyRow& study) {
  return protocols::parse_protocol(
      {study.protocol_text, study.protocol_file}, [&](const std::string& file) {
        const auto found = std::ranges::find(study.surfaces, file, &results::SurfaceRow::file);
        if (found == study.surfaces.end()) {
          throw core::InvalidInput{file + ": is not stored with the study"};
        }
        return found->bytes;
      });
}
}  // namespace tapstudy::runner
