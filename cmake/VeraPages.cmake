# SPDX-License-Identifier: Apache-2.0
# The target doxygen: pages of the library's headers and of the documents, in pages/ of the build
# folder.

find_program(VERA_DOXYGEN doxygen)
mark_as_advanced(VERA_DOXYGEN)
if(VERA_DOXYGEN)
    configure_file(cmake/Doxyfile.in ${PROJECT_BINARY_DIR}/generated/Doxyfile @ONLY)
    add_custom_target(doxygen
        COMMAND ${VERA_DOXYGEN} ${PROJECT_BINARY_DIR}/generated/Doxyfile
        COMMENT "Pages of the library: ${PROJECT_BINARY_DIR}/pages/index.html"
        VERBATIM)
endif()
