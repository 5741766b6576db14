# What `cmake --install` puts where, in parts, and the Debian packages that CPack makes of them: the program, the
# engine for other programs, and the Python package where it is built (app/python installs it).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The manual page and the completions of shells, from the program's own declaration of its options.
set(manual_folder ${PROJECT_BINARY_DIR}/manual)
set(manual_files sweepscope.1 sweepscope.bash _sweepscope sweepscope.fish)
list(TRANSFORM manual_files PREPEND ${manual_folder}/)
add_custom_command(
  OUTPUT ${manual_files}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${manual_folder}
  COMMAND sweepscope --man > ${manual_folder}/sweepscope.1
  COMMAND sweepscope --completion bash > ${manual_folder}/sweepscope.bash
  COMMAND sweepscope --completion zsh > ${manual_folder}/_sweepscope
  COMMAND sweepscope --completion fish > ${manual_folder}/sweepscope.fish
  DEPENDS sweepscope COMMENT "Manual page and completions")
add_custom_target(manual ALL DEPENDS ${manual_files})

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
install(TARGETS sweepscope RUNTIME COMPONENT program)
install(DIRECTORY assets/rigs assets/figures assets/ui assets/slurm assets/snakemake
        DESTINATION ${CMAKE_INSTALL_DATADIR}/sweepscope COMPONENT program PATTERN "*.png" EXCLUDE)
install(FILES ${manual_folder}/sweepscope.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${manual_folder}/sweepscope.bash
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME sweepscope COMPONENT program)
install(FILES ${manual_folder}/_sweepscope
        DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${manual_folder}/sweepscope.fish
        DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program PATTERN site EXCLUDE)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libsweepscope-dev RENAME copyright COMPONENT engine)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/sweepscope)
set_target_properties(sweepscope_core PROPERTIES EXPORT_NAME core)
install(TARGETS sweepscope_core EXPORT sweepscope_engine ARCHIVE COMPONENT engine)
install(CODE "set(root \"${PROJECT_SOURCE_DIR}\")\nset(headers \"${sweepscope_public_headers}\")\nset(folder \"${CMAKE_INSTALL_INCLUDEDIR}\")"
        COMPONENT engine)
install(SCRIPT core/install_headers.cmake COMPONENT engine)
install(EXPORT sweepscope_engine NAMESPACE sweepscope:: FILE sweepscopeTargets.cmake DESTINATION ${package_folder}
        COMPONENT engine)
configure_package_config_file(core/sweepscopeConfig.cmake.in ${PROJECT_BINARY_DIR}/sweepscopeConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sweepscopeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sweepscopeConfig.cmake ${PROJECT_BINARY_DIR}/sweepscopeConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT engine)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program engine)
if(TARGET sweepscope_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_PACKAGE_CONTACT "The authors of sweepscope <sweepscope@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "time offset between an actuated laser scanner and its motor")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME sweepscope)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "${CPACK_PACKAGE_DESCRIPTION_SUMMARY}
 Finds the constant time offset between a 2D laser scanner and the motor that
 turns it, from a recording, and shows what the offset does to the map.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# Loaded at run time, where there is no display.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS libosmesa6)
set(CPACK_DEBIAN_ENGINE_PACKAGE_NAME libsweepscope-dev)
set(CPACK_DEBIAN_ENGINE_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_ENGINE_DESCRIPTION "engine of sweepscope, for other programs
 The library that finds the offset and builds the map, its headers, and a CMake
 package: find_package(sweepscope) and link sweepscope::core.")
# What the program is built with, for whoever builds with its engine.
set(CPACK_DEBIAN_ENGINE_PACKAGE_DEPENDS
    "libbz2-dev, libdeflate-dev, libeigen3-dev, libembree-dev, libexpected-dev, libfmt-dev, liblz4-dev, libpcl-dev, libsqlite3-dev, libtbb-dev, libxxhash-dev, libyaml-cpp-dev, libzstd-dev, nlohmann-json3-dev, pkg-config")
if(roscpp_FOUND)
  string(APPEND CPACK_DEBIAN_ENGINE_PACKAGE_DEPENDS ", libroscpp-dev")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-sweepscope)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "sweepscope from Python
 The offset of a recording, its map as NumPy arrays, and pictures that a
 notebook shows: import sweepscope.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
# The module is of one version of Python. OSMesa is loaded at run time.
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= ${SWEEPSCOPE_PYTHON_VERSION}), python3 (<< ${SWEEPSCOPE_NEXT_PYTHON_VERSION}~), python3-numpy, libosmesa6")
include(CPack)
