// SPDX-License-Identifier: Apache-2.0
// The curves of a scope in axis units, for the window and for export.
#pragma once

#include "devices/display/figure.hpp"
#include "dsp/signal/spectrum/welch.hpp"
#include "tools/window/signal/axis.hpp"
#include "tools/window/signal/feed.hpp"
#include "tools/window/signal/measures.hpp"
#include "tools/window/widgets/canvas.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::window {

struct Curve {
    std::string name;
    std::uint32_t ink = 0;  ///< as in theme.hpp
    std::vector<Point> points;
    std::vector<std::size_t> begins = {};  ///< points that are not joined to the one before, ascending
    bool is_reference = false;
    std::optional<double> last = {};  ///< the latest value, where there is one
};

/// The parts of a curve that are drawn as one line.
std::vector<std::span<const Point>> pieces_of(const Curve& curve);

struct Plot {
    std::string title, x_unit, y_unit;
    std::string note;        ///< what a person should know of it: "too few values"
    std::string level_unit;  ///< of spectra
    Range x, y;
    double origin = 0.0;  ///< s, the time at which `x` is 0; of waves
    bool is_logarithmic = false;  ///< across
    std::vector<Curve> curves;
    std::optional<Waterfall> waterfall;  ///< across: its frequencies; up: its times

    /// Position as a fraction of the width, or of the height from the bottom.
    double across(double value) const;
    double up(double value) const;
    /// The inverse of `across`.
    double value_at(double across) const;
    /// The inverse of `up`.
    double height_at(double up) const { return y.low + up * y.span(); }
    std::vector<double> x_ticks(int most) const {
        return is_logarithmic ? decade_ticks(x, most) : linear_ticks(x, most);
    }
};

/// Display of a value type: its default columns and unit.
struct Display {
    double factor = 1.0;
    std::string unit;
    std::size_t columns = 1;
};
Display display_of(const ValueType& type, const std::string& unit);

/// SI units of the columns of a value type: those of a trace.
std::vector<std::string> column_units(const ValueType& type, const std::string& unit);

/// The last `span` seconds before `now`, with about two points per pixel. `origin`: the time that is 0 on the axis.
Plot time_plot(const Trace& trace, const Display& display, double now, double span, int pixels, double origin = 0.0);

/// Power density of one column of the last `span` seconds, dB re (unit)²/Hz. `reference` (may be empty) is shifted to
/// the same power over the frequencies that both have.
Plot spectrum_plot(const Trace& trace, std::size_t column, const Display& display, double rate, double now, double span,
                   const signal::Spectrum& reference);

/// The range of levels of a spectrum: 90 dB below the largest.
void fit_levels(Plot& plot);

/// Shares of the values of one column in equal parts of their range, over the last `span` seconds.
Plot histogram_plot(const Trace& trace, std::size_t column, const Display& display, double now, double span);
/// One column over another; both of the last `span` seconds, at most the newest 4000 values.
Plot xy_plot(const Trace& x, std::size_t x_column, const Display& x_display, const Trace& y, std::size_t y_column,
             const Display& y_display, double now, double span);
/// Spectra of the last `span` seconds, the latest at the top.
Plot waterfall_plot(const Trace& trace, std::size_t column, const Display& display, double rate, double now,
                    double span);
/// The colour of a level in a waterfall, of 90 dB below `top`: dark to bright.
std::uint32_t waterfall_ink(double level_db, double top_db);
/// The largest level of a waterfall, rounded up to 10 dB.
double top_of(const Waterfall& waterfall);

/// Spectrum of a sound file. Throws Error.
signal::Spectrum spectrum_of_file(const std::filesystem::path& path);

/// A figure with white background, axes and names.
display::Figure figure_of(const Plot& plot, double width = 720, double height = 320);

}  // namespace tactus::window
