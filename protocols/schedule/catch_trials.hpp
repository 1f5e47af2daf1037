#pragma once
#include <optional>
#include <vector>

#include "protocols/protocol.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
// The block's `catch_trials`, with the answers that it allows; problems go to the reader.
std::optional<CatchTrials> read_catch_trials(MapReader& reader, const Protocol& protocol,
                                             const Block& block);

// Where catch trials are put in among so many others, one after the other: the index of each when
// it is inserted.
std::vector<std::size_t> catch_places(const Block& block, const Draw& draw, std::size_t others);

// The block's trials with its catch trials among them, at places that are all equally likely, the
// first excepted: a participant has then seen what an ordinary trial is.
std::vector<PlannedTrial> with_catch_trials(std::vector<PlannedTrial> trials, const Block& block,
                                            const Draw& draw);
}  // namespace tapstudy::protocols
