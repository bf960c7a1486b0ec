// SPDX-License-Identifier: Apache-2.0
// Colours of a scene, sRGB 0 to 1.
#pragma once

#include "dsp/coupling/scene.hpp"

#include <array>

namespace tactus::render::scene_colours {

inline const Vec3 steel{0.62, 0.65, 0.70}, force_colour{0.86, 0.20, 0.16}, hand_colour{0.25, 0.45, 0.85},
    proxy_colour{0.95, 0.60, 0.12}, paint_colour{0.90, 0.38, 0.30}, still_colour{0.80, 0.79, 0.75},
    guide_colour{0.10, 0.52, 0.55}, spared_colour{0.72, 0.20, 0.45}, artery_colour{0.86, 0.36, 0.32},
    vein_colour{0.36, 0.46, 0.80}, strained_colour{0.30, 0.02, 0.12}, compared_colour{0.10, 0.40, 0.90},
    heat_colour{0.98, 0.62, 0.02};
// One colour per scene slot, distinguishable with most kinds of colour blindness.
inline const std::array<Vec3, coupling::Scene::max_objects> group_colours{{{0.88, 0.83, 0.70},
                                                                           {0.42, 0.62, 0.80},
                                                                           {0.55, 0.72, 0.45},
                                                                           {0.83, 0.62, 0.45},
                                                                           {0.66, 0.55, 0.76},
                                                                           {0.45, 0.72, 0.70},
                                                                           {0.82, 0.72, 0.42},
                                                                           {0.78, 0.52, 0.58},
                                                                           {0.24, 0.42, 0.68},
                                                                           {0.90, 0.66, 0.24},
                                                                           {0.30, 0.55, 0.36},
                                                                           {0.62, 0.34, 0.30},
                                                                           {0.45, 0.33, 0.60},
                                                                           {0.70, 0.84, 0.90},
                                                                           {0.93, 0.78, 0.80},
                                                                           {0.50, 0.46, 0.38}}};

}  // namespace tactus::render::scene_colours
