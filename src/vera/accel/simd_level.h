// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vera {

/// Names of the instruction sets that this build has code for and this machine can run, the
/// plainest first.
std::vector<std::string> simd_levels();

/// Lets the library use no better instruction set than this one; an empty name, the best there is.
/// Returns false, and changes nothing, for a name that is not among simd_levels(). Not to be called
/// while queries run.
bool limit_simd(std::string_view level);

/// Does, once in the life of the process, what the environment's variable VERA_SIMD says, as
/// limit_simd. Throws std::runtime_error when it names no level.
void honour_simd_environment();

} // namespace vera
