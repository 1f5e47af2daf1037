#pragma once
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "protocols/yaml/yaml_reader.hpp"
// Keys that several tasks have.
namespace tapstudy::protocols {
// Names of the axes along which a stimulus varies; none of one that there is not.
std::vector<std::string> axes_of(const Protocol& protocol, const std::string& stimulus);

// Whether something in `vary` of a stimulus of the block was rejected, which was reported there.
bool is_vary_refused(const Protocol& protocol, const Block& block);

// The key `axis`, which may be left out where there is one. Problems go to the reader, unless
// is_vary_refused: then the axis may be the one that was rejected.
std::string read_axis(MapReader& reader, const Protocol& protocol, const Block& block,
                      const std::vector<std::string>& axes);

// The key `standard`, on that axis, which may be left out for the stimulus's own value.
double read_standard_value(MapReader& reader, const Range& range, double own);

// The key `alternatives`.
int read_alternatives(MapReader& reader, int low, int high, int usual);

// The key `response_labels`, of these responses.
void read_response_labels(MapReader& reader, const std::vector<std::string>& responses,
                          Block& block);

// These values of every stimulus of the block as they are presented: a table has its own. Empty,
// and rejected under this key, if they cannot be presented or are not in increasing order then;
// empty also if a stimulus was rejected.
std::vector<double> presented_on_axis(MapReader& reader, const std::string& key,
                                      const Protocol& protocol, const Block& block,
                                      const ValuesOnAxis& asked);
}  // namespace tapstudy::protocols
