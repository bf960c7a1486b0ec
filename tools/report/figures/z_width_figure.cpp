// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/z_width_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace tactus::report {

namespace {

constexpr std::array<display::Colour, 4> colours{
    {{0x1F, 0x4E, 0x9E}, {0xB8, 0x1D, 0x24}, {0x1B, 0x7A, 0x3D}, {0x8A, 0x5A, 0x00}}};
constexpr display::Colour grid{0xE3, 0xE6, 0xEA}, frame{0x55, 0x5B, 0x66}, ink{0x22, 0x26, 0x2E},
    soft{0x6B, 0x72, 0x80};
constexpr double width = 250.0, height = 220.0, gap = 70.0, top = 50.0, least = 0.01;

/// Axes of one device: damping linear, stiffness in N/mm logarithmic.
struct Panel {
    double x, y, max_damping, max_stiffness;

    display::FigurePoint at(double damping, double stiffness) const {
        const double n_mm = std::max(stiffness * 1e-3, least);
        const double up = std::min(1.0, std::log(n_mm / least) / std::log(max_stiffness / least));
        return {x + width * damping / max_damping, y + height * (1.0 - up)};
    }
};

void draw_axes(display::Figure& figure, const Panel& panel, const std::string& title) {
    for (double v = least; v <= panel.max_stiffness * 1.001; v *= 10.0) {
        const double at = panel.at(0.0, v * 1e3).y;
        figure.line({{panel.x, at}, {panel.x + width, at}}, grid, 0.8);
        figure.text({panel.x - 5.0, at + 3.5}, fmt::format("{:g}", v), 10.0, ink, display::TextAnchor::end);
    }
    for (int i = 0; i <= 4; ++i) {
        const double v = panel.max_damping * i / 4.0, at = panel.at(v, 1.0).x;
        figure.line({{at, panel.y}, {at, panel.y + height}}, grid, 0.8);
        figure.text({at, panel.y + height + 13.0}, fmt::format("{:g}", v), 10.0, ink, display::TextAnchor::middle);
    }
    figure.line({{panel.x, panel.y},
                 {panel.x + width, panel.y},
                 {panel.x + width, panel.y + height},
                 {panel.x, panel.y + height},
                 {panel.x, panel.y}},
                frame, 1.0);
    figure.text({panel.x, panel.y - 6.0}, title, 11.0, ink, display::TextAnchor::start, true);
    figure.text({panel.x + width, panel.y + height + 26.0}, "damping of the wall, N s/m", 10.0, soft,
                display::TextAnchor::end);
    figure.text({panel.x - 38.0, panel.y + 0.5 * height}, "stiffness, N/mm", 10.0, soft, display::TextAnchor::middle,
                false, true);
}

void draw_curve(display::Figure& figure, const Panel& panel, const analysis::ZWidthCurve& curve, display::Colour colour,
                double dash) {
    std::vector<display::FigurePoint> bound, simulated;
    for (const analysis::ZWidthPoint& point : curve.points) {
        bound.push_back(panel.at(point.damping, point.bound));
        simulated.push_back(panel.at(point.damping, point.simulated.stiffness));
        const display::FigurePoint at = panel.at(point.damping, point.passive);
        figure.rectangle(at.x - 2.0, at.y - 2.0, 4.0, 4.0, colour);
    }
    if (bound.size() < 2) return;
    figure.line(bound, colour, 1.2, dash);
    figure.line(simulated, colour, 2.6, dash);
}

}  // namespace

display::Figure draw_z_width(const std::vector<analysis::ZWidthCurve>& curves) {
    std::vector<std::string> devices;
    std::vector<double> rates;
    double max_damping = 1e-3, max_stiffness = 0.1;
    for (const analysis::ZWidthCurve& curve : curves) {
        if (std::ranges::find(devices, curve.device) == devices.end()) devices.push_back(curve.device);
        if (std::ranges::find(rates, curve.rate) == rates.end()) rates.push_back(curve.rate);
        for (const analysis::ZWidthPoint& point : curve.points) {
            max_damping = std::max(max_damping, point.damping);
            max_stiffness = std::max({max_stiffness, point.bound * 1e-3, point.simulated.stiffness * 1e-3});
        }
    }
    max_stiffness = std::pow(10.0, std::ceil(std::log10(max_stiffness)));
    const auto columns = static_cast<double>(std::max<std::size_t>(devices.size(), 1));
    display::Figure figure(gap * (columns + 1.0) + width * columns, top + height + 90.0);
    figure.text({gap, 22.0}, "Which walls a device bears", 14.0, ink, display::TextAnchor::start, true);
    for (std::size_t d = 0; d < devices.size(); ++d) {
        const Panel panel{gap + (gap + width) * static_cast<double>(d), top, max_damping, max_stiffness};
        draw_axes(figure, panel, devices[d]);
        for (const analysis::ZWidthCurve& curve : curves) {
            if (curve.device != devices[d]) continue;
            const bool is_late = std::ranges::any_of(curves, [&](const analysis::ZWidthCurve& other) {
                return other.device == curve.device && other.rate == curve.rate && other.delay < curve.delay;
            });
            const auto rate = static_cast<std::size_t>(std::ranges::find(rates, curve.rate) - rates.begin());
            draw_curve(figure, panel, curve, colours[rate % colours.size()], is_late ? 4.0 : 0.0);
            const double friction = curve.points.empty() ? 0.0 : curve.points.front().friction;
            if (std::isfinite(friction) && friction > 0.0)
                figure.line({panel.at(0.0, friction), panel.at(max_damping, friction)}, frame, 1.0, 1.5);
        }
    }
    double x = gap;
    for (std::size_t i = 0; i < rates.size(); ++i, x += 70.0)
        figure.text({x, top + height + 52.0}, fmt::format("{:g} Hz", rates[i]), 10.0, colours[i % colours.size()],
                    display::TextAnchor::start, true);
    figure.text({gap, top + height + 70.0},
                "thin: bound of Colgate and Schenkel; squares: passivity border by motion; thick: the simulated device "
                "begins to oscillate at the worst press; dashed: a period of delay more; dotted: friction takes what "
                "encoder steps give",
                10.0, soft);
    return figure;
}

}  // namespace tactus::report
