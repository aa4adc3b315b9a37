// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace vera {

/// Limits, while it lives, what available_memory() tells: to what this process then still lacks of
/// so many bytes in all. Limits may lie one within the other; the innermost one holds.
class MemoryLimit {
public:
    explicit MemoryLimit(std::uint64_t bytes);
    ~MemoryLimit();
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;

private:
    std::uint64_t before_;
};

/// Bytes of memory that this process could still take without swapping and without breaking the
/// limits that are set for it; nothing when the system does not tell.
std::optional<std::uint64_t> available_memory();

/// Throws std::runtime_error where less than so many bytes are available: "WHAT takes about 3 MiB
/// of memory, and 2 MiB are available: REMEDY". Is not asked about what every machine has.
void require_memory(double bytes, const std::string& what, const std::string& remedy);

/// The same with what is available given, or nothing where that is not known.
void require_memory(
    double bytes,
    std::optional<std::uint64_t> available,
    const std::string& what,
    const std::string& remedy);

} // namespace vera
