// SPDX-License-Identifier: Apache-2.0
// What a scope shows, as lines in the quantities of its axes: for the window, and for a file.
#pragma once

#include "devices/display/figure.hpp"
#include "dsp/signal/spectrum/welch.hpp"
#include "tools/view/canvas.hpp"
#include "tools/view/signal/axis.hpp"
#include "tools/view/signal/feed.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::view {

struct Curve {
    std::string name;
    std::uint32_t ink = 0;  ///< as in theme.hpp
    std::vector<Point> points;
    bool is_reference = false;
};

struct Plot {
    std::string title, x_unit, y_unit;
    Range x, y;
    bool is_logarithmic = false;  ///< across
    std::vector<Curve> curves;

    /// Share of the width, or of the height from the bottom.
    double across(double value) const;
    double up(double value) const;
    /// The opposite of `across`.
    double value_at(double across) const;
    std::vector<double> x_ticks(int most) const {
        return is_logarithmic ? decade_ticks(x, most) : linear_ticks(x, most);
    }
};

/// How the numbers of a type are shown: which of its columns at first, and in what unit.
struct Display {
    double factor = 1.0;
    std::string unit;
    std::size_t columns = 1;
};
Display display_of(const ValueType& type, const std::string& unit);

/// The last `span` seconds before `now`, at most about two points for each of `pixels`.
Plot time_plot(const Trace& trace, const Display& display, double now, double span, int pixels);

/// Power density of one column of the last `span` seconds, dB re (unit)²/Hz. `reference` (may be empty) is shifted to
/// the same power over the frequencies that both have.
Plot spectrum_plot(const Trace& trace, const Display& display, double rate, double now, double span,
                   const signal::Spectrum& reference);

/// Spectrum of a sound file. Throws Error.
signal::Spectrum spectrum_of_file(const std::filesystem::path& path);

/// As a picture on white, with axes and names.
display::Figure figure_of(const Plot& plot, double width = 720, double height = 320);
/// The rows of a trace within a range of time, "time s,px,…". Throws Error when the file cannot be written.
void write_csv(const Trace& trace, Range time, const std::filesystem::path& path);

}  // namespace tactus::view
