# SPDX-License-Identifier: Apache-2.0
# The shared library, made of all folders of src/vera, and what is installed.

# Debian's own package vera is a dictionary of acronyms: keep out of its way.
set(package_name vera-raytracer)
set(CMAKE_INSTALL_DOCDIR share/doc/${package_name} CACHE PATH "Where LICENSE and examples go")
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS vera RUNTIME)
install(FILES LICENSE THIRD_PARTY_NOTICES.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/scenes)

if(VERA_BUILD_LIBRARY)
    get_property(folders GLOBAL PROPERTY VERA_FOLDER_LIBRARIES)
    add_library(vera_library SHARED)
    add_library(vera::vera ALIAS vera_library)
    foreach(folder IN LISTS folders)
        target_sources(vera_library PRIVATE $<TARGET_OBJECTS:${folder}>)
        target_link_libraries(vera_library PRIVATE ${folder})
    endforeach()
    set_target_properties(vera_library PROPERTIES
        OUTPUT_NAME vera
        EXPORT_NAME vera
        VERSION ${PROJECT_VERSION}
        # Until 1.0 a minor version may change what others call; see docs/stability.md.
        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
    # The flag reaches those who use the library: headers compute too. Our warnings do not.
    target_compile_options(vera_library INTERFACE ${VERA_SAME_BITS})
    target_compile_features(vera_library INTERFACE cxx_std_20)
    target_include_directories(vera_library INTERFACE
        $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
        $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>
        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

    install(TARGETS vera_library EXPORT veraTargets
        LIBRARY COMPONENT library
        NAMELINK_COMPONENT development)
    install(EXPORT veraTargets NAMESPACE vera::
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vera COMPONENT development)
    install(DIRECTORY src/vera ${PROJECT_BINARY_DIR}/generated/vera
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.h")

    configure_package_config_file(
        cmake/VeraConfig.cmake.in ${PROJECT_BINARY_DIR}/generated/veraConfig.cmake
        INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vera)
    write_basic_package_version_file(
        ${PROJECT_BINARY_DIR}/generated/veraConfigVersion.cmake COMPATIBILITY SameMinorVersion)
    configure_file(cmake/vera.pc.in ${PROJECT_BINARY_DIR}/generated/vera.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/generated/veraConfig.cmake
                  ${PROJECT_BINARY_DIR}/generated/veraConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vera COMPONENT development)
    install(FILES ${PROJECT_BINARY_DIR}/generated/vera.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
    install(DIRECTORY examples/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT development)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ${package_name})
set(CPACK_PACKAGE_CONTACT "The VERA developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_STRIP_FILES ON)
include(CPack)
