// SPDX-License-Identifier: Apache-2.0
#include "vera/base/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>

namespace vera {

ThreadLimit::ThreadLimit(std::size_t threads)
    : control_(new tbb::global_control(
        tbb::global_control::max_allowed_parallelism,
        threads == 0 ? static_cast<std::size_t>(tbb::info::default_concurrency()) : threads)) {}

ThreadLimit::~ThreadLimit() {
    delete static_cast<tbb::global_control*>(control_);
}

void parallel_ranges(
    std::size_t count,
    std::size_t grain,
    const std::function<void(std::size_t first, std::size_t last)>& turn) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, grain),
        [&](const tbb::blocked_range<std::size_t>& range) { turn(range.begin(), range.end()); },
        tbb::simple_partitioner());
}

} // namespace vera
