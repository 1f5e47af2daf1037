#pragma once
#include <optional>

#include "protocols/protocol.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
// Of the standard a task's comparisons may lie on.
enum class Sides { one, one_or_both };
// The block's comparison and its procedures; problems go to the reader. nullopt: there can be none.
std::optional<Comparison> read_comparison(MapReader& reader, const Protocol& protocol,
                                          const Block& block, Sides sides);
}  // namespace tapstudy::protocols
