#pragma once
#include <string>
namespace tapstudy::runner {
// Build of the running program; stored with every session.
std::string program_version();
std::string git_hash();  // with "+changes" if the sources differed from that commit
std::string compiler();
}  // namespace tapstudy::runner
