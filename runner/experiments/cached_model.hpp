#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/model/modal_model.hpp"
#include "core/model/model_cache.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
struct CachedModel {
  core::ModalModel modal;    // the modes in the band
  core::ModelReport report;  // of the body that it is scaled from
};
// Of a stimulus at its own values; nullopt: not in the cache. Nothing is computed but the scaling.
std::optional<CachedModel> cached_model(const protocols::Protocol& protocol,
                                        const protocols::Stimulus& stimulus,
                                        const core::ModelCache& cache);

// The key under which the protocol has a plate or material; empty: none.
template <class Named>
std::string name_in(const std::map<std::string, std::shared_ptr<const Named>>& all,
                    const std::shared_ptr<const Named>& wanted) {
  for (const auto& [name, one] : all) {
    if (one == wanted) {
      return name;
    }
  }
  return {};
}
}  // namespace tapstudy::runner
