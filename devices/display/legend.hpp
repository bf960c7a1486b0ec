// SPDX-License-Identifier: Apache-2.0
// What the colours of a picture mean, and how large things are, drawn into its corners.
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
        Vec3 low{0.0}, high{1.0};  ///< a steady mixture between the two
    };
    std::string title;
    std::vector<Scale> scales;
    std::vector<Entry> entries;
    std::vector<std::string> warnings;  ///< in red: what could not be shown

    bool empty() const { return title.empty() && scales.empty() && entries.empty() && warnings.empty(); }
};

/// What the colours of a bone mean.
Legend::Scale density_scale(const geometry::DensityColours& colours);

/// The legend on a light ground, as an image of its own; `scale` pixels per unit, 13 units for a line of text.
Image legend_image(const Legend& legend, double scale);

/// Puts the legend into the lower left corner, a tenth of what is behind shining through.
void add_legend(Image& image, const Legend& legend);
/// The same in `width` columns from `x` on, in the corner that is the lower left one for who sees the picture.
void add_legend(Image& image, const Legend& legend, int x, int width, Flip flip);

/// A bar of a round length in the lower right corner. `metres_per_pixel` holds at the depth of what is looked at.
void add_scale_bar(Image& image, double metres_per_pixel);

}  // namespace tactus::display
