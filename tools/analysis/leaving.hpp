// SPDX-License-Identifier: Apache-2.0
// Cancellation of background work when its result is discarded.
#pragma once

#include "dsp/core/stop.hpp"

#include <stop_token>
#include <utility>

namespace tactus::analysis {

/// Wraps the work so that the functions it calls check for cancellation, see StopScope.
template <class Work>
auto leaving(Work work) {
    return [work = std::move(work)](std::stop_token stop) mutable {
        const StopScope scope(std::move(stop));
        return work();
    };
}

}  // namespace tactus::analysis
