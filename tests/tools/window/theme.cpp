// SPDX-License-Identifier: Apache-2.0
// Colours that mean something are told apart by everybody.
#include "tools/window/widgets/theme.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

using namespace tactus;
using namespace tactus::window;
using glm::dmat3;
using glm::dvec3;

namespace {

dvec3 linear(std::uint32_t packed) {
    const auto part = [&](int shift) {
        const double x = (packed >> shift & 0xFF) / 255.0;
        return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    };
    return {part(0), part(8), part(16)};
}

/// CIE L*a*b* of linear sRGB, white of D65.
dvec3 lab(const dvec3& rgb) {
    const dvec3 xyz{(0.4124 * rgb.x + 0.3576 * rgb.y + 0.1805 * rgb.z) / 0.9505,
                    0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z,
                    (0.0193 * rgb.x + 0.1192 * rgb.y + 0.9505 * rgb.z) / 1.0891};
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
    return {116.0 * f(xyz.y) - 16.0, 500.0 * (f(xyz.x) - f(xyz.y)), 200.0 * (f(xyz.y) - f(xyz.z))};
}

/// Rows: L, M, S of linear sRGB (Viénot, Brettel, Mollon: Digital video colourmaps for checking the legibility of displays by
/// dichromats, 1999). glm's constructor takes columns.
const dmat3 to_cones =
    glm::transpose(dmat3(17.8824, 43.5161, 4.11935, 3.45565, 27.1554, 3.86714, 0.0299566, 0.184309, 1.46709));

enum class Sight { usual, deuteranopia, protanopia };

dvec3 seen(std::uint32_t packed, Sight sight) {
    dvec3 cones = to_cones * linear(packed);
    if (sight == Sight::deuteranopia) cones.y = 0.494207 * cones.x + 1.24827 * cones.z;
    if (sight == Sight::protanopia) cones.x = 2.02344 * cones.y - 2.52581 * cones.z;
    return lab(glm::clamp(glm::inverse(to_cones) * cones, 0.0, 1.0));
}

void check_apart(const std::vector<std::uint32_t>& colours, double least) {
    for (const Sight sight : {Sight::usual, Sight::deuteranopia, Sight::protanopia})
        for (std::size_t a = 0; a < colours.size(); ++a)
            for (std::size_t b = 0; b < a; ++b) {
                INFO(fmt::format("sight {}, colours {} and {}", static_cast<int>(sight), b, a));
                CHECK(glm::distance(seen(colours[a], sight), seen(colours[b], sight)) > least);
            }
}

}  // namespace

TEST_CASE("colours of curves, of wires and of states are told apart without red or green cones") {
    // 2.3 is just noticeable beside each other; thin lines apart need much more.
    constexpr double least = 20.0;
    check_apart({std::begin(tone::curves), std::end(tone::curves)}, least);
    std::vector<std::uint32_t> wires;
    for (const ValueType* type : {&value::pose, &value::wrench, &value::twist, &value::vector, &value::number,
                                  &value::boolean, &value::signal, &value::event})
        wires.push_back(colour_of(type));
    check_apart(wires, least);
    check_apart({tone::bad, tone::good, tone::warm, tone::text, tone::dim}, least);
}

TEST_CASE("curves and wires have a contrast to the ground that letters need") {
    const auto luminance = [](std::uint32_t packed) {
        return glm::dot(linear(packed), dvec3(0.2126, 0.7152, 0.0722)) + 0.05;
    };
    for (const std::uint32_t ink : tone::curves) CHECK(luminance(ink) / luminance(tone::ground) > 4.4);
    for (const ValueType* type : {&value::pose, &value::wrench, &value::number})
        CHECK(luminance(colour_of(type)) / luminance(tone::ground) > 4.4);
}
