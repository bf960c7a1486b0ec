// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/spectrum_panel.hpp"

#include "tools/report/figures/axes.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

constexpr display::Colour limit_colour{0x8A, 0x8F, 0x99};

struct LevelRange {
    double low, high;  // dB
};

/// Whole tens around the levels of all curves between two frequencies, with room for names above them; `least` to `most`
/// deep.
LevelRange range_of(std::span<const SpectrumCurve> curves, double lowest, double highest, double least, double most) {
    double low = 400.0, top = -400.0;
    for (const SpectrumCurve& curve : curves)
        for (std::size_t k = 1; k < curve.spectrum->power.size(); ++k)
            if (const double f = curve.spectrum->frequency(k); f >= lowest && f <= highest) {
                const double level = curve.reference.db(curve.spectrum->power[k]);
                low = std::min(low, level);
                top = std::max(top, level);
            }
    top = 10.0 * std::ceil(top / 10.0) + 10.0;
    return {top - std::clamp(top - 10.0 * std::floor(low / 10.0), least, most), top};
}

}  // namespace

double level_at(const SpectrumCurve& curve, double hz) {
    const std::vector<double>& power = curve.spectrum->power;
    const auto k = static_cast<std::size_t>(
        std::clamp(std::round(hz / curve.spectrum->df), 1.0, static_cast<double>(power.size() - 2)));
    return curve.reference.db(std::max({power[k - 1], power[k], power[k + 1]}));
}

DrawnSpectra draw_spectra(display::Figure& figure, const MarkedArea& area, std::span<const SpectrumCurve> curves,
                          const std::string& unit, std::span<const analysis::MarkPlace> marks) {
    const LevelRange levels_shown = range_of(curves, area.lowest, area.highest, 40.0, 80.0);
    const PlotPanel panel(figure, area.x, area.y, area.width, area.height, {area.lowest, area.highest},
                          {levels_shown.low, levels_shown.high});
    panel.axes(10.0, unit, true);
    if (area.highest > 500.0 && area.lowest < 500.0) {
        panel.upright(500.0, limit_colour, 4.0);
        figure.text({panel.x_of(500.0) + 4.0, area.y + area.height - 6.0}, "limit of touch", 10.0, axis_soft);
    }
    for (const SpectrumCurve& curve : curves) {
        std::vector<double> levels;
        for (const double power : curve.spectrum->power) levels.push_back(curve.reference.db(power));
        panel.curve(levels, curve.spectrum->df, curve.colour, curve.width, curve.dash);
    }
    draw_marks(figure, area, marks, [&](double hz) { return panel.x_of(hz); });
    return {panel, levels_shown.low, levels_shown.high};
}

void draw_envelopes(display::Figure& figure, const MarkedArea& area, std::span<const SpectrumCurve> curves,
                    const std::string& title, const std::string& unit, std::span<const analysis::MarkPlace> marks) {
    double step = area.highest;
    for (const SpectrumCurve& curve : curves) step = std::min(step, curve.spectrum->df);
    const LevelRange shown = range_of(curves, 2.0 * step, area.highest, 30.0, 60.0);
    const Axes axes{figure,
                    area.x,
                    area.y,
                    area.width,
                    area.height,
                    {area.lowest, area.highest, false},
                    {shown.low, shown.high, false}};
    axes.draw(title, "frequency of the envelope, Hz", unit);
    for (const SpectrumCurve& curve : curves) {
        std::vector<display::FigurePoint> points;
        // The first two bins hold what is left of the mean.
        for (std::size_t k = 2; k < curve.spectrum->power.size(); ++k)
            if (const double f = curve.spectrum->frequency(k); f <= area.highest + curve.spectrum->df)
                points.push_back({f, curve.reference.db(curve.spectrum->power[k])});
        axes.curve(points, curve.colour, curve.dash, false);
    }
    draw_marks(figure, area, marks, [&](double hz) { return axes.at(hz, shown.low).x; });
}

double end_of_envelope(std::pair<double, double> band, std::span<const analysis::MarkPlace> marks) {
    const double whole = 0.5 * (band.second - band.first);
    double last = 0.0;
    for (const analysis::MarkPlace& mark : marks) last = std::max(last, mark.frequency);
    return last > 0.0 ? std::min(whole, 1.25 * last) : whole;
}

}  // namespace tactus::report
