#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.hpp"
#include "protocols/tasks/answers.hpp"
#include "runner/session/participants/participant.hpp"
namespace tapstudy::runner {
using Json = nlohmann::ordered_json;

// What a page sends is shallow. A value that is nested deeper would be copied and destroyed by
// recursion, on a small stack. Throws InvalidInput if it is deeper, or no JSON.
inline Json parse_json(const std::string& text) {
  constexpr int max_depth = 4;
  try {
    return Json::parse(text, [](int depth, Json::parse_event_t /*event*/, Json& /*value*/) {
      if (depth > max_depth) {
        throw core::InvalidInput{"is nested too deeply"};
      }
      return true;
    });
  } catch (const Json::exception&) {
    throw core::InvalidInput{"is not JSON"};
  }
}

// Both for both pages.
Json progress_json(const TrialProgress& progress);
// {"kind", "options": [label], "settings", "modulus"}
Json answers_json(const protocols::Answers& answers);
}  // namespace tapstudy::runner
