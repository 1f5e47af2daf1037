# One static library per top-level folder: the folder is the target is the namespace.
#   tapstudy_library(name LINK <what its headers need> PRIVATE <what only its sources need>
#                    PRECOMPILE <headers of libraries that many of its sources include>)
add_library(tapstudy_flags INTERFACE)
target_compile_options(tapstudy_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Wdouble-promotion)
option(TAPSTUDY_WERROR "Treat warnings as errors" OFF)
if(TAPSTUDY_WERROR)
  target_compile_options(tapstudy_flags INTERFACE -Werror)
endif()
function(tapstudy_library name)
  cmake_parse_arguments(ARG "" "" "LINK;PRIVATE;PRECOMPILE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${name}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$|/example/")
  add_library(tapstudy_${name} STATIC ${sources})
  add_library(tapstudy::${name} ALIAS tapstudy_${name})
  target_include_directories(tapstudy_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(tapstudy_${name} PUBLIC ${ARG_LINK}
    PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:tapstudy_flags>)
  target_precompile_headers(tapstudy_${name} PRIVATE ${ARG_PRECOMPILE})
endfunction()
