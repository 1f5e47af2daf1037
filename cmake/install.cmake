# What `cmake --install` puts where, and two Debian packages of it by CPack: the program, and core
# for programs of others (find_package(tapstudy), pkg-config tapstudy-core).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# What the program makes of itself: manual page and completions from the definitions of its commands,
# the reference and the JSON schemas of its YAML files from their readers.
set(documents_dir ${PROJECT_BINARY_DIR}/documents)
set(documents ${documents_dir}/tapstudy.1 ${documents_dir}/tapstudy.bash ${documents_dir}/_tapstudy
  ${documents_dir}/keys.md ${documents_dir}/schema/protocol.schema.json
  ${documents_dir}/schema/rig.schema.json ${documents_dir}/schema/calibration.schema.json)
add_custom_command(OUTPUT ${documents}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${documents_dir}
  COMMAND tapstudy --documents ${documents_dir} DEPENDS tapstudy VERBATIM)
add_custom_target(tapstudy_documents ALL DEPENDS ${documents})

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
install(TARGETS tapstudy)
install(FILES ${documents_dir}/tapstudy.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${documents_dir}/tapstudy.bash RENAME tapstudy
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${documents_dir}/_tapstudy DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(DIRECTORY protocols/paper protocols/recommended protocols/examples protocols/rigs
  ${documents_dir}/schema  # beside them, where their first lines look for it
  DESTINATION ${CMAKE_INSTALL_DATADIR}/tapstudy/protocols)
install(FILES device/udev/70-tapstudy.rules DESTINATION lib/udev/rules.d)
install(FILES README.md CHANGELOG.md ${documents_dir}/keys.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tapstudy)
set(core_includes ${CMAKE_INSTALL_INCLUDEDIR}/tapstudy)
target_include_directories(tapstudy_core INTERFACE $<INSTALL_INTERFACE:${core_includes}>)
target_compile_features(tapstudy_core PUBLIC cxx_std_20)
set_target_properties(tapstudy_core PROPERTIES EXPORT_NAME core)
install(TARGETS tapstudy_core EXPORT tapstudy_targets)
install(EXPORT tapstudy_targets NAMESPACE tapstudy:: FILE tapstudyTargets.cmake
  DESTINATION ${package_dir})
install(DIRECTORY core DESTINATION ${core_includes} FILES_MATCHING PATTERN *.hpp
  PATTERN example EXCLUDE)
configure_package_config_file(cmake/install/tapstudyConfig.cmake.in tapstudyConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(tapstudyConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tapstudyConfig.cmake cmake/core_dependencies.cmake
  ${PROJECT_BINARY_DIR}/tapstudyConfigVersion.cmake DESTINATION ${package_dir})
file(RELATIVE_PATH prefix_from_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/install/tapstudy-core.pc.in tapstudy-core.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/tapstudy-core.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(DIRECTORY core/example/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libtapstudy-core-dev/examples)
install(FILES LICENSE RENAME copyright
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libtapstudy-core-dev)

set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # packages need no tests
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_PACKAGE_CONTACT "tapstudy maintainers <maintainers@tapstudy.invalid>")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "user studies of tapped virtual objects
 Randomises and presents virtual plates through a force-feedback device, drives the 1 kHz loop,
 stores every answer and every force sample, and writes the report.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME tapstudy)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "gnuplot-nox | gnuplot")  # draws the figures
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/install/postinst)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "physics of tapped virtual objects, for C++ programs
 Modes of plates and other bodies by finite elements, and the force on a finger that taps them.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libtapstudy-core-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libfmt-dev, liblapacke-dev, \
libmumps-seq-dev, libopenblas-dev, libsamplerate0-dev, libssl-dev, libtet1.5-dev")
include(CPack)
