// SPDX-License-Identifier: Apache-2.0
// A bar with the level of a sound: root mean square, and a line at the peak.
#pragma once

#include "tools/window/signal/measures.hpp"
#include "tools/window/widgets/painter.hpp"

namespace tactus::window {

/// The share of the bar below a level: 0 at -60 dB, 1 at +6 dB re full scale.
double meter_share(double level_db);

/// Red from full scale (0 dB) on, where a sound card clips.
void draw_level_meter(const Painter& paint, const Box& bar, const Level& level);

}  // namespace tactus::window
