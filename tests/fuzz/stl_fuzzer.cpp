// SPDX-License-Identifier: Apache-2.0
#include "mesh_check.h"

/// Whatever the bytes: a mesh whose numbers hold, or an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    vera::check_mesh_reader(vera::read_stl, data, size);
    return 0;
}
