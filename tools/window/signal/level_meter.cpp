// SPDX-License-Identifier: Apache-2.0
#include "tools/window/signal/level_meter.hpp"

#include "tools/window/widgets/theme.hpp"

#include <algorithm>

namespace tactus::window {

namespace {

constexpr double lowest_on_meter = -60.0, highest_on_meter = 6.0;

}  // namespace

double meter_share(double level_db) {
    return std::clamp((level_db - lowest_on_meter) / (highest_on_meter - lowest_on_meter), 0.0, 1.0);
}

void draw_level_meter(const Painter& paint, const Box& bar, const Level& level) {
    const auto height_of = [&](double db) { return bar.bottom - meter_share(db) * (bar.bottom - bar.top); };
    const double peak = decibels(level.peak());
    const ImU32 ink = peak >= 0.0 ? tone::bad : tone::good;
    paint.box(bar, tone::lane);
    paint.box({bar.left, height_of(decibels(level.rms)), bar.right, bar.bottom}, faded(ink, 0.6));
    paint.line({bar.left, height_of(peak)}, {bar.right, height_of(peak)}, ink, 2.0);
    paint.line({bar.left, height_of(0.0)}, {bar.right, height_of(0.0)}, tone::dim);
}

}  // namespace tactus::window
