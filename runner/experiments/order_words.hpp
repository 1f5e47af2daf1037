#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// ", in random order": of a block's trials; "" where its task has an order of its own.
std::string order_words(const protocols::Block& block, std::size_t participants);
// "Each participant did 'a' (…), then 'b' (…). ", or how the blocks followed one another.
// blocks: each in words.
std::string sequence_words(const protocols::Protocol& protocol, const std::string& who,
                           const std::vector<std::string>& blocks, std::size_t participants);
}  // namespace tapstudy::runner
