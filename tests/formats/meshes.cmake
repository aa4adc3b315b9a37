# SPDX-License-Identifier: Apache-2.0
vera_tests(meshes unit
    SOURCES
        mesh_file_test.cpp nff_test.cpp obj_file_test.cpp obj_names_test.cpp obj_parts_test.cpp ply_file_test.cpp stl_file_test.cpp
    LINKS vera::formats)
vera_tests(meshes agree
    SOURCES number_test.cpp
    LINKS vera::formats)
