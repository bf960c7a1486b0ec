// SPDX-License-Identifier: Apache-2.0
// The size of figures and of their text.
#pragma once

namespace tactus::report {

/// Lengths in units of figures, 1/96 inch.
struct FigureStyle {
    double width;                 ///< of the whole figure
    double left, right;           ///< margins beside the panels
    double text, title, heading;  ///< size of numbers and words, of the name of a panel, of the name of a figure
    double panel_height;          ///< factor of the heights that panels have on a screen

    double panel_width() const { return width - left - right; }
    /// Of a distance that makes room for text.
    double gap(double on_screen) const { return on_screen * text / 10.0; }
    double height(double on_screen) const { return on_screen * panel_height; }
};

inline constexpr double units_per_mm = 96.0 / 25.4, units_per_point = 96.0 / 72.0;

inline constexpr FigureStyle screen_style{740.0, 70.0, 30.0, 10.0, 11.0, 15.0, 1.0};
/// One column of a journal, 85 mm, in which no text is below 6 points.
inline constexpr FigureStyle journal_style{
    85.0 * units_per_mm, 40.0, 8.0, 6.0 * units_per_point, 6.5 * units_per_point, 7.0 * units_per_point, 0.6};

}  // namespace tactus::report
