# The pages' files as one object file, and the table that names them: the program needs no files
# beside it.
find_file(THREE_MODULE three.module.js PATHS /usr/share/javascript/three REQUIRED)
set(pages_source ${PROJECT_SOURCE_DIR}/runner/console/pages)
set(pages_dir ${PROJECT_BINARY_DIR}/pages)
set(pages_object ${pages_dir}/embedded_pages.o)
file(GLOB page_files CONFIGURE_DEPENDS RELATIVE ${pages_source} ${pages_source}/*)
list(REMOVE_ITEM page_files README.md)
set(declarations "extern \"C\" {\n")
set(rows "")
foreach(page IN LISTS page_files ITEMS three.module.js)
  string(MAKE_C_IDENTIFIER ${page} symbol)
  string(APPEND declarations "extern const char _binary_${symbol}_start[];\n"
    "extern const char _binary_${symbol}_end[];\n")
  string(APPEND rows
    "  {\"${page}\", _binary_${symbol}_start, _binary_${symbol}_end},\n")
endforeach()
file(CONFIGURE OUTPUT ${pages_dir}/table/embedded_pages.inc CONTENT
  "${declarations}}\nconst Embedded embedded[] = {\n${rows}};\n" @ONLY)
list(TRANSFORM page_files PREPEND ${pages_source}/ OUTPUT_VARIABLE page_paths)
# ld names its symbols after the paths that it is given, so it runs beside links to the files.
add_custom_command(OUTPUT ${pages_object}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${pages_dir}/files
  COMMAND cp ${page_paths} ${THREE_MODULE} ${pages_dir}/files/
  COMMAND ${CMAKE_COMMAND} -E chdir ${pages_dir}/files
          ld -r -b binary -z noexecstack -o ${pages_object} ${page_files} three.module.js
  DEPENDS ${page_paths} ${THREE_MODULE} VERBATIM)
# A target of its own: a command of the library's would wait for all that the library links.
add_custom_target(tapstudy_pages DEPENDS ${pages_object})
add_dependencies(tapstudy_runner_console tapstudy_pages)
target_link_libraries(tapstudy_runner_console PRIVATE ${pages_object})
target_include_directories(tapstudy_runner_console PRIVATE ${pages_dir}/table)
