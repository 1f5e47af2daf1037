#pragma once
#include <optional>
#include <vector>

#include "protocols/protocol.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
// The block's `catch_trials`, with the answers that it allows; problems go to the reader.
std::optional<CatchTrials> read_catch_trials(MapReader& reader, const Protocol& protocol,
                                             const Block& block);

// The block's trials with its catch trials among them, at places that are all equally likely, the
// first excepted: a participant has then seen what an ordinary trial is.
std::vector<PlannedTrial> with_catch_trials(std::vector<PlannedTrial> trials, const Block& block,
                                            const Draw& draw);
}  // namespace tapstudy::protocols
