#pragma once
#include <optional>

#include "protocols/protocol.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
// The block's comparison and its procedures; problems go to the reader. nullopt: there can be none.
std::optional<Comparison> read_comparison(MapReader& reader, const Protocol& protocol,
                                          const Block& block);
}  // namespace tapstudy::protocols
