// SPDX-License-Identifier: Apache-2.0
// The newest version of a plan that changes, passed between threads as an immutable snapshot.
#pragma once

#include "assets/plan/case_plan.hpp"

#include <memory>
#include <mutex>
#include <utility>

namespace tactus::plan {

/// One thread publishes, any thread reads; never called in a tick. A reader compares pointers to find out whether there
/// is a new version.
class PlanVersions {
public:
    void publish(std::shared_ptr<const CasePlan> plan) {
        const std::lock_guard lock(lock_);
        newest_ = std::move(plan);
    }
    /// Null before the first version.
    std::shared_ptr<const CasePlan> newest() const {
        const std::lock_guard lock(lock_);
        return newest_;
    }

private:
    mutable std::mutex lock_;
    std::shared_ptr<const CasePlan> newest_;
};

}  // namespace tactus::plan
