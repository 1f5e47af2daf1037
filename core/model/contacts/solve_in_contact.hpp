#pragma once
#include "core/model/body_modes.hpp"
namespace tapstudy::core {
// The modes of a body together with those that it touches (body.contacts), and its own part of
// their shapes. All bodies are one eigenproblem, not each one's modes coupled (component mode
// synthesis, Craig & Bampton 1968): nothing is truncated, and the count of modes is proved as that
// of a body alone. Throws ModelError as solve_body.
SolvedBody solve_in_contact(const BodySpec& body, const ProgressHook& progress);
}  // namespace tapstudy::core
