// SPDX-License-Identifier: Apache-2.0
#include "tools/report/blocks/picture_figure.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

display::Colour colour_of(const Vec3& c) {
    const auto byte = [](double v) { return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 1.0) * 255.0)); };
    return {byte(c.x), byte(c.y), byte(c.z)};
}

}  // namespace

display::Figure figure_of(const render::LabelledPicture& picture, double min_size) {
    constexpr display::Colour ink{0, 0, 0}, rim{0x33, 0x33, 0x33};
    constexpr double bold_from = 13.0;
    const double wide = picture.image.width, high = picture.image.height;
    display::Figure figure(wide, high);
    figure.begin("picture", picture.caption);
    figure.picture(0.0, 0.0, wide, high, picture.image);
    for (const render::PictureText& t : picture.texts) {
        if (t.mark) {
            figure.rectangle(t.x - 14.5, t.y - 10.5, 11.0, 11.0, rim);
            figure.rectangle(t.x - 14.0, t.y - 10.0, 10.0, 10.0, colour_of(*t.mark));
        }
        figure.text({t.x, t.y}, t.text, std::max(t.size, min_size), ink,
                    t.anchor == 's'   ? display::TextAnchor::start
                    : t.anchor == 'e' ? display::TextAnchor::end
                                      : display::TextAnchor::middle,
                    t.size > bold_from, false, true);
    }
    if (picture.bar_length > 0.0) {
        const double left = picture.bar_x, right = left + picture.bar_length, low = picture.bar_y;
        figure.line({{left, low - 8.0}, {left, low}, {right, low}, {right, low - 8.0}}, ink, 2.0);
    }
    figure.end();
    return figure;
}

}  // namespace tactus::report
