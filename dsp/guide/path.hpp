// SPDX-License-Identifier: Apache-2.0
// A path through points, and the nearest place on it.
#pragma once

#include "dsp/core/types.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::guide {

class Path {
public:
    static constexpr std::size_t max_points = 200;
    static constexpr int steps_per_span = 8;  ///< straight pieces between two points of a smooth path

    Path() = default;
    /// Through these points, m: straight, or as a centripetal Catmull–Rom spline (Yuksel, Schaefer and Keyser 2011) of
    /// short straight pieces. Points that follow each other must differ. Throws Error. Allocates.
    Path(std::span<const Vec3> points, bool is_smooth, bool is_closed);

    struct Place {
        Vec3 point{0.0};  ///< m
        Vec3 tangent{0.0};  ///< of length 1
        double along = 0.0;  ///< m from the first point
    };
    /// Looks at every piece: the answer depends on `p` only. Real-time safe.
    Place nearest(const Vec3& p) const noexcept;

    double length() const noexcept { return length_; }  ///< m
    /// The ends of the straight pieces, from the first point to the last.
    std::vector<Vec3> corners() const;

private:
    struct Piece {
        Vec3 from, direction;  // of length 1
        double length, along;
    };
    std::vector<Piece> pieces_;
    double length_ = 0.0;
};

}  // namespace tactus::guide
