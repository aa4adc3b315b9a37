// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"

#include "vera/base/free_room.h"
#include "vera/base/held_memory.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include <sys/resource.h>
#include <unistd.h>

namespace vera {

namespace {

/// The number behind a name in a file of lines "name number".
std::optional<std::uint64_t>
number_behind(const std::filesystem::path& path, std::string_view name) {
    std::ifstream file(path);
    std::string line;
    while (std::getline(file, line))
        if (line.size() > name.size() && line.starts_with(name))
            try {
                return std::stoull(line.substr(name.size()));
            } catch (const std::exception&) {
                return std::nullopt;
            }
    return std::nullopt;
}

/// What a control group (version 2) leaves. Pages of files count for the group, but give way.
std::optional<std::uint64_t> left_by_group(const std::filesystem::path& group) {
    const auto limit = number_behind(group / "memory.max", "");
    const auto used = number_behind(group / "memory.current", "");
    if (!limit || !used)
        return std::nullopt;
    const std::uint64_t files = number_behind(group / "memory.stat", "active_file ").value_or(0)
        + number_behind(group / "memory.stat", "inactive_file ").value_or(0);
    const std::uint64_t held = *used - std::min(files, *used);
    return *limit - std::min(held, *limit);
}

constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();

/// That of the innermost MemoryLimit.
std::atomic<std::uint64_t> memory_limit = no_limit;

std::optional<std::uint64_t> left_by_memory_limit() {
    if (memory_limit == no_limit)
        return std::nullopt;
    return memory_limit - std::min<std::uint64_t>(held_memory(), memory_limit);
}

std::optional<std::uint64_t> left_by_address_space() {
    rlimit limit = {};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return std::nullopt;
    std::ifstream statm("/proc/self/statm");
    std::uint64_t pages = 0;
    statm >> pages;
    const std::uint64_t used = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    return limit.rlim_cur - std::min<std::uint64_t>(used, limit.rlim_cur);
}

} // namespace

MemoryLimit::MemoryLimit(std::uint64_t bytes)
    : before_(memory_limit.exchange(bytes)) {}

MemoryLimit::~MemoryLimit() {
    memory_limit = before_;
}

std::optional<std::uint64_t> available_memory() {
    std::optional<std::uint64_t> least;
    const auto limit_by = [&least](std::optional<std::uint64_t> bytes) {
        if (bytes)
            least = std::min(least.value_or(*bytes), *bytes);
    };
    if (const auto kilobytes = number_behind("/proc/meminfo", "MemAvailable:"))
        limit_by(*kilobytes * 1024);
    limit_by(left_by_address_space());
    limit_by(left_by_memory_limit());

    std::ifstream groups("/proc/self/cgroup");
    std::string line;
    while (std::getline(groups, line)) {
        if (!line.starts_with("0::/"))
            continue;
        const std::filesystem::path root = "/sys/fs/cgroup";
        std::filesystem::path group = root / line.substr(4);
        // The limits of all groups round this one hold too.
        while (true) {
            limit_by(left_by_group(group));
            if (group == root || !group.has_relative_path() || group.parent_path() == group
                || group.native().size() <= root.native().size())
                break;
            group = group.parent_path();
        }
    }
    return least;
}

void require_memory(double bytes, const std::string& what, const std::string& remedy) {
    constexpr double little = 0x1p23;
    if (bytes <= little)
        return;
    if (const auto available = available_memory();
        !available || bytes <= static_cast<double>(*available))
        return;
    spare_memory(); // also where the work that asks for it is small
    give_back_freed_memory();
    require_memory(bytes, available_memory(), what, remedy);
}

void require_memory(
    double bytes,
    std::optional<std::uint64_t> available,
    const std::string& what,
    const std::string& remedy) {
    if (!available || bytes <= static_cast<double>(*available))
        return;
    const auto mebibytes = [](double size) {
        return std::to_string(static_cast<std::uint64_t>(size / 0x1p20) + 1);
    };
    throw std::runtime_error(
        what + " takes about " + mebibytes(bytes) + " MiB of memory, and "
        + mebibytes(static_cast<double>(*available)) + " MiB are available: " + remedy);
}

} // namespace vera
