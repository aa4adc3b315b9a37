// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_build.h"
#include "vera/accel/grid_tree.h"
#include "vera/scene/bounds.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace vera {

namespace {

constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

/// The number at the beginning of a file; nothing known where there is none ("max").
std::size_t number_in(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::size_t number = 0;
    return file >> number ? number : unlimited;
}

/// What the system says could be given to programs without swapping.
std::size_t free_memory() {
    std::ifstream file("/proc/meminfo");
    std::string name;
    std::size_t kibibytes = 0;
    std::string unit;
    while (file >> name >> kibibytes) {
        std::getline(file, unit);
        if (name == "MemAvailable:")
            return kibibytes * 1024;
    }
    return unlimited;
}

/// What is left of the limit of the control group that the process is in, and of those around it.
std::size_t left_in_control_groups() {
    namespace fs = std::filesystem;
    const fs::path root = "/sys/fs/cgroup";
    std::ifstream file("/proc/self/cgroup");
    std::string line;
    std::size_t left = unlimited;
    const auto consider = [&](const fs::path& limit_file, const fs::path& usage_file) {
        const std::size_t limit = number_in(limit_file);
        const std::size_t usage = number_in(usage_file);
        if (limit != unlimited && usage != unlimited)
            left = std::min(left, limit > usage ? limit - usage : 0);
    };
    while (std::getline(file, line)) {
        const std::size_t first = line.find(':');
        const std::size_t second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos)
            continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        fs::path group = fs::path(line.substr(second + 1)).relative_path();
        while (true) {
            if (controllers.empty())
                consider(root / group / "memory.max", root / group / "memory.current");
            else if (controllers == "memory")
                consider(
                    root / "memory" / group / "memory.limit_in_bytes",
                    root / "memory" / group / "memory.usage_in_bytes");
            if (group.empty())
                break;
            group = group.parent_path();
        }
    }
    return left;
}

} // namespace

GridForecast grid_forecast(const Scene& scene, const GridSettings& settings) {
    const std::vector<Box3> boxes = subscene_bounds(scene);
    GridForecast forecast;
    forecast.bytes = detail::forecast_bytes(scene.geometry, boxes, settings);
    for (const Geometry& subscene : scene.subscenes)
        forecast.bytes += detail::forecast_bytes(subscene, boxes, settings);
    forecast.available_bytes = std::min(free_memory(), left_in_control_groups());
    return forecast;
}

} // namespace vera
