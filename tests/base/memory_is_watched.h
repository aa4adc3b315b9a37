// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vera {

/// Whether a sanitizer watches this build's memory, and so takes much of it.
constexpr bool memory_is_watched() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return true;
#elif defined(__has_feature)
    return __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
    return false;
#endif
}

} // namespace vera
