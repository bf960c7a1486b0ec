// SPDX-License-Identifier: Apache-2.0
// A lock that lets only one program at a time change a plan.
#pragma once

#include <chrono>
#include <filesystem>

namespace tactus::plan {

/// Held from reading a plan to writing it, or during a run that adds to it. Locks the file ".NAME.lock" beside the
/// plan; the system releases it when the holding process ends.
class PlanLock {
public:
    /// Waits for other holders up to a limit. Throws Error after that, and when the folder is not writable.
    explicit PlanLock(const std::filesystem::path& plan, std::chrono::milliseconds patience = std::chrono::seconds(5));
    ~PlanLock();
    PlanLock(const PlanLock&) = delete;
    PlanLock& operator=(const PlanLock&) = delete;

private:
    std::filesystem::path file_;
    int handle_ = -1;
};

}  // namespace tactus::plan
