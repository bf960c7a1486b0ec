// SPDX-License-Identifier: Apache-2.0
#include "dsp/display/display_fit.hpp"

#include "dsp/coupling/placement.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <string>
#include <vector>

using namespace tactus;

namespace {

const Pose device{{0.03, -0.24, -0.18}, coupling::rotation_xyz({0.2, -0.1, 0.4})};
const display::Plane mirror{{0.0, 0.02, 0.01}, glm::normalize(Vec3(0.0, 0.35, 0.94))};
// A mirror swaps left and right.
const display::Screen image{{0.25, -0.1, -0.3}, {-0.25, -0.1, -0.3}, {0.25, 0.17, -0.22}};

Vec3 on_screen(const display::Screen& screen, double u, double v) {
    return screen.low_left + u * screen.right() + v * screen.up();
}

/// A whole display without noise: 8 places, 8 touches of the mirror, 9 marks as the mirror shows them.
std::vector<display::Touch> whole_display() {
    std::vector<display::Touch> touches;
    const auto add = [&](display::Touch touch, const Vec3& at) {
        touch.reading = device.inverse().apply(at);
        touches.push_back(touch);
    };
    for (int n = 0; n < 8; ++n) {
        const Vec3 at(n & 1 ? 0.1 : -0.1, n & 2 ? 0.1 : -0.1, n & 4 ? -0.05 : -0.25);
        add({display::Touch::Of::workspace, {}, {}, {}, at}, at);
    }
    const Vec3 along(1.0, 0.0, 0.0), across = glm::cross(mirror.normal, along);
    for (int n = 0; n < 8; ++n)
        add({display::Touch::Of::mirror, {}, {}, {}, {}},
            mirror.point + (0.04 * n - 0.15) * along + (n % 3 - 1) * 0.1 * across);
    for (int n = 0; n < 9; ++n) {
        const glm::dvec2 mark(0.1 + 0.4 * (n % 3), 0.1 + 0.4 * (n / 3));
        add({display::Touch::Of::image, "monitor", mark, {}, {}}, on_screen(image, mark.x, mark.y));
    }
    return touches;
}

}  // namespace

TEST_CASE("dsp: a display comes out of exact touches as it is, the screen where it really stands above its mirror") {
    const display::DisplayFit fit = display::fit_display(whole_display());
    CHECK(glm::length(fit.device.position - device.position) < 1e-9);
    REQUIRE(fit.mirror);
    CHECK(std::abs(fit.mirror->height(mirror.point)) < 1e-9);
    CHECK(std::abs(glm::dot(fit.mirror->normal, mirror.normal)) == Approx(1.0));
    REQUIRE(fit.screens.size() == 1);
    CHECK(glm::length(fit.screens[0].second.low_left - mirror.reflected(image.low_left)) < 1e-6);
    CHECK(glm::length(fit.screens[0].second.high_left - mirror.reflected(image.high_left)) < 1e-4);
    REQUIRE(fit.parts.size() == 3);
    CHECK(fit.parts[2].what == "screen 'monitor'");
    CHECK(fit.parts[2].off.size() == 9);
}

TEST_CASE("dsp: a touch that went wrong is named, with how far it is off the others, which agree") {
    for (const std::size_t wrong : {3u, 11u, 18u}) {
        std::vector<display::Touch> touches = whole_display();
        touches[wrong].reading += device.inverse().rotate(0.02 * mirror.normal);
        try {
            display::fit_display(touches);
            FAIL("the touch was taken");
        } catch (const display::BadTouch& bad) {
            CHECK(bad.touch == wrong);
            INFO(bad.message());
            CHECK(bad.message().find("touch " + std::to_string(wrong + 1) + ",") != std::string::npos);
            CHECK(bad.message().find("20.0 mm off") != std::string::npos);
            CHECK(bad.message().find("touch it again") != std::string::npos);
        }
    }
}

TEST_CASE("dsp: touches that decide nothing, or contradict each other altogether, are refused with what to do") {
    std::vector<display::Touch> touches = whole_display();
    CHECK_THROWS_WITH(display::fit_display(std::span(touches).first(3)),
                      Catch::Matchers::ContainsSubstring("touch 4 places at least"));
    CHECK_THROWS_WITH(display::fit_display(std::span(touches).subspan(16)),
                      Catch::Matchers::ContainsSubstring("touch the mirror as well"));
    auto mixed = touches;
    mixed[20].of = display::Touch::Of::screen;
    CHECK_THROWS_WITH(display::fit_display(mixed), Catch::Matchers::ContainsSubstring("not both"));
    auto swapped = touches;
    for (std::size_t i = 16; i < 25; ++i) swapped[i].shown.x = 1.0 - swapped[i].shown.x;
    CHECK_THROWS_WITH(display::fit_display(swapped), Catch::Matchers::ContainsSubstring("look away from the mirror"));
    auto shaken = touches;
    for (std::size_t i = 16; i < 25; ++i) shaken[i].reading.x += 0.02 * static_cast<double>((i * 7) % 5);
    CHECK_THROWS_WITH(display::fit_display(shaken), Catch::Matchers::ContainsSubstring("no single one is to blame"));
    auto line = touches;
    for (std::size_t i = 8; i < 16; ++i)
        line[i].reading = touches[8].reading + Vec3(0.01 * static_cast<double>(i), 0.0, 0.0);
    CHECK_THROWS_WITH(display::fit_display(line), Catch::Matchers::ContainsSubstring("on a line"));
    auto tiny = touches;
    for (std::size_t i = 17; i < 25; ++i)
        tiny[i].reading = touches[16].reading + 0.01 * (touches[i].reading - touches[16].reading);
    CHECK_THROWS_WITH(display::fit_display(tiny), Catch::Matchers::ContainsSubstring("no size of a screen"));
    auto lost = touches;
    lost[5].reading.y = std::nan("");
    CHECK_THROWS_WITH(display::fit_display(lost), Catch::Matchers::ContainsSubstring("touch 6"));
}

TEST_CASE("dsp: a device that is not true is taken as it is when its scales and skews may be fitted") {
    std::vector<display::Touch> touches = whole_display();
    const Mat3 untrue(Vec3(1.03, 0.0, 0.0), Vec3(0.01, 0.98, 0.0), Vec3(0.0, 0.02, 1.01));
    for (display::Touch& touch : touches) touch.reading = untrue * touch.reading;
    display::DisplayFitOptions options;
    options.is_affine = true;
    const display::DisplayFit fit = display::fit_display(touches, options);
    CHECK(fit.parts[0].residual.worst < 1e-9);
    const Vec3 at(0.05, 0.02, -0.1);
    const Vec3 reading = untrue * device.inverse().apply(at);
    CHECK(glm::length(fit.device.apply(fit.stretch * reading) - at) < 1e-9);
    CHECK_THROWS_WITH(display::fit_display(touches), Catch::Matchers::ContainsSubstring("device"));
}
