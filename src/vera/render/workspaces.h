// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace vera {

/// Workspaces that the turns of a parallel loop borrow, so that what one turn has allocated the
/// next one uses. There are as many as threads were ever at work at once.
template <typename Workspace>
class Workspaces {
public:
    explicit Workspaces(std::function<std::unique_ptr<Workspace>()> make)
        : make_(std::move(make)) {}

    /// Calls turn(workspace) with one that nobody else has. One that an exception has passed
    /// through is not used again.
    template <typename Turn>
    void lend(const Turn& turn) {
        std::unique_ptr<Workspace> workspace = take();
        turn(*workspace);
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(workspace));
    }

    /// To be called when none is lent.
    template <typename Visitor>
    void for_each(const Visitor& visit) {
        for (const auto& workspace : idle_)
            visit(*workspace);
    }

private:
    std::unique_ptr<Workspace> take() {
        {
            const std::lock_guard lock(mutex_);
            if (!idle_.empty()) {
                std::unique_ptr<Workspace> workspace = std::move(idle_.back());
                idle_.pop_back();
                return workspace;
            }
        }
        return make_();
    }

    std::function<std::unique_ptr<Workspace>()> make_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<Workspace>> idle_;
};

/// Adds up what the threads have done of a whole, and tells it.
class ProgressMeter {
public:
    ProgressMeter(Progress progress, double whole)
        : progress_(std::move(progress))
        , whole_(whole) {}

    void add(double part) {
        if (!progress_)
            return;
        const std::lock_guard lock(mutex_);
        done_ += part;
        progress_(std::min(done_ / whole_, 1.0));
    }

private:
    std::mutex mutex_;
    Progress progress_;
    double whole_;
    double done_ = 0;
};

} // namespace vera
