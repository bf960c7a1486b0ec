// SPDX-License-Identifier: Apache-2.0
#include "tools/window/hand/hand_sight.hpp"

#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::window {

namespace {

constexpr double usual_letters = 14.0;

/// As the letters, so that a dense screen shows all in the same size.
double scale() { return static_cast<double>(ImGui::GetFontSize()) / usual_letters; }

double share_of(const HandSight& sight) { return std::clamp(sight.force_N / std::max(sight.limit_N, 0.1), 0.0, 1.0); }

ImU32 ink_of(const HandSight& sight) {
    const double share = share_of(sight);
    return share > 0.8 ? tone::bad : share > 0.4 ? tone::warm : tone::good;
}

}  // namespace

void draw_spring(const Painter& paint, const SeenAt& seen, const HandSight& sight) {
    const auto hand = seen(sight.hand), cursor = seen(sight.wanted);
    if (!hand || !cursor) return;
    const double s = scale();
    const ImU32 ink = ink_of(sight);
    constexpr int turns = 16;  // of half a coil
    const Point along = *cursor - *hand;
    const double length = std::hypot(along.x, along.y);
    Point before = *hand;
    for (int i = 1; i <= turns && length > 3.0 * s; ++i) {
        const double side = i == turns ? 0.0 : (i % 2 == 0 ? -4.0 : 4.0) * s;
        const Point at =
            *hand + along * (i / static_cast<double>(turns)) + Point{-along.y / length * side, along.x / length * side};
        paint.line(before, at, ink, 2.0 * s);
        before = at;
    }
    paint.dot(*cursor, 6.0 * s, ink);
    paint.dot(*hand, 3.0 * s, colour(0x1e293b));
    set_spot("hand cursor", {cursor->x - 6.0 * s, cursor->y - 6.0 * s, cursor->x + 6.0 * s, cursor->y + 6.0 * s});
    set_spot("hand tool", {hand->x - 3.0 * s, hand->y - 3.0 * s, hand->x + 3.0 * s, hand->y + 3.0 * s});
}

double draw_force_bar(const Painter& paint, const Box& picture, const HandSight& sight) {
    const double s = scale(), size = 0.85 * usual_letters * s;
    const double high = 0.4 * picture.height(), wide = 14.0 * s, right = picture.right - 14.0 * s;
    const Box bar{right - wide, picture.bottom - 34.0 * s - high, right, picture.bottom - 34.0 * s};
    paint.box({bar.left - 4.0 * s, bar.top - 4.0 * s, bar.right + 4.0 * s, picture.bottom - 8.0 * s},
              colour(0xffffff, 215), 4.0 * s);
    paint.frame(bar, colour(0x1e293b), 2.0 * s);
    set_spot("force bar", bar);
    paint.box({bar.left, bar.bottom - share_of(sight) * high, bar.right, bar.bottom}, ink_of(sight), 2.0 * s);
    const std::string text = fmt::format("{}{}{:.1f} N", sight.name, sight.name.empty() ? "" : ": ", sight.force_N);
    const double text_wide = paint.width_of(text, size);
    paint.box({right - text_wide - 6.0 * s, picture.bottom - 30.0 * s, right + 4.0 * s, picture.bottom - 8.0 * s},
              colour(0xffffff, 215), 4.0 * s);
    paint.text({right - text_wide, picture.bottom - 28.0 * s}, size, colour(0x1e293b), text);
    return right - std::max(text_wide + 6.0 * s, wide + 4.0 * s);
}

}  // namespace tactus::window
