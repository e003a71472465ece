# cmake --install: component `server` is what runs, `core` the library of the method for programs of
# others, as the CMake package lpf with the target lpf::core.
include(CMakePackageConfigHelpers)

install(TARGETS lpf-server lpf-decode RUNTIME COMPONENT server)  # the decoder beside the server
install(DIRECTORY "${PROJECT_BINARY_DIR}/share/lpf-server" DESTINATION "${CMAKE_INSTALL_DATADIR}"
        COMPONENT server OPTIONAL)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}"
        COMPONENT server)

set(LPF_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/lpf")
install(EXPORT lpf NAMESPACE lpf:: DESTINATION "${LPF_PACKAGE_DIR}" COMPONENT core
        FILE lpfTargets.cmake)
# Headers name each other from the root of the repository: "core/denoise.h".
install(DIRECTORY "${PROJECT_SOURCE_DIR}/core" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/lpf"
        COMPONENT core FILES_MATCHING PATTERN "*.h")
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/lpfConfig.cmake.in"
                              "${PROJECT_BINARY_DIR}/lpfConfig.cmake"
                              INSTALL_DESTINATION "${LPF_PACKAGE_DIR}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/lpfConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/lpfConfig.cmake" "${PROJECT_BINARY_DIR}/lpfConfigVersion.cmake"
        DESTINATION "${LPF_PACKAGE_DIR}" COMPONENT core)
