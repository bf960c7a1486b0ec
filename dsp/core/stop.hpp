// SPDX-License-Identifier: Apache-2.0
// Long computations look between their parts whether their result is still wanted. Who begins one says on its thread
// where to look; none of the functions in between has to pass it on.
#pragma once

#include "dsp/core/jobs.hpp"

#include <functional>
#include <stop_token>

namespace tactus {

/// Thrown out of a computation that is wanted no longer. No error: what handles errors must let it pass.
struct Stopped {};

/// Null: the computation is never stopped. Called on all threads of the computation.
using IsStopped = std::function<bool()>;

/// While it lives, computations on this thread stop when it says so.
class StopScope {
public:
    explicit StopScope(IsStopped is_stopped);
    explicit StopScope(std::stop_token stop);
    ~StopScope();
    StopScope(const StopScope&) = delete;
    StopScope& operator=(const StopScope&) = delete;

private:
    IsStopped is_stopped_;
    const IsStopped* before_;
};

/// For the scopes of other threads that take part in the computation of this one.
IsStopped stop_of_this_thread();

/// Throws Stopped when the computation on this thread is wanted no longer. To be called every few milliseconds.
void leave_if_stopped();

/// Runs the same jobs and looks before each of them.
RunJobs stoppable(RunJobs run);

}  // namespace tactus
