#pragma once
#include <nlohmann/json_fwd.hpp>

#include "protocols/tasks/answers.hpp"
namespace tapstudy::runner {
// {"kind", "options": [label], "settings", "modulus"}, for both pages.
nlohmann::ordered_json answers_json(const protocols::Answers& answers);
}  // namespace tapstudy::runner
