# What `cmake --install` puts where: archive, headers, shader include, package files; the program where it is built.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/umbrage)

install(TARGETS umbrage_library EXPORT umbrageTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/umbrage ${PROJECT_BINARY_DIR}/include/umbrage
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp" PATTERN "*.glsl")
install(EXPORT umbrageTargets NAMESPACE umbrage:: DESTINATION ${package_dir})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/umbrageConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/umbrageConfig.cmake INSTALL_DESTINATION ${package_dir}
                              PATH_VARS CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/umbrageConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/umbrageConfig.cmake ${PROJECT_BINARY_DIR}/umbrageConfigVersion.cmake
        DESTINATION ${package_dir})

# Relative to itself, so that a moved tree, or one installed with another --prefix, is still found.
file(RELATIVE_PATH umbrage_prefix_from_pc ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${PROJECT_SOURCE_DIR}/cmake/umbrage.pc.in ${PROJECT_BINARY_DIR}/umbrage.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/umbrage.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(TARGET umbrage_program)
  install(TARGETS umbrage_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
