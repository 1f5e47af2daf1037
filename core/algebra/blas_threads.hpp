#pragma once
namespace tapstudy::core {
// One thread for BLAS and LAPACK from now on, unless the environment has OPENBLAS_NUM_THREADS. Idle
// threads of OpenBLAS yield in a loop: on two processors they took a third of the time of an
// identification, and gained a seventh of that of a modal analysis with 350 000 degrees of freedom.
void use_one_blas_thread();
}  // namespace tapstudy::core
