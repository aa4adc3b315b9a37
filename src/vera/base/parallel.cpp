// SPDX-License-Identifier: Apache-2.0
#include "vera/base/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#ifdef VERA_THREAD_SANITIZER
extern "C" void __tsan_acquire(void* address); // NOLINT(bugprone-reserved-identifier)
extern "C" void __tsan_release(void* address); // NOLINT(bugprone-reserved-identifier)
#endif

namespace vera {

namespace {

/// Tells ThreadSanitizer what oneTBB, which is built without it, promises: that a turn sees what
/// was written before the loop, and that what follows the loop sees what the turns wrote. It does
/// not order the turns among themselves, so that their races are found.
class LoopOrder {
public:
    void before_loop() { release(begun_); }

    void after_loop() { acquire(ended_); }

    /// Lives as long as a turn.
    class Turn {
    public:
        explicit Turn(LoopOrder& order)
            : order_(order) {
            acquire(order_.begun_);
        }

        ~Turn() { release(order_.ended_); }

        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

    private:
        LoopOrder& order_;
    };

private:
#ifdef VERA_THREAD_SANITIZER
    static void acquire(char& tag) {
        __tsan_acquire(&tag);
    }

    static void release(char& tag) {
        __tsan_release(&tag);
    }
#else
    static void acquire(char&) {}

    static void release(char&) {}
#endif

    char begun_ = 0;
    char ended_ = 0;
};

/// Calls the order's after_loop however the loop ends.
class LoopEnd {
public:
    explicit LoopEnd(LoopOrder& order)
        : order_(order) {}

    ~LoopEnd() { order_.after_loop(); }

    LoopEnd(const LoopEnd&) = delete;
    LoopEnd& operator=(const LoopEnd&) = delete;

private:
    LoopOrder& order_;
};

/// How many limits to one thread hold. oneTBB is then left alone: to start it takes as long as a
/// small picture.
std::atomic<int> limits_to_one = 0;

/// Cuts the range where oneTBB would.
void turn_by_turn(
    std::size_t first,
    std::size_t last,
    std::size_t grain,
    const std::function<void(std::size_t first, std::size_t last)>& turn) {
    while (last - first > grain) {
        const std::size_t middle = first + (last - first) / 2;
        turn_by_turn(first, middle, grain, turn);
        first = middle;
    }
    turn(first, last);
}

} // namespace

ThreadLimit::ThreadLimit(std::size_t threads)
    : control_(
        threads == 1 ? nullptr
                     : new tbb::global_control(
                         tbb::global_control::max_allowed_parallelism,
                         threads == 0 ? static_cast<std::size_t>(tbb::info::default_concurrency())
                                      : threads)) {
    limits_to_one += control_ == nullptr ? 1 : 0;
    // So that oneTBB's threads start now, while the caller reads its input, and not in its first
    // loop, which would wait for them.
    if (control_ != nullptr)
        tbb::task_arena(tbb::attach()).enqueue([] {});
}

ThreadLimit::~ThreadLimit() {
    limits_to_one -= control_ == nullptr ? 1 : 0;
    delete static_cast<tbb::global_control*>(control_);
}

void parallel_ranges(
    std::size_t count,
    std::size_t grain,
    const std::function<void(std::size_t first, std::size_t last)>& turn) {
    if (count == 0)
        return;
    if (count <= grain || limits_to_one > 0)
        return turn_by_turn(0, count, grain, turn);
    LoopOrder order;
    order.before_loop();
    const LoopEnd end(order);
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, grain),
        [&](const tbb::blocked_range<std::size_t>& range) {
            const LoopOrder::Turn in_turn(order);
            turn(range.begin(), range.end());
        },
        tbb::simple_partitioner());
}

} // namespace vera
