// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/axes.hpp"

#include "dsp/core/readable.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

constexpr display::Colour grid{0xE3, 0xE6, 0xEA}, frame{0x55, 0x5B, 0x66}, ink = axis_ink, soft = axis_soft;

}  // namespace

double Scale::share(double v) const {
    const double s = is_log ? std::log(std::max(v, low * 0.5) / low) / std::log(high / low) : (v - low) / (high - low);
    return std::clamp(s, -0.05, 1.05);
}

std::vector<double> Scale::ticks() const {
    std::vector<double> all;
    if (std::isinf(step)) return all;
    if (is_log) {
        for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high * 1.001; decade *= 10.0)
            for (const double f : {1.0, 2.0, 5.0})
                if (decade * f >= low * 0.999 && decade * f <= high * 1.001) all.push_back(decade * f);
        return all;
    }
    const double raw = (high - low) / 5.0, power = std::pow(10.0, std::floor(std::log10(raw)));
    const double round = raw / power > 5.0   ? 10.0 * power
                         : raw / power > 2.0 ? 5.0 * power
                         : raw / power > 1.0 ? 2.0 * power
                                             : power;
    const double apart = step > 0.0 ? step : round;
    for (double v = std::ceil(low / apart - 1e-9) * apart; v <= high + 1e-9 * apart; v += apart)
        all.push_back(std::abs(v) < 1e-9 * apart ? 0.0 : v);
    return all;
}

display::FigurePoint Axes::at(double a, double b) const {
    return {x + width * across.share(a), y + height * (1.0 - up.share(b))};
}

void Axes::draw(const std::string& title, const std::string& unit_across, const std::string& unit_up) const {
    const double text = style.text;
    double taken = -1e9;  // right end of the last number
    for (const double v : across.ticks()) {
        const double at_x = at(v, up.low).x;
        figure.line({{at_x, y}, {at_x, y + height}}, grid, 0.8);
        const std::string number = axis_number(v);
        const double half = 0.3 * text * static_cast<double>(number.size());
        if (at_x - half < taken) continue;
        figure.text({at_x, y + height + 1.3 * text}, number, text, ink, display::TextAnchor::middle);
        taken = at_x + half + 0.4 * text;
    }
    for (const double v : up.ticks()) {
        figure.line({{x, at(across.low, v).y}, {x + width, at(across.low, v).y}}, grid, 0.8);
        figure.text({x - 0.5 * text, at(across.low, v).y + 0.35 * text}, axis_number(v), text, ink,
                    display::TextAnchor::end);
    }
    figure.line({{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}, {x, y}}, frame, 1.0);
    figure.text({x, y - 0.6 * text}, title, style.title, ink, display::TextAnchor::start, true);
    figure.text({x + width, y + height + 2.6 * text}, unit_across, text, soft, display::TextAnchor::end);
    figure.text({x - 3.6 * text, y + 0.5 * height}, unit_up, text, soft, display::TextAnchor::middle, false, true);
}

void Axes::curve(const std::vector<display::FigurePoint>& values, display::Colour colour, double dash,
                 bool dots) const {
    std::vector<display::FigurePoint> points;
    for (const display::FigurePoint& v : values) points.push_back(at(v.x, v.y));
    figure.clip(x - 3.0, y - 3.0, width + 6.0, height + 6.0);
    if (points.size() > 1) figure.line(points, colour, 1.5, dash);
    if (dots)
        for (const display::FigurePoint& p : points) figure.rectangle(p.x - 2.0, p.y - 2.0, 4.0, 4.0, colour);
    figure.unclip();
}

void Axes::level(double value, display::Colour colour, const std::string& word, bool below) const {
    curve({{across.low, value}, {across.high, value}}, colour, 4.0, false);
    if (word.empty()) return;
    const double line = at(across.low, value).y;
    if (below)
        figure.text({x + 4.0, line + 1.1 * style.text}, word, style.text, colour, display::TextAnchor::start, false,
                    false, true);
    else
        figure.text({x + width - 4.0, line - 3.0}, word, style.text, colour, display::TextAnchor::end, false, false,
                    true);
}

}  // namespace tactus::report
