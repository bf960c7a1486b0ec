// SPDX-License-Identifier: Apache-2.0
#include "devices/display/figure.hpp"
#include "devices/display/figure_painter.hpp"
#include "devices/display/png.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cstdlib>
#include <limits>
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

/// The same within what compositing rounds.
bool is_near(const display::Image& image, int x, int y, int r, int g, int b) {
    const std::uint8_t* p = image.pixel(x, y);
    return std::abs(p[0] - r) <= 1 && std::abs(p[1] - g) <= 1 && std::abs(p[2] - b) <= 1;
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
    CHECK(is_near(image, 12, 10, 128, 0, 128));
    CHECK(is_near(image, 17, 10, 128, 128, 255));
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

TEST_CASE("ids of an SVG file begin with the prefix, and groups carry their titles") {
    display::Figure figure(40.0, 20.0);
    figure.clip(0.0, 0.0, 20.0, 20.0);
    figure.rectangle(5.0, 5.0, 30.0, 10.0, red);
    figure.begin("wire 1", "a < b");
    figure.line({{0.0, 0.0}, {40.0, 20.0}}, blue, 1.0);
    figure.end();
    const std::string svg = figure.svg("p3-");
    CHECK(svg.find("<clipPath id=\"p3-c0\">") != std::string::npos);
    CHECK(svg.find("clip-path=\"url(#p3-c0)\"") != std::string::npos);
    CHECK(svg.find("<g id=\"p3-wire-1\"><title>a &lt; b</title>") != std::string::npos);
    // A group that begins within a clip ends it, so that the elements nest.
    CHECK(svg.find("</g>\n<g id=") != std::string::npos);
}

TEST_CASE("points that are not finite break a line, and appear in no output") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    display::Figure figure(100.0, 20.0);
    figure.line({{10.0, 10.0}, {30.0, 10.0}, {nan, 5.0}, {70.0, 10.0}, {90.0, 10.0}, {95.0, inf}}, blue, 4.0);
    figure.fill({{0.0, 0.0}, {nan, 1.0}, {1.0, 1.0}}, red);
    figure.text({inf, 1.0}, "nowhere", 10.0);
    REQUIRE(figure.items().size() == 2);
    CHECK(figure.svg().find("nan") == std::string::npos);
    const display::Image image = figure.image(1.0);
    CHECK(is(image, 20, 10, 0, 0, 255));
    CHECK(is(image, 50, 10, 255, 255, 255));
    CHECK(is(image, 80, 10, 0, 0, 255));
}

TEST_CASE("a placed figure is the figure, moved and scaled") {
    display::Figure inner(20.0, 10.0);
    inner.clip(0.0, 0.0, 10.0, 10.0);
    inner.rectangle(0.0, 0.0, 20.0, 10.0, red);
    display::Figure outer(60.0, 40.0);
    outer.place(inner, 20.0, 10.0, 2.0);
    const display::Image image = outer.image(1.0);
    CHECK(is(image, 20, 10, 255, 0, 0));
    CHECK(is(image, 39, 29, 255, 0, 0));
    CHECK(is(image, 40, 10, 255, 255, 255));
    CHECK(inked(image) == 400);
}

TEST_CASE("text of any bytes becomes valid text") {
    display::Figure figure(40.0, 20.0);
    figure.text({0.0, 10.0}, "a\x01\tb \xB5m", 10.0);
    const auto& text = std::get<display::Figure::Text>(figure.items().at(0));
    CHECK(text.text == "a  b µm");
    CHECK_NOTHROW(figure.image(1.0));
}

TEST_CASE("letters are as wide as those of DejaVu Sans, at every size") {
    // Advances of the font, in 2048ths of the em: H 1540, i 569; bold H 1714.
    const display::FigurePainter& painter = display::figure_painter();
    CHECK(painter.text_width("H", 20.48, false) == Approx(15.40).margin(0.02));
    CHECK(painter.text_width("i", 2048.0, false) == Approx(569.0).margin(1.0));
    CHECK(painter.text_width("H", 2048.0, true) == Approx(1714.0).margin(1.0));
    double width = 0.0;
    double low = 0.0;
    for (const auto& outline : painter.outlines("H", 2048.0, false, width))
        for (const display::FigurePoint& p : outline) low = std::min(low, p.y);
    CHECK(width == Approx(1540.0).margin(1.0));
    CHECK(low == Approx(-1493.0).margin(2.0));  // capital height
}

TEST_CASE("characters that no font has are named in a warning") {
    display::Figure figure(40.0, 20.0);
    figure.text({0.0, 10.0}, "plain µ ≤", 10.0);
    CHECK(display::missing_glyphs({&figure, 1}).empty());
    figure.text({0.0, 10.0}, "\xF4\x80\x80\x81", 10.0);  // of the private use area
    const std::string warning = display::missing_glyphs({&figure, 1});
    CHECK(warning.find("U+100001") != std::string::npos);
}

TEST_CASE("a PDF file of a figure has its size and its fonts, and the same bytes twice") {
    display::Figure figure(400.0, 200.0);
    figure.text({10.0, 100.0}, "level, dB", 12.0);
    figure.cells(10.0, 5.0, 20.0, 10.0, 2, 2, {0, 1, 1, 0}, {red, blue});
    const std::string pdf = display::pdf_of(figure, "a title");
    CHECK(pdf.starts_with("%PDF-1."));
    CHECK(pdf.find("0 0 300 150") != std::string::npos);
    CHECK(pdf.find("/FontFile2") != std::string::npos);
    CHECK(pdf.find("DejaVuSans") != std::string::npos);
    CHECK(display::pdf_of(figure, "a title") == pdf);
}

TEST_CASE("a PNG file states its resolution") {
    const display::Image image{1, 1, {0, 0, 0}};
    const std::string png = display::png_bytes(image, 254.0);
    const std::size_t at = png.find("pHYs");
    REQUIRE(at == 37);
    CHECK(png.substr(at + 4, 9) == std::string("\0\0\x27\x10\0\0\x27\x10\1", 9));  // 10 000 per metre
    CHECK(png.ends_with("IEND\xAE\x42\x60\x82"));
    CHECK(display::png_bytes(image).find("pHYs") == std::string::npos);
}
