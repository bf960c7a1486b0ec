// SPDX-License-Identifier: Apache-2.0
// One program at a time changes a plan.
#pragma once

#include <chrono>
#include <filesystem>

namespace tactus::cases {

/// Held from reading a plan to writing it, or for as long as a run adds to it. A file beside the plan, ".NAME.lock",
/// stands for it; the system lets go of it when its holder dies, however that was.
class PlanLock {
public:
    /// Waits so long for others. Throws Error when they take longer, and when the folder cannot be written to.
    explicit PlanLock(const std::filesystem::path& plan, std::chrono::milliseconds patience = std::chrono::seconds(5));
    ~PlanLock();
    PlanLock(const PlanLock&) = delete;
    PlanLock& operator=(const PlanLock&) = delete;

private:
    std::filesystem::path file_;
    int handle_ = -1;
};

}  // namespace tactus::cases
