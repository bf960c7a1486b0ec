// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/heat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tactus::report {

display::Colour heat(double share) {
    constexpr std::array<std::array<double, 3>, 6> stops{
        {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};
    const double at = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), stops.size() - 2);
    const auto mix = [&](std::size_t part) {
        return static_cast<std::uint8_t>(stops[i][part] +
                                         (at - static_cast<double>(i)) * (stops[i + 1][part] - stops[i][part]));
    };
    return {mix(0), mix(1), mix(2)};
}

int heat_shade(double share) { return static_cast<int>(std::clamp(share, 0.0, 1.0) * (heat_shades - 1) + 0.5); }

display::Colour heat_of_shade(int shade) { return heat(static_cast<double>(shade) / (heat_shades - 1)); }

void draw_heat_scale(display::Figure& figure, double x, double y, double height, double low, double high, double text) {
    constexpr display::Colour ink{0x22, 0x26, 0x2E};
    for (int i = 0; i < heat_shades; ++i)
        figure.rectangle(x, y + height - height * (i + 1) / heat_shades, 12.0, height / heat_shades + 0.4,
                         heat_of_shade(i));
    for (int i = 0; i <= 3; ++i)
        figure.text({x + 16.0, y + height - height * i / 3.0 + 0.4 * text},
                    fmt::format("{:.0f} dB", low + (high - low) * i / 3.0), text, ink);
}

}  // namespace tactus::report
