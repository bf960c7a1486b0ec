// SPDX-License-Identifier: Apache-2.0
// The painted points of a fracture, and which places of a surface they colour.
#pragma once

#include "dsp/core/types.hpp"

#include <array>
#include <map>
#include <vector>

namespace tactus::picture {

class PaintedPoints {
public:
    /// m, in the frame of the surface.
    void add(const Vec3& point);
    bool empty() const { return cells_.empty(); }
    /// Whether a painted point is within 0.9 mm of `at` (m).
    bool covers(const Vec3& at) const;

private:
    using Key = std::array<int, 3>;
    static Key cell_of(const Vec3& at);
    std::map<Key, std::vector<Vec3>> cells_;
};

}  // namespace tactus::picture
