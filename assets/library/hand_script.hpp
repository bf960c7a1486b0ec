// SPDX-License-Identifier: Apache-2.0
// Builds the script of a hand.
#pragma once

#include "dsp/core/types.hpp"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace tactus::library {

/// Lines in order of time, for the driver 'scripted': the pose of the hand, and the buttons held until then.
class HandScript {
public:
    void go(double seconds, const Pose& to, const char* held) {
        time_ += seconds;
        text_ += fmt::format("{:.3f} s: {:.9g} {:.9g} {:.9g} mm, {} deg | {}\n", time_, to.position.x * 1e3,
                             to.position.y * 1e3, to.position.z * 1e3, turns(to.orientation), held);
        at_ = to;
    }
    void stay(double seconds, const char* held) { go(seconds, at_, held); }
    double time() const { return time_; }
    const std::string& text() const { return text_; }

private:
    /// Rotations about the fixed axes x, then y, then z.
    static std::string turns(const Quat& q) {
        const Mat3 m = glm::mat3_cast(q);
        const double y = std::asin(std::clamp(-m[0][2], -1.0, 1.0)), x = std::atan2(m[1][2], m[2][2]),
                     z = std::atan2(m[0][1], m[0][0]);
        constexpr double degrees = 180.0 / std::numbers::pi;
        return fmt::format("{:.9g} {:.9g} {:.9g}", x * degrees, y * degrees, z * degrees);
    }

    double time_ = 0.0;
    std::string text_;
    Pose at_;
};

}  // namespace tactus::library
