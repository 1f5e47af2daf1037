# The shipped protocols that `reproduce` reads, as string literals: the program needs no files beside
# it. A literal holds at most 65536 characters by the standard; these are far shorter.
set(embedded_dir ${PROJECT_BINARY_DIR}/embedded_protocols)
file(GLOB protocol_files CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
  ${PROJECT_SOURCE_DIR}/protocols/paper/* ${PROJECT_SOURCE_DIR}/protocols/recommended/*)
set(rows "")
foreach(protocol IN LISTS protocol_files)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${protocol})
  file(READ ${PROJECT_SOURCE_DIR}/${protocol} text)
  string(APPEND rows "{\"${protocol}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(GENERATE OUTPUT ${embedded_dir}/embedded_protocols.inc CONTENT "${rows}")
target_include_directories(tapstudy_runner_laboratory PRIVATE ${embedded_dir})
