# One static library per folder: the folder is the target, and analysis_report is analysis/report. The
# top-level folder is the namespace.
#   tapstudy_library(name LINK <what its headers need> PRIVATE <what only its sources need>)
add_library(tapstudy_flags INTERFACE)
target_compile_options(tapstudy_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Wdouble-promotion)
# Names of files as they are in the project: the same build wherever the checkout is.
target_compile_options(tapstudy_flags INTERFACE -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
option(TAPSTUDY_WERROR "Treat warnings as errors" OFF)
if(TAPSTUDY_WERROR)
  target_compile_options(tapstudy_flags INTERFACE -Werror)
endif()
# unite_by_folder(source…): where CMAKE_UNITY_BUILD is on, as it is in the presets, the sources of one
# folder are compiled as one: about half of the time, and a name has one meaning in a folder.
function(unite_by_folder)
  foreach(source IN LISTS ARGN)
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${source})
    get_filename_component(folder ${path} DIRECTORY)
    string(MAKE_C_IDENTIFIER "${folder}" group)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()

# CGAL is a quarter of the build, and what uses it runs once for a surface, in one thread: lightly
# optimised, so without the precompiled header, which fits only sources that are optimised as it was,
# and not watched for races. GCC takes an empty boost::optional of CGAL's for one that is read.
function(optimise_cgal_lightly)
  foreach(source IN LISTS ARGN)
    file(STRINGS ${source} uses_cgal REGEX "#include <CGAL/" LIMIT_COUNT 1)
    if(uses_cgal)
      set_source_files_properties(${source} PROPERTIES
        COMPILE_OPTIONS "-O1;$<IF:$<CXX_COMPILER_ID:GNU>,-Wno-maybe-uninitialized,-fno-sanitize=thread>" SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
endfunction()

# Optimising what a sanitizer has instrumented is two thirds of its build. What computes little is built
# without; physics and statistics are not: Eigen would be a hundred times slower.
set(TAPSTUDY_UNOPTIMISED "^$" CACHE STRING
  "Regular expression of libraries, protocols among them, that are not optimised")

function(tapstudy_library name)
  cmake_parse_arguments(ARG "" "" "LINK;PRIVATE" ${ARGN})
  string(REGEX REPLACE "^(analysis|runner)_" "\\1/" folder ${name})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/example/")
  add_library(tapstudy_${name} STATIC ${sources})
  set_target_properties(tapstudy_${name} PROPERTIES UNITY_BUILD_MODE GROUP)
  unite_by_folder(${sources})
  optimise_cgal_lightly(${sources})
  add_library(tapstudy::${name} ALIAS tapstudy_${name})
  target_include_directories(tapstudy_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(tapstudy_${name} PUBLIC ${ARG_LINK}
    PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:tapstudy_flags>)
  # What nearly every source includes, compiled once for all that are optimised alike.
  set(first core)
  if(name MATCHES "${TAPSTUDY_UNOPTIMISED}")
    target_compile_options(tapstudy_${name} PRIVATE -O0)
    set(first protocols)
  endif()
  if(name STREQUAL first)
    target_precompile_headers(tapstudy_${name} PRIVATE <Eigen/Core> <fmt/format.h> <fmt/ranges.h>)
  else()
    target_precompile_headers(tapstudy_${name} REUSE_FROM tapstudy_${first})
  endif()
endfunction()
