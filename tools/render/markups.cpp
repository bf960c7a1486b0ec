// SPDX-License-Identifier: Apache-2.0
#include "tools/render/markups.hpp"

#include "assets/markup/markup.hpp"
#include "dsp/display/ruler.hpp"

#include <fmt/format.h>

#include <numbers>

namespace tactus::render {

std::string measurement_words(const Measurement& measured) {
    const std::span points(measured.points);
    if (points.size() < 2) return {};
    std::string text = fmt::format("{:.2f} mm", 1e3 * display::path_length(points.first(2)));
    if (points.size() < 3) return text;
    text += fmt::format(", {:.2f} mm", 1e3 * display::path_length(points.subspan(1, 2)));
    if (const auto angle = display::angle_at(points[1], points[0], points[2]))
        text += fmt::format(", {:.1f}°", *angle * 180.0 / std::numbers::pi);
    return text;
}

std::string markups_text(std::span<const Measurement> all) {
    std::vector<markup::Markup> markups;
    for (const Measurement& one : all) {
        if (one.points.size() != 2 && one.points.size() != 3) continue;
        markup::Markup made;
        made.kind = one.points.size() == 2 ? markup::Kind::line : markup::Kind::angle;
        made.name = one.name;
        made.has_fixed_count = true;
        for (const Vec3& p : one.points)
            made.points.push_back({fmt::format("{}-{}", one.name, made.points.size() + 1), p, measurement_words(one)});
        markups.push_back(std::move(made));
    }
    return markup::text_of(markups);
}

}  // namespace tactus::render
