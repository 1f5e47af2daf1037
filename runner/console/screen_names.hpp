#pragma once
#include "runner/console/screen.hpp"
namespace tapstudy::runner {
// By which pages know these.
const char* name(ScreenKind kind);
const char* name(Message message);
const char* name(TooEarly::Reason reason);
const char* name(IntervalState::Phase phase);
const char* name(CorrectionState correction);
}  // namespace tapstudy::runner
