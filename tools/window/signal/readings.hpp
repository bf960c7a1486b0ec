// SPDX-License-Identifier: Apache-2.0
// The numbers that a scope shows beside its curves, as text.
#pragma once

#include "tools/window/signal/measures.hpp"
#include "tools/window/signal/plot.hpp"

#include <span>
#include <string>

namespace tactus::window {

/// A time between two instants: "5.000 ms", "1.250 s".
std::string span_words(double seconds);

/// "peak -6.02 dB, rms -9.03 dB re 1 N"; `level` in the shown unit; empty without values. `column`: its name, where a
/// value has several.
std::string level_words(const Level& level, const std::string& unit, const std::string& column = "");

/// "3 values lost, 1 value not finite"; empty: all are there, and finite.
std::string flaw_words(const Flaws& flaws);

/// A trace that is drawn, with the unit that it is drawn in.
struct DrawnTrace {
    const Trace* trace = nullptr;
    Display display;
};

/// Of a wave. One position: the time and the values at it; two: the differences of time and values, and the frequency
/// of that period. Values lie between two samples by interpolation, but not across a gap. `at`: positions as drawn on `plot`.
std::string wave_words(const Plot& plot, const DrawnTrace& drawn, std::span<const Point> at);
/// Of a spectrum: the nearest bin that is drawn; two: the differences.
std::string spectrum_words(const Plot& plot, std::span<const Point> at);
/// Of a waterfall: the bin of the cell and its level; two: the differences. Empty where nothing was measured.
std::string waterfall_words(const Plot& plot, std::span<const Point> at);
/// Of a histogram: the part and its share of all values; two: the share between the positions.
std::string histogram_words(const Plot& plot, std::span<const Point> at);
/// Of a curve of pairs: the position itself; two: the differences.
std::string xy_words(const Plot& plot, std::span<const Point> at);

}  // namespace tactus::window
