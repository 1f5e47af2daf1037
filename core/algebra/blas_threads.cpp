#include "core/algebra/blas_threads.hpp"

#include <cblas.h>

#include <cstdlib>
namespace tapstudy::core {
void use_one_blas_thread() {
  if (std::getenv("OPENBLAS_NUM_THREADS") == nullptr) {
    openblas_set_num_threads(1);
  }
}
}  // namespace tapstudy::core
