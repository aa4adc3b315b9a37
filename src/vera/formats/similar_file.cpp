// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/similar_file.h"

#include "vera/base/similar_words.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace vera {

std::string similar_file(const std::filesystem::path& path, std::string_view separator) {
    constexpr std::size_t most_files = 10'000;
    std::vector<std::string> names;
    std::error_code error;
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    for (auto entry = std::filesystem::directory_iterator(folder, error);
         !error && entry != std::filesystem::directory_iterator() && names.size() < most_files;
         entry.increment(error))
        names.push_back(entry->path().filename().string());
    // Folders list their files in any order.
    std::sort(names.begin(), names.end());
    const auto similar = most_similar(path.filename().string(), names);
    return similar ? fmt::format("{}did you mean '{}'?", separator, *similar) : std::string();
}

} // namespace vera
