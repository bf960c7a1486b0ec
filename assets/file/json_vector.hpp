// SPDX-License-Identifier: Apache-2.0
// Positions and directions in JSON.
#pragma once

#include "assets/file/json.hpp"
#include "dsp/core/types.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tactus::file {

inline Json json_of(const Vec3& v) { return {v.x, v.y, v.z}; }

/// Reads a list of three numbers whose magnitude is at most `farthest`; nothing for other values.
inline std::optional<Vec3> vector_of(const Json& json, double farthest) {
    if (!json.is_array() || json.size() != 3) return {};
    Vec3 v;
    for (int axis = 0; axis < 3; ++axis) {
        const Json& part = json[static_cast<std::size_t>(axis)];
        if (!part.is_number()) return {};
        v[axis] = part.get<double>();
        if (!(std::abs(v[axis]) <= farthest)) return {};
    }
    return v;
}

}  // namespace tactus::file
