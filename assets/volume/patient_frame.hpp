// SPDX-License-Identifier: Apache-2.0
// The two frames of patient data, LPS and RAS, as types, so that they cannot be confused.
#pragma once

#include "dsp/core/types.hpp"

namespace tactus::volume {

/// Axes towards left, posterior, superior (DICOM, and this program inside) or right, anterior, superior (NIfTI).
enum class Frame { lps, ras };

/// Position of sample (i, j, k) of a volume: origin + step · (i, j, k), m. The columns of `step` may have any length
/// and need not be orthogonal (a tilted gantry shears a volume).
template <Frame frame>
struct SampleMap {
    Mat3 step{1.0};
    Vec3 origin{0.0};

    Vec3 operator()(const Vec3& index) const { return origin + step * index; }
};

/// The same map in the other frame: x and y change sign.
inline Vec3 turned_about_z(const Vec3& p) { return {-p.x, -p.y, p.z}; }

inline SampleMap<Frame::lps> to_lps(const SampleMap<Frame::ras>& map) {
    SampleMap<Frame::lps> out;
    for (int axis = 0; axis < 3; ++axis) out.step[axis] = turned_about_z(map.step[axis]);
    out.origin = turned_about_z(map.origin);
    return out;
}
inline SampleMap<Frame::ras> to_ras(const SampleMap<Frame::lps>& map) {
    SampleMap<Frame::ras> out;
    for (int axis = 0; axis < 3; ++axis) out.step[axis] = turned_about_z(map.step[axis]);
    out.origin = turned_about_z(map.origin);
    return out;
}

}  // namespace tactus::volume
