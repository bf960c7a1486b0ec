// SPDX-License-Identifier: Apache-2.0
// One drawing list in its formats: another renderer draws the SVG as Cairo draws the PNG.
#include "devices/display/read_png.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/pdf_text.hpp"
#include "tools/report/figures/figure_file.hpp"

#include <cmath>
#include <cstdlib>
#include <numbers>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

/// Every kind of item.
display::Figure all_items() {
    constexpr display::Colour red{200, 30, 30}, blue{30, 60, 180, 0.5}, ink{20, 20, 20};
    display::Figure figure(300.0, 200.0);
    figure.rounded(10.0, 10.0, 120.0, 60.0, 8.0, {230, 235, 240}, ink, 1.0);
    figure.curve({20.0, 60.0}, {80.0, 60.0}, {60.0, 150.0}, {140.0, 150.0}, red, 2.0, 6.0);
    figure.disc({140.0, 150.0}, 4.0, red);
    figure.cells(160.0, 20.0, 120.0, 60.0, 3, 2, {0, 1, 2, 2, 1, 0}, {red, {30, 200, 60}, {240, 220, 40}});
    display::Image image{2, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 90, 90, 90}};
    figure.clip(160.0, 100.0, 60.0, 60.0);
    figure.picture(150.0, 100.0, 80.0, 80.0, std::move(image));
    figure.unclip();
    std::vector<display::FigurePoint> wave;
    for (int n = 0; n < 2000; ++n) wave.push_back({10.0 + 0.14 * n, 175.0 + 15.0 * std::sin(0.05 * n)});
    figure.line(std::move(wave), blue, 1.5);
    figure.begin("words", "what is written");
    figure.text({70.0, 45.0}, "level, dB ± 2 µm", 12.0, ink, display::TextAnchor::middle, true);
    figure.text({290.0, 95.0}, "axis & more", 10.0, ink, display::TextAnchor::end);
    figure.text({150.0, 190.0}, "upwards", 11.0, ink, display::TextAnchor::start, false, true);
    figure.text({200.0, 140.0}, "over an image", 11.0, ink, display::TextAnchor::middle, false, false, true);
    figure.end();
    return figure;
}

}  // namespace

TEST_CASE("librsvg draws the SVG file of a figure as its PNG file shows it") {
    if (!test::has_program("rsvg-convert")) return;
    const test::Folder folder;
    const auto file = [&](const char* name) { return (folder.path / name).string(); };
    const display::Figure figure = all_items();
    CHECK(report::write_figure(figure, file("a.svg")).empty());
    CHECK(report::write_figure(figure, file("a.png")).empty());
    REQUIRE(std::system(("rsvg-convert -z 2 -o " + file("b.png") + " " + file("a.svg")).c_str()) == 0);
    const display::Image ours = display::read_png(file("a.png")), theirs = display::read_png(file("b.png"));
    REQUIRE(ours.width == theirs.width);
    REQUIRE(ours.height == theirs.height);
    double sum = 0.0;
    std::size_t far = 0;
    for (std::size_t i = 0; i < ours.rgb.size(); ++i) {
        const int difference = std::abs(ours.rgb[i] - theirs.rgb[i]);
        sum += difference;
        far += difference > 100;
    }
    CHECK(sum / static_cast<double>(ours.rgb.size()) < 4.0);
    CHECK(static_cast<double>(far) / static_cast<double>(ours.rgb.size()) < 0.01);
}

TEST_CASE("the option --dpi is the resolution of a PNG figure, and the text of a PDF figure can be read") {
    const test::Folder folder;
    const std::string png = (folder.path / "a.png").string(), pdf = (folder.path / "a.pdf").string();
    report::write_figure(all_items(), png, 300.0);
    CHECK(display::read_png(png).width == 938);  // 300 units of 1/96 inch
    report::write_figure(all_items(), pdf);
    CHECK_THROWS_WITH(report::write_figure(all_items(), folder.path / "a.gif"),
                      ContainsSubstring(".svg, .png or .pdf"));
    if (const auto text = test::pdf_text(folder, pdf))
        CHECK_THAT(*text, ContainsSubstring("level, dB ± 2 µm") && ContainsSubstring("axis & more"));
    // The date is fixed, so that equal figures are equal files on every day.
    if (!test::has_program("pdfinfo")) return;
    REQUIRE(std::system(("TZ=UTC pdfinfo " + pdf + " >" + pdf + ".txt").c_str()) == 0);
    CHECK_THAT(test::slurp(pdf + ".txt"), ContainsSubstring("Jan  1 00:00:00 2000"));
}
