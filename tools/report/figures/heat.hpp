// SPDX-License-Identifier: Apache-2.0
// Colours of levels in pictures, with their scale.
#pragma once

#include "devices/display/figure.hpp"

namespace tactus::report {

inline constexpr int heat_shades = 24;

/// Dark violet over green to yellow with uniformly increasing lightness (0 to 1); also correct in grey.
display::Colour heat(double share);

/// The shade of a share, 0 … heat_shades − 1, and its colour.
int heat_shade(double share);
display::Colour heat_of_shade(int shade);

/// A bar of all shades with four numbers of this size, `low` to `high` dB from the bottom to the top.
void draw_heat_scale(display::Figure& figure, double x, double y, double height, double low, double high,
                     double text = 10.0);

}  // namespace tactus::report
