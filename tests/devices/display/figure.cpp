// SPDX-License-Identifier: Apache-2.0
#include "devices/display/figure.hpp"
#include "devices/display/png.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;

namespace {

constexpr display::Colour red{255, 0, 0}, blue{0, 0, 255};

bool is(const display::Image& image, int x, int y, int r, int g, int b) {
    const std::uint8_t* p = image.pixel(x, y);
    return p[0] == r && p[1] == g && p[2] == b;
}

/// Pixels that are not white.
int inked(const display::Image& image) {
    int count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
        count += image.rgb[i] != 255 || image.rgb[i + 1] != 255 || image.rgb[i + 2] != 255;
    return count;
}

}  // namespace

TEST_CASE("shapes land on the pixels they cover, later ones over earlier ones, half-transparent ones between") {
    display::Figure figure(40.0, 20.0);
    figure.rectangle(5.0, 5.0, 10.0, 10.0, red);
    figure.rectangle(10.0, 5.0, 10.0, 10.0, {0, 0, 255, 0.5});
    const display::Image image = figure.image(1.0);
    REQUIRE(image.width == 40);
    REQUIRE(image.height == 20);
    CHECK(is(image, 4, 10, 255, 255, 255));
    CHECK(is(image, 5, 5, 255, 0, 0));
    CHECK(is(image, 12, 10, 128, 0, 128));
    CHECK(is(image, 17, 10, 128, 128, 255));
    CHECK(is(image, 20, 10, 255, 255, 255));
    CHECK(inked(image) == 150);
}

TEST_CASE("a line is as wide as asked, dashes leave half of it, a clip cuts it") {
    const auto drawn = [](double dash, bool clipped) {
        display::Figure figure(100.0, 20.0);
        if (clipped) figure.clip(0.0, 0.0, 50.0, 20.0);
        figure.line({{10.0, 10.0}, {90.0, 10.0}}, blue, 4.0, dash);
        figure.unclip();
        return figure.image(1.0);
    };
    const display::Image solid = drawn(0.0, false);
    CHECK(is(solid, 50, 8, 0, 0, 255));
    CHECK(is(solid, 50, 11, 0, 0, 255));
    CHECK(is(solid, 50, 7, 255, 255, 255));
    CHECK(inked(drawn(0.0, true)) < 0.6 * inked(solid));
    CHECK(inked(drawn(10.0, false)) < 0.75 * inked(solid));
}

TEST_CASE("text leaves ink where it stands, and as much of it turned as upright") {
    const auto written = [](display::TextAnchor anchor, bool turned) {
        display::Figure figure(200.0, 200.0);
        figure.text({100.0, 100.0}, "Spectrum ≤ 1", 12.0, {}, anchor, false, turned);
        return figure.image(2.0);
    };
    const display::Image start = written(display::TextAnchor::start, false),
                         end = written(display::TextAnchor::end, false);
    const auto left_ink = [](const display::Image& image) {
        int count = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width / 2; ++x) count += !is(image, x, y, 255, 255, 255);
        return count;
    };
    CHECK(inked(start) > 200);
    CHECK(left_ink(start) < inked(start) / 20);
    CHECK(left_ink(end) > inked(end) * 19 / 20);
    CHECK(inked(written(display::TextAnchor::start, true)) == Approx(inked(start)).epsilon(0.1));
}

TEST_CASE("an SVG file holds what was drawn, its text safe for XML") {
    display::Figure figure(40.0, 20.0);
    figure.rectangle(5.0, 5.0, 10.0, 10.0, red);
    figure.text({1.0, 2.0}, "a < b & c", 12.0);
    const std::string svg = figure.svg();
    CHECK(svg.find("#ff0000") != std::string::npos);
    CHECK(svg.find("a &lt; b &amp; c") != std::string::npos);
    CHECK(svg.ends_with("</svg>\n"));
}

TEST_CASE("a picture of no pixels or too many is refused") {
    CHECK_THROWS_AS(display::Figure(0.0, 10.0).image(), Error);
    CHECK_THROWS_AS(display::Figure(20000.0, 10.0).image(), Error);
}

TEST_CASE("cells of a raster are where they belong, in pixels and as a PNG picture with a palette") {
    display::Figure figure(40.0, 20.0);
    // Red, blue / blue, red, over 20 × 10 units.
    figure.cells(10.0, 5.0, 20.0, 10.0, 2, 2, {0, 1, 1, 0}, {red, blue});
    const display::Image image = figure.image(1.0);
    CHECK(is(image, 10, 5, 255, 0, 0));
    CHECK(is(image, 29, 5, 0, 0, 255));
    CHECK(is(image, 10, 14, 0, 0, 255));
    CHECK(is(image, 29, 14, 255, 0, 0));
    CHECK(inked(image) == 200);
    const std::string png =
        display::palette_png_bytes(2, 2, std::array<std::uint8_t, 4>{0, 1, 1, 0}, std::array{red, blue});
    CHECK(png.starts_with("\x89PNG\r\n\x1a\n"));
    CHECK(png.find("PLTE\xff") != std::string::npos);
    CHECK(figure.svg().find("href=\"data:image/png;base64," + display::base64(png) + "\"") != std::string::npos);
    CHECK(display::base64("Man") == "TWFu");
    CHECK(display::base64("Ma") == "TWE=");
}

TEST_CASE("a curve with many more points than pixels keeps its highest and lowest in a small file") {
    const auto drawn = [](std::size_t points) {
        std::vector<display::FigurePoint> curve;
        for (std::size_t i = 0; i < points; ++i)
            curve.push_back({200.0 * static_cast<double>(i) / static_cast<double>(points),
                             i == points / 2 ? 3.0 : 50.0 + static_cast<double>(i % 7)});
        display::Figure figure(200.0, 100.0);
        figure.line(std::move(curve), blue, 1.0);
        return figure.svg();
    };
    const std::string many = drawn(100'000);
    CHECK(many.size() < 20'000);
    CHECK(drawn(200).size() < 6'000);
    // Down to the peak and up again, of which the points between 50 and 56 leave at least 44.
    long steps = 0;
    for (std::size_t at = many.find('l'); (at = many.find(" -", at + 1)) != std::string::npos;)
        steps += std::strtod(many.c_str() + at + 1, nullptr) < -44.0;
    CHECK(steps == 1);
}
