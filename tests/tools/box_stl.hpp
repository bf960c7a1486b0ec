// SPDX-License-Identifier: Apache-2.0
// A box as the text of an STL file.
#pragma once

#include "dsp/core/types.hpp"

#include <sstream>
#include <string>

namespace tactus::test {

/// A box of 12 triangles, corners in the file's numbers; `open` leaves two of them out.
inline std::string box_stl(const Vec3& low, const Vec3& high, bool open = false) {
    const auto corner = [&](int n) {
        return Vec3(n & 1 ? high.x : low.x, n & 2 ? high.y : low.y, n & 4 ? high.z : low.z);
    };
    constexpr int faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                  {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    std::ostringstream text;
    text.precision(12);
    text << "solid box\n";
    for (int f = open ? 2 : 0; f < 12; ++f) {
        text << "facet normal 0 0 0\nouter loop\n";
        for (const int n : faces[f])
            text << "vertex " << corner(n).x << ' ' << corner(n).y << ' ' << corner(n).z << '\n';
        text << "endloop\nendfacet\n";
    }
    text << "endsolid\n";
    return text.str();
}

}  // namespace tactus::test
