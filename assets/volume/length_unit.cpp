// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/length_unit.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

namespace tactus::volume {

double metres_in(std::string_view unit) {
    if (unit == "mm") return 1e-3;
    if (unit == "cm") return 1e-2;
    if (unit == "m") return 1.0;
    throw Error(fmt::format("unit '{}' is not mm, cm or m", unit));
}

std::string unit_question(std::string_view what, double extent, const PlausibleSize& size) {
    const auto is_plausible = [&](double width) { return width >= size.least && width <= size.most; };
    if (is_plausible(extent)) return {};
    std::string likely;
    for (const std::string_view unit : {"cm", "m"})
        if (const double width = extent * metres_in(unit) * 1e3; is_plausible(width))
            likely += fmt::format("{}--unit {} makes it {:.4g} mm", likely.empty() ? "" : ", ", unit, width);
    return fmt::format(
        "{} states no unit and is {:.4g} units across, which is not plausible for a bone in mm; give its unit with "
        "--unit mm, cm or m{}",
        what, extent, likely.empty() ? "" : " (" + likely + ")");
}

}  // namespace tactus::volume
