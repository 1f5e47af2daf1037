#include "core/process/bounded_child.hpp"

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  tapstudy::core::serve_if_child(*count, *words);
  return 0;
}
