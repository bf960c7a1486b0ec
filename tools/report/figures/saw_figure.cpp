// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/saw_figure.hpp"

#include "dsp/saw/published.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tactus::report {

namespace {

constexpr display::Colour blue{0x1F, 0x4E, 0x9E}, red{0xB8, 0x1D, 0x24}, green{0x1B, 0x7A, 0x3D},
    grid{0xE3, 0xE6, 0xEA}, frame{0x55, 0x5B, 0x66}, ink{0x22, 0x26, 0x2E}, soft{0x6B, 0x72, 0x80};
constexpr double width = 260.0, height = 220.0, gap = 62.0, top = 56.0;

struct Panel {
    double x, low_x, high_x, high_y;

    display::FigurePoint at(double u, double v) const {
        return {x + width * (u - low_x) / (high_x - low_x), top + height * (1.0 - v / high_y)};
    }
};

void draw_axes(display::Figure& figure, const Panel& p, const std::string& title, const std::string& across,
               const std::string& up) {
    for (int i = 0; i <= 4; ++i) {
        const double v = p.high_y * i / 4.0, u = p.low_x + (p.high_x - p.low_x) * i / 4.0;
        const double y = p.at(p.low_x, v).y, x = p.at(u, 0.0).x;
        figure.line({{p.x, y}, {p.x + width, y}}, grid, 0.8);
        figure.text({p.x - 5.0, y + 3.5}, fmt::format("{:g}", v), 10.0, ink, display::TextAnchor::end);
        figure.line({{x, top}, {x, top + height}}, grid, 0.8);
        figure.text({x, top + height + 13.0}, fmt::format("{:g}", u), 10.0, ink, display::TextAnchor::middle);
    }
    figure.line({{p.x, top}, {p.x + width, top}, {p.x + width, top + height}, {p.x, top + height}, {p.x, top}}, frame,
                1.0);
    figure.text({p.x, top - 6.0}, title, 11.0, ink, display::TextAnchor::start, true);
    figure.text({p.x + width, top + height + 26.0}, across, 10.0, soft, display::TextAnchor::end);
    figure.text({p.x - 36.0, top + 0.5 * height}, up, 10.0, soft, display::TextAnchor::middle, false, true);
}

template <class Of>
void draw_law(display::Figure& figure, const Panel& p, display::Colour colour, double dash, double from, Of&& of) {
    std::vector<display::FigurePoint> points;
    for (int i = 0; i <= 120; ++i) {
        const double u = from + (p.high_x - from) * i / 120.0;
        points.push_back(p.at(u, std::min(of(u), p.high_y)));
    }
    figure.line(points, colour, 1.8, dash);
}

void draw_points(display::Figure& figure, const Panel& p, const std::vector<SawCurvePoint>& points,
                 display::Colour colour) {
    for (const SawCurvePoint& point : points) {
        const display::FigurePoint at = p.at(point.x, std::min(point.y, p.high_y));
        figure.rectangle(at.x - 3.0, at.y - 3.0, 6.0, 6.0, colour);
    }
}

}  // namespace

display::Figure draw_saw_law(const SawFigure& measured) {
    namespace j = saw::james_2013;
    namespace q = saw::pearlman_2012;
    const saw::CuttingLaw law;
    const auto resultant = [&](double um) { return std::hypot(law.thrust(um * 1e-6), law.cutting); };
    display::Figure figure(gap * 4.0 + width * 3.0, top + height + 84.0);
    figure.text({gap, 22.0}, "Forces of sawing: published and Tactus", 14.0, ink, display::TextAnchor::start, true);

    const Panel tooth{gap, 0.0, 12.0, 12.0};
    draw_axes(figure, tooth, "One tooth in cortical bone", "depth of cut, µm", "force, N");
    draw_law(figure, tooth, blue, 0.0, 0.0, [&](double um) { return law.thrust(um * 1e-6); });
    draw_law(figure, tooth, green, 0.0, 0.0, [&](double um) { return law.along(law.thrust(um * 1e-6)); });
    draw_law(figure, tooth, red, 0.0, 2.0, resultant);
    draw_points(figure, tooth, {{q::depth_low * 1e6, q::resultant_low}, {q::depth_high * 1e6, q::resultant_high}}, red);
    draw_points(figure, tooth,
                {{j::shallow * 1e6, j::ratio_shallow * law.cutting}, {j::deep * 1e6, j::ratio_deep * law.cutting}},
                blue);

    double most = 0.1, highest = 1.0;
    for (const SawCurvePoint& p : measured.feed) most = std::max(most, p.y);
    for (const SawCurvePoint& p : measured.thrust) highest = std::max(highest, p.y);
    const Panel feed{gap * 2.0 + width, 0.0, 32.0, std::ceil(most * 5.0) / 5.0};
    draw_axes(figure, feed, "Block 12 mm wide, 228 Hz: feed over thrust", "thrust, N", "feed, mm/s");
    draw_points(figure, feed, measured.feed, blue);

    const Panel rate{gap * 3.0 + 2.0 * width, 100.0, 300.0, std::ceil(highest / 10.0) * 10.0};
    draw_axes(figure, rate, "Thrust at 40 mm/min", "strokes per second, Hz", "thrust, N");
    draw_points(figure, rate, measured.thrust, blue);
    figure.line({rate.at(saw::yu_2023::rate, 0.0), rate.at(saw::yu_2023::rate, rate.high_y)}, red, 1.2, 4.0);

    figure.text({gap, top + height + 48.0},
                "Left: blue thrust, green cutting force, red resultant. Squares: Pearlman 2012 (red), ratios of James "
                "2013 times the cutting force (blue). Lines: the law. Below 2 µm nothing is measured.",
                10.0, soft);
    figure.text({gap, top + height + 64.0},
                "Middle and right: squares are the kernel on an analytic block; red dashed: where Yu 2023 found the "
                "least force.",
                10.0, soft);
    return figure;
}

}  // namespace tactus::report
