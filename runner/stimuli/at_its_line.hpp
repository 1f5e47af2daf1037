#pragma once
#include <fmt/format.h>

#include "core/error.hpp"
#include "protocols/axes/presented_stimulus.hpp"
namespace tapstudy::runner {
// Builds something of a stimulus's model. A ModelError names the protocol's line at fault, the
// stimulus and the values at which it is presented.
template <class Build>
auto at_its_line(const protocols::PresentedStimulus& stimulus, const Build& build) {
  const auto told = [&](const std::string& stated_at, const core::ModelError& error) {
    return core::ModelError{fmt::format("{}: {}: {}", stated_at, stimulus.title(), error.what())};
  };
  try {
    return build();
  } catch (const core::DampingError& error) {
    throw told(stimulus.material->damping_stated_at, error);
  } catch (const core::ModelError& error) {
    // what can be built as stated, and not at these values, is the fault of the values
    throw told(stimulus.changed.empty() ? stimulus.plate->stated_at : stimulus.vary_stated_at,
               error);
  }
}
}  // namespace tapstudy::runner
