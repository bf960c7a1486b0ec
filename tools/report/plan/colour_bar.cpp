// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plan/colour_bar.hpp"

#include <cstdint>

namespace tactus::report {

display::Figure colour_bar(const std::function<Vec3(double share)>& colour, const std::string& least,
                           const std::string& most) {
    constexpr double left = 190.0, width = 180.0;
    constexpr int steps = 90;
    display::Figure figure(560.0, 26.0);
    for (int n = 0; n < steps; ++n) {
        const Vec3 c = 255.0 * colour((n + 0.5) / steps);
        figure.rectangle(
            left + n * width / steps, 6.0, width / steps + 0.5, 14.0,
            {static_cast<std::uint8_t>(c.x), static_cast<std::uint8_t>(c.y), static_cast<std::uint8_t>(c.z), 1.0});
    }
    figure.text({left - 8.0, 17.0}, least, 12.0, {}, display::TextAnchor::end);
    figure.text({left + width + 8.0, 17.0}, most, 12.0);
    return figure;
}

}  // namespace tactus::report
