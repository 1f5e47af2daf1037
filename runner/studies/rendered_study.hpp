#pragma once
#include <vector>

#include "analysis/report/study/rendered.hpp"
#include "protocols/protocol.hpp"
#include "runner/studies/stored_study.hpp"
namespace tapstudy::runner {
// The stimuli that were rendered in words, with those of their models that are cached, and the taps
// of all trials whose answers count, out of the stored traces. Traces are read once and not kept.
analysis::RenderedStudy rendered_study(const protocols::Protocol& protocol,
                                       const std::vector<StudyStore>& stores, results::Mode mode,
                                       const DoneBlocks& done);
}  // namespace tapstudy::runner
