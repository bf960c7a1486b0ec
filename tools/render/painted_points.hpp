// SPDX-License-Identifier: Apache-2.0
// The painted points of the fracture of one surface, and which of its places they colour.
#pragma once

#include "dsp/core/types.hpp"

#include <array>
#include <map>
#include <vector>

namespace tactus::render {

class PaintedPoints {
public:
    /// m, in the frame of the surface; `normal`: of the surface there, of any length.
    void add(const Vec3& point, const Vec3& normal);
    bool empty() const { return cells_.empty(); }
    /// Whether a painted point is within 0.9 mm of `at` (m) and on the same side: the back of a thin wall is not painted.
    bool covers(const Vec3& at, const Vec3& normal) const;

private:
    using Key = std::array<int, 3>;
    static Key cell_of(const Vec3& at);
    struct Point {
        Vec3 at, normal;
    };
    std::map<Key, std::vector<Point>> cells_;
};

}  // namespace tactus::render
