// SPDX-License-Identifier: Apache-2.0
#include "devices/display/figure.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <string>

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
