// SPDX-License-Identifier: Apache-2.0
// Work for Beside that is left when its result is let go.
#pragma once

#include "dsp/core/stop.hpp"

#include <stop_token>
#include <utility>

namespace tactus::study {

/// The same work; what it calls looks whether it is to stop, see StopScope.
template <class Work>
auto leaving(Work work) {
    return [work = std::move(work)](std::stop_token stop) mutable {
        const StopScope scope(std::move(stop));
        return work();
    };
}

}  // namespace tactus::study
