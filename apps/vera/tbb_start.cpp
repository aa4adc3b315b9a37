// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string_view>

#include <dlfcn.h>

#ifdef __GLIBC__

/// Takes the place, in this program alone, of the system's function by which oneTBB looks for two
/// libraries when its threads start: its own allocator, for blocks that are few here, and threads
/// that Intel's OpenMP shares with it. It does without them, and to load the one and to search for
/// the other takes longer than to start the threads.
void* dlopen(const char* name, int mode) noexcept {
    constexpr std::array<std::string_view, 2> spared = {"libtbbmalloc.so", "libirml.so"};
    if (name != nullptr)
        for (const std::string_view library : spared)
            if (std::string_view(name).find(library) != std::string_view::npos)
                return nullptr;
    static const auto system_dlopen =
        reinterpret_cast<decltype(&dlopen)>(dlsym(RTLD_NEXT, "dlopen"));
    return system_dlopen(name, mode);
}
#endif
