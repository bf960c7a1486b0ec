// SPDX-License-Identifier: Apache-2.0
// Lets preparations use several cores without knowing about threads: the caller passes in how to run jobs.
#pragma once

#include <functional>

namespace tactus {

/// Calls job(0) … job(count − 1), in any order and possibly concurrently, and returns when all are done. Exceptions of
/// jobs reach the caller. Each job must write to its own memory, so that the result does not depend on the order.
using RunJobs = std::function<void(int count, const std::function<void(int)>& job)>;

/// Runs jobs one after the other on the calling thread.
inline void run_in_turn(int count, const std::function<void(int)>& job) {
    for (int n = 0; n < count; ++n) job(n);
}

}  // namespace tactus
