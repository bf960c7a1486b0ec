// SPDX-License-Identifier: Apache-2.0
// Driver "openigtlink": the pose of a tool from a tracker's server or from 3D Slicer. It gives no force.
#pragma once

#include "devices/driver/backend.hpp"
#include "graph/node/options.hpp"

#include <cstdint>
#include <memory>

namespace tactus::openigtlink {

/// Interpolates between the poses of a tracker, which come 10 to 100 times a second. The hand moves from one pose to the
/// next in the time between them, so it lags by that time and its position has no jumps.
class Interpolation {
public:
    void add(const Pose& pose, std::int64_t at_ns) noexcept;
    /// Returns false before the first pose, and `oldest_ns` after the last one.
    bool at(std::int64_t now_ns, std::int64_t oldest_ns, Pose& pose, Twist& twist) const noexcept;
    void clear() noexcept { count_ = 0; }

private:
    Pose from_, to_;
    std::int64_t from_ns_ = 0, arrived_ns_ = 0;
    int count_ = 0;
};

/// Options: host, port, transform, timeout. Throws Error.
std::unique_ptr<driver::Backend> make_tracker(Options& options);

}  // namespace tactus::openigtlink
