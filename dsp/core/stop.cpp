// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/stop.hpp"

#include <utility>

namespace tactus {

namespace {

thread_local constinit const IsStopped* asked = nullptr;

}  // namespace

StopScope::StopScope(IsStopped is_stopped)
    : is_stopped_(std::move(is_stopped)), before_(std::exchange(asked, &is_stopped_)) {}

StopScope::StopScope(std::stop_token stop) : StopScope([stop = std::move(stop)] { return stop.stop_requested(); }) {}

StopScope::~StopScope() { asked = before_; }

IsStopped stop_of_this_thread() { return asked ? *asked : IsStopped(); }

void leave_if_stopped() {
    if (asked && *asked && (*asked)()) throw Stopped{};
}

RunJobs stoppable(RunJobs run) {
    return [run = std::move(run)](int count, const std::function<void(int)>& job) {
        run(count, [&job](int n) {
            leave_if_stopped();
            job(n);
        });
    };
}

}  // namespace tactus
