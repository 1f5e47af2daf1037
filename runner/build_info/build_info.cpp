#include "runner/build_info/build_info.hpp"

#include "git_hash.hpp"  // written by cmake/git_hash.cmake at every build
namespace tapstudy::runner {
std::string program_version() {
  return TAPSTUDY_VERSION;
}
std::string git_hash() {
  return TAPSTUDY_GIT_HASH;
}
std::string compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "gcc " __VERSION__;
#endif
}
}  // namespace tapstudy::runner
