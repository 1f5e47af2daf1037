# The libraries from outside that core is made with, as imported targets. Installed, too: whoever
# links tapstudy::core statically links them.
find_package(Eigen3 3.4 REQUIRED)
find_package(fmt REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)

find_path(SAMPLERATE_INCLUDE samplerate.h REQUIRED)
find_library(SAMPLERATE_LIBRARY samplerate REQUIRED)
add_library(samplerate::samplerate INTERFACE IMPORTED)
target_include_directories(samplerate::samplerate SYSTEM INTERFACE ${SAMPLERATE_INCLUDE})
target_link_libraries(samplerate::samplerate INTERFACE ${SAMPLERATE_LIBRARY})

find_path(TETGEN_INCLUDE tetgen.h REQUIRED)
find_library(TETGEN_LIBRARY tet REQUIRED)
add_library(tetgen::tetgen INTERFACE IMPORTED)
target_include_directories(tetgen::tetgen SYSTEM INTERFACE ${TETGEN_INCLUDE})
target_link_libraries(tetgen::tetgen INTERFACE ${TETGEN_LIBRARY})

find_path(CBLAS_INCLUDE cblas.h REQUIRED)
find_path(LAPACKE_INCLUDE lapacke.h REQUIRED)
find_library(LAPACKE_LIBRARY lapacke REQUIRED)
find_library(BLAS_LIBRARY openblas REQUIRED)
add_library(blas::blas INTERFACE IMPORTED)
target_include_directories(blas::blas SYSTEM INTERFACE ${CBLAS_INCLUDE} ${LAPACKE_INCLUDE})
target_link_libraries(blas::blas INTERFACE ${LAPACKE_LIBRARY} ${BLAS_LIBRARY})

find_path(MUMPS_INCLUDE dmumps_c.h REQUIRED)
find_library(MUMPS_LIBRARY dmumps_seq REQUIRED)
add_library(mumps::mumps INTERFACE IMPORTED)
target_include_directories(mumps::mumps SYSTEM INTERFACE ${MUMPS_INCLUDE})
target_link_libraries(mumps::mumps INTERFACE ${MUMPS_LIBRARY})
