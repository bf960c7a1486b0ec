// SPDX-License-Identifier: Apache-2.0
// How long preparations use more than one core without knowing about threads: the caller says how jobs are run.
#pragma once

#include <functional>

namespace tactus {

/// Calls job(0) … job(count − 1), in any order and maybe at the same time, and returns when all are done. What a job
/// throws reaches the caller. Users give each job its own place to write to, so that the result does not depend on it.
using RunJobs = std::function<void(int count, const std::function<void(int)>& job)>;

/// One after the other, on the calling thread.
inline void run_in_turn(int count, const std::function<void(int)>& job) {
    for (int n = 0; n < count; ++n) job(n);
}

}  // namespace tactus
