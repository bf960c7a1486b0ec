// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/z_width_figure.hpp"

#include "tools/report/figures/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tactus::report {

namespace {

constexpr display::Colour frame = axis_soft;
constexpr double least = 0.01;  // N/mm

/// Panels of one device each, and the words below them.
FigureStyle layout_of(const FigureStyle& style, std::size_t devices) {
    FigureStyle made = style;
    // On a screen the panels stand side by side.
    if (style.width == screen_style.width) made.width = 60.0 + 320.0 * static_cast<double>(devices);
    return made;
}

display::FigurePoint place(const Axes& axes, double damping, double stiffness) {
    return axes.at(damping, std::max(stiffness * 1e-3, least));
}

void draw_curve(display::Figure& figure, const Axes& axes, const analysis::ZWidthCurve& curve, display::Colour colour,
                double dash) {
    std::vector<display::FigurePoint> bound, simulated;
    for (const analysis::ZWidthPoint& point : curve.points) {
        bound.push_back(place(axes, point.damping, point.bound));
        simulated.push_back(place(axes, point.damping, point.simulated.stiffness));
        const display::FigurePoint at = place(axes, point.damping, point.passive);
        figure.rectangle(at.x - 2.0, at.y - 2.0, 4.0, 4.0, colour);
    }
    if (bound.size() < 2) return;
    figure.line(bound, colour, 1.2, dash);
    figure.line(simulated, colour, 2.6, dash);
}

}  // namespace

display::Figure draw_z_width(const std::vector<analysis::ZWidthCurve>& curves, const FigureStyle& given) {
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
    const std::size_t count = std::max<std::size_t>(devices.size(), 1);
    const FigureStyle style = layout_of(given, count);
    const bool is_row = given.width == screen_style.width;
    const double top = style.gap(62.0), height = style.height(220.0), each = height + style.gap(62.0);
    const double left = is_row ? 70.0 : style.left, width = is_row ? 250.0 : style.panel_width();
    const double below = top + each * static_cast<double>(is_row ? 1 : count) - style.gap(10.0);
    const std::vector<std::string> words{"thin: bound of Colgate and Schenkel", "squares: passivity border by motion",
                                         "thick: the simulated device begins to oscillate at the worst press",
                                         "dashed: a period of delay more",
                                         "dotted: friction takes what encoder steps give"};
    display::Figure figure(style.width, below + style.gap(14.0) * static_cast<double>(words.size() + 2));
    figure.text({left, style.gap(22.0)}, "Which walls a device bears", style.heading, axis_ink,
                display::TextAnchor::start, true);
    for (std::size_t d = 0; d < devices.size(); ++d) {
        const double place_of_panel = static_cast<double>(d);
        const Axes axes{figure,
                        left + (is_row ? 320.0 * place_of_panel : 0.0),
                        top + (is_row ? 0.0 : each * place_of_panel),
                        width,
                        height,
                        {0.0, max_damping, false},
                        {least, max_stiffness, true},
                        style};
        axes.draw(devices[d], "damping of the wall, N s/m", "stiffness, N/mm");
        for (const analysis::ZWidthCurve& curve : curves) {
            if (curve.device != devices[d]) continue;
            const bool is_late = std::ranges::any_of(curves, [&](const analysis::ZWidthCurve& other) {
                return other.device == curve.device && other.rate == curve.rate && other.delay < curve.delay;
            });
            const auto rate = static_cast<std::size_t>(std::ranges::find(rates, curve.rate) - rates.begin());
            draw_curve(figure, axes, curve, curve_colours[rate % curve_colours.size()], is_late ? 4.0 : 0.0);
            const double friction = curve.points.empty() ? 0.0 : curve.points.front().friction;
            if (std::isfinite(friction) && friction > 0.0)
                figure.line({place(axes, 0.0, friction), place(axes, max_damping, friction)}, frame, 1.0, 1.5);
        }
    }
    double x = left, y = below + style.gap(14.0);
    for (std::size_t i = 0; i < rates.size(); ++i, x += style.gap(70.0))
        figure.text({x, y}, fmt::format("{:g} Hz", rates[i]), style.text, curve_colours[i % curve_colours.size()],
                    display::TextAnchor::start, true);
    for (const std::string& line : words) figure.text({left, y += style.gap(14.0)}, line, style.text, axis_soft);
    return figure;
}

}  // namespace tactus::report
