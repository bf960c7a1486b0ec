// SPDX-License-Identifier: Apache-2.0
// Colour legend and scale bar in the corners of an image.
#pragma once

#include "devices/display/offscreen.hpp"
#include "dsp/display/screen.hpp"
#include "dsp/geometry/brick_surface.hpp"

#include <string>
#include <vector>

namespace tactus::display {

struct Legend {
    struct Entry {
        std::string text;
        Vec3 colour{0.5};  ///< sRGB
    };
    struct Scale {
        std::string title, low_text, high_text;
        Vec3 low{0.0}, high{1.0};  ///< a gradient from low to high
    };
    std::string title;
    std::vector<Scale> scales;
    std::vector<Entry> entries;
    std::vector<std::string> warnings;  ///< shown in red: objects that could not be drawn

    bool empty() const { return title.empty() && scales.empty() && entries.empty() && warnings.empty(); }
};

/// Returns the legend of bone colours.
Legend::Scale density_scale(const geometry::DensityColours& colours);

/// The legend as an image with a light background; `scale` pixels per unit, 13 units per line of text.
Image legend_image(const Legend& legend, double scale);

/// Draws the legend into the lower left corner with 90 % opacity.
void add_legend(Image& image, const Legend& legend);
/// The same within `width` columns from `x` on, in the corner that the viewer sees as the lower left one.
void add_legend(Image& image, const Legend& legend, int x, int width, Flip flip);

/// Draws a scale bar of a round length in the lower right corner. `metres_per_pixel` applies at the depth of the
/// target.
void add_scale_bar(Image& image, double metres_per_pixel);

}  // namespace tactus::display
