# The version and the commit of the sources, for the record of every session.
set(build_info_dir ${PROJECT_BINARY_DIR}/build_info)
set(git_hash_header ${build_info_dir}/git_hash.hpp)
set(write_git_hash ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DOUTPUT=${git_hash_header}
  -P ${PROJECT_SOURCE_DIR}/cmake/git_hash.cmake)
add_custom_target(tapstudy_git_hash ALL COMMAND ${write_git_hash} BYPRODUCTS ${git_hash_header})
add_library(tapstudy_build_info INTERFACE)
add_dependencies(tapstudy_build_info tapstudy_git_hash)
target_include_directories(tapstudy_build_info INTERFACE ${build_info_dir})
target_compile_definitions(tapstudy_build_info INTERFACE TAPSTUDY_VERSION="${PROJECT_VERSION}")
