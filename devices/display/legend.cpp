// SPDX-License-Identifier: Apache-2.0
#include "devices/display/legend.hpp"

#include "devices/display/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::display {

namespace {

constexpr double line = 19.0, margin = 10.0, size = 13.0, swatch = 13.0;
const Colour ink{40, 44, 50}, alarm{190, 30, 25};

Colour colour_of(const Vec3& c) {
    const auto byte = [](double v) { return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 1.0) * 255.0)); };
    return {byte(c.x), byte(c.y), byte(c.z)};
}

/// An upper estimate, because figures do not measure text.
double width_of(const std::string& text, bool bold = false) {
    return static_cast<double>(text.size()) * size * (bold ? 0.66 : 0.58);
}

/// Text size relative to the picture, so that it is readable in large and small pictures.
double scale_for(int width, int height) { return std::clamp(std::min(width, height) / 600.0, 0.55, 4.0); }

Image flipped(Image image, Flip flip) {
    const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
    std::uint8_t* const rgb = image.rgb.data();
    if (flip == Flip::upside_down)
        for (std::size_t y = 0; y < height / 2; ++y)
            std::swap_ranges(rgb + 3 * y * width, rgb + 3 * (y + 1) * width, rgb + 3 * (height - 1 - y) * width);
    if (flip == Flip::left_right)
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t x = 0; x < width / 2; ++x)
                std::swap_ranges(rgb + 3 * (y * width + x), rgb + 3 * (y * width + x + 1),
                                 rgb + 3 * (y * width + width - 1 - x));
    return image;
}

/// Blends onto `image` at (x, y) with the given opacity.
void lay_over(Image& image, const Image& over, int x, int y, double opacity) {
    for (int v = std::max(0, -y); v < std::min(over.height, image.height - y); ++v)
        for (int u = std::max(0, -x); u < std::min(over.width, image.width - x); ++u) {
            const std::uint8_t* from = over.pixel(u, v);
            std::uint8_t* to =
                image.rgb.data() + 3 * (static_cast<std::size_t>(y + v) * static_cast<std::size_t>(image.width) +
                                        static_cast<std::size_t>(x + u));
            for (int c = 0; c < 3; ++c)
                to[c] = static_cast<std::uint8_t>(std::lround(opacity * from[c] + (1.0 - opacity) * to[c]));
        }
}

}  // namespace

Legend::Scale density_scale(const geometry::DensityColours& colours) {
    return {"density of the bone, mg/cm3", fmt::format("core {:g}", colours.core_density),
            fmt::format("{:g} cortex", colours.cortex_density), colours.core, colours.cortex};
}

Image legend_image(const Legend& legend, double scale) {
    double width = legend.title.empty() ? 0.0 : width_of(legend.title, true);
    double height = 2.0 * margin + (legend.title.empty() ? 0.0 : line);
    for (const Legend::Scale& s : legend.scales) {
        width = std::max({width, width_of(s.title), width_of(s.low_text) + width_of(s.high_text) + 24.0});
        height += 2.2 * line + swatch;
    }
    for (const Legend::Entry& entry : legend.entries) width = std::max(width, swatch + 8.0 + width_of(entry.text));
    for (const std::string& warning : legend.warnings) width = std::max(width, width_of(warning));
    height += line * static_cast<double>(legend.entries.size() + legend.warnings.size());
    Figure figure(width + 2.0 * margin, height);
    figure.rectangle(0.0, 0.0, figure.width(), figure.height(), {252, 252, 253});
    double y = margin;
    const auto write = [&](const std::string& text, double x, Colour colour, bool bold = false) {
        figure.text({x, y + 13.0}, text, size, colour, TextAnchor::start, bold);
    };
    if (!legend.title.empty()) {
        write(legend.title, margin, ink, true);
        y += line;
    }
    for (const Legend::Scale& s : legend.scales) {
        write(s.title, margin, ink);
        y += line;
        constexpr int steps = 64;
        for (int n = 0; n < steps; ++n)
            figure.rectangle(margin + width * n / steps, y, width / steps + 0.5, swatch,
                             colour_of(s.low + (s.high - s.low) * (n / (steps - 1.0))));
        y += swatch;
        write(s.low_text, margin, ink);
        figure.text({margin + width, y + 13.0}, s.high_text, size, ink, TextAnchor::end);
        y += 1.2 * line;
    }
    for (const Legend::Entry& entry : legend.entries) {
        figure.rectangle(margin, y + 2.0, swatch, swatch, colour_of(entry.colour));
        write(entry.text, margin + swatch + 8.0, ink);
        y += line;
    }
    for (const std::string& warning : legend.warnings) {
        write(warning, margin, alarm);
        y += line;
    }
    return figure.image(scale);
}

void add_legend(Image& image, const Legend& legend) { add_legend(image, legend, 0, image.width, Flip::none); }

void add_legend(Image& image, const Legend& legend, int x, int width, Flip flip) {
    if (legend.empty()) return;
    const double scale = scale_for(width, image.height);
    const Image box = flipped(legend_image(legend, scale), flip);
    const int gap = static_cast<int>(margin * scale);
    lay_over(image, box, flip == Flip::left_right ? x + width - box.width - gap : x + gap,
             flip == Flip::upside_down ? gap : image.height - box.height - gap, 0.9);
}

void add_scale_bar(Image& image, double metres_per_pixel) {
    if (!(metres_per_pixel > 0.0)) return;
    const double wanted = 0.16 * image.width * metres_per_pixel;
    const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
    const double length = decade * (wanted >= 5.0 * decade ? 5.0 : wanted >= 2.0 * decade ? 2.0 : 1.0);
    const double scale = scale_for(image.width, image.height), pixels = length / metres_per_pixel;
    const std::string text =
        length < 0.9995e-3 ? fmt::format("{:g} um", length * 1e6) : fmt::format("{:g} mm", length * 1e3);
    const double width = std::max(pixels / scale, width_of(text)) + 2.0 * margin;
    Figure figure(width, line + 2.0 * margin);
    figure.rectangle(0.0, 0.0, figure.width(), figure.height(), {252, 252, 253});
    figure.text({0.5 * width, margin + 9.0}, text, size, ink, TextAnchor::middle);
    const double left = 0.5 * (width - pixels / scale);
    figure.rectangle(left, margin + line - 3.0, pixels / scale, 4.0, ink);
    const Image box = figure.image(scale);
    const int gap = static_cast<int>(margin * scale);
    lay_over(image, box, image.width - box.width - gap, image.height - box.height - gap, 0.9);
}

}  // namespace tactus::display
