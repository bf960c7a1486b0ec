// SPDX-License-Identifier: Apache-2.0
// The triangles of a box, outwards, by its corners: bit 0 of a corner's number is x, bit 1 y, bit 2 z.
#pragma once

#include <array>

namespace tactus::test {

inline constexpr std::array<std::array<int, 3>, 12> box_faces{{{0, 2, 1},
                                                               {1, 2, 3},
                                                               {4, 5, 6},
                                                               {5, 7, 6},
                                                               {0, 1, 4},
                                                               {1, 5, 4},
                                                               {2, 6, 3},
                                                               {3, 6, 7},
                                                               {0, 4, 2},
                                                               {2, 4, 6},
                                                               {1, 3, 5},
                                                               {3, 7, 5}}};

}  // namespace tactus::test
