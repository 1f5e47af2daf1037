# Every library from outside, as an imported target. All are Debian packages (packages.txt).
find_package(Eigen3 3.4 REQUIRED)
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(zstd REQUIRED)
find_package(nlohmann_json REQUIRED)

# TetGen and CHOLMOD come without CMake packages.
find_path(TETGEN_INCLUDE tetgen.h REQUIRED)
find_library(TETGEN_LIBRARY tet REQUIRED)
add_library(tetgen::tetgen INTERFACE IMPORTED)
target_include_directories(tetgen::tetgen SYSTEM INTERFACE ${TETGEN_INCLUDE})
target_link_libraries(tetgen::tetgen INTERFACE ${TETGEN_LIBRARY})

find_path(CHOLMOD_INCLUDE cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
add_library(suitesparse::cholmod INTERFACE IMPORTED)
target_include_directories(suitesparse::cholmod SYSTEM INTERFACE ${CHOLMOD_INCLUDE})
target_link_libraries(suitesparse::cholmod INTERFACE ${CHOLMOD_LIBRARY})
