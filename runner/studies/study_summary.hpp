#pragma once
#include <string>
#include <vector>

#include "analysis/report/document/block_design.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/report/summary.hpp"
#include "protocols/protocol.hpp"
#include "results/rows.hpp"
#include "results/store/store.hpp"
#include "runner/studies/mixed_models/fit_in_r.hpp"
#include "runner/studies/stored_study.hpp"
namespace tapstudy::runner {
// Where a study's report lies, beside study.db.
inline constexpr const char* report_folder = "report";

// The part of a protocol that a report of these participants needs.
analysis::StudyDesign design_of(const protocols::Protocol& protocol, results::Mode mode);

enum class Detail { all, main_results };  // of a report, or of a simulated design

// The results of a study for its participants of one mode; those who were excluded, practice and
// catch trials are named, and left out of the results. only: the names of blocks and sections that
// are asked for (empty: all); what neither they nor declared hypotheses need is not computed.
// Throws InvalidInput if there is no answer, two stores are of different protocols, a participant
// is in two of them, or a name is none. Without fit_mixed_models there are none.
analysis::Summary summary_of_study(const std::vector<StudyStore>& stores, results::Mode mode,
                                   Detail detail = Detail::all,
                                   const std::vector<std::string>& only = {},
                                   const FitMixedModels& fit_mixed_models = nullptr);

// What a study's sessions rendered otherwise than this version would, because an earlier one ran
// them: sentences, which the report has among its deviations. Versions that are not of the form
// "0.1.0" count as this one.
std::vector<std::string> rendered_by_earlier_versions(
    const protocols::Protocol& protocol, const std::vector<results::SessionRow>& sessions);
}  // namespace tapstudy::runner
