// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/response_figure.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/readable.hpp"
#include "tools/report/figures/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace tactus::report {

namespace {

/// Runs of neighbouring bins in which `holds`, each as one curve.
void draw_runs(const Axes& axes, const analysis::TwoChannels& found, display::Colour colour, double dash,
               const std::function<bool(std::size_t)>& holds, const std::function<double(std::size_t)>& value) {
    std::vector<display::FigurePoint> run;
    for (std::size_t k = 1; k <= found.coherence.size(); ++k) {
        const bool in = k < found.coherence.size() && holds(k) && found.spectra.frequency(k) >= axes.across.low &&
                        found.spectra.frequency(k) <= axes.across.high;
        if (in) run.push_back({found.spectra.frequency(k), value(k)});
        if (in || run.empty()) continue;
        axes.curve(run, colour, dash, run.size() == 1);
        run.clear();
    }
}

}  // namespace

display::Figure draw_response(const analysis::TwoChannels& found, const std::filesystem::path& file,
                              const FigureStyle& style) {
    const double left = style.left, width = style.panel_width(), gap = style.gap(50.0), top = style.gap(62.0),
                 level_height = style.height(220.0), phase_height = style.height(130.0),
                 coherence_height = style.height(110.0);
    display::Figure figure(style.width, top + level_height + phase_height + coherence_height + 2.6 * gap);
    figure.text({left, style.gap(22.0)}, file.filename().string(), style.heading, axis_ink, display::TextAnchor::start,
                true);
    figure.text({left, style.gap(37.0)},
                fmt::format("{} to {}; Welch, {} segments, bandwidth {}", found.input, found.output,
                            found.spectra.segments, readable(found.spectra.noise_bandwidth, "Hz")),
                style.text, axis_soft);
    const auto is_coherent = [&](std::size_t k) { return found.coherence[k] >= 0.5; };
    const auto db = [](const std::complex<double>& h) { return 20.0 * std::log10(std::max(std::abs(h), 1e-15)); };
    const std::vector<std::complex<double>>& chosen = found.chosen();
    const double low_hz = std::max(2.0 * found.spectra.df, 0.001 * found.usable);
    double low = 1e300, high = -1e300;
    for (std::size_t k = 1; k < chosen.size(); ++k) {
        if (!is_coherent(k) || found.spectra.frequency(k) < low_hz || found.spectra.frequency(k) > found.usable)
            continue;
        low = std::min(low, db(chosen[k]));
        high = std::max(high, db(chosen[k]));
    }
    if (!(low < high)) low = -10.0, high = 10.0;
    low = std::max(low, high - 80.0);
    const Scale hz{low_hz, found.usable, true};
    const char* const names[] = {"H1", "H2", "Hv"};
    double y = top;
    const Axes level{figure, left, y, width, level_height, hz, {low - 3.0, high + 3.0, false}, style};
    level.draw(fmt::format("{}{}", names[static_cast<int>(found.estimator)],
                           found.estimator == analysis::Estimator::hv ? "; dashed: H1 (lower) and H2" : ""),
               "", "dB");
    if (found.estimator == analysis::Estimator::hv) {
        draw_runs(level, found, curve_colours[2], 4.0, is_coherent, [&](std::size_t k) { return db(found.h1[k]); });
        draw_runs(level, found, curve_colours[1], 4.0, is_coherent, [&](std::size_t k) { return db(found.h2[k]); });
    }
    draw_runs(level, found, curve_colours[0], 0.0, is_coherent, [&](std::size_t k) { return db(chosen[k]); });
    y += level_height + gap;
    const Axes phase{figure, left, y, width, phase_height, hz, {-180.0, 180.0, false, 90.0}, style};
    phase.draw("phase", "", "degrees");
    // A step of more than half a turn between bins is a wrap, no slope: the curve breaks there.
    const auto degrees = [&](std::size_t k) { return std::arg(chosen[k]) * 180.0 / pi; };
    std::size_t begin = 1;
    for (std::size_t k = 2; k <= chosen.size(); ++k) {
        if (k < chosen.size() && std::abs(degrees(k) - degrees(k - 1)) < 180.0) continue;
        draw_runs(
            phase, found, curve_colours[0], 0.0,
            [&](std::size_t bin) { return bin >= begin && bin < k && is_coherent(bin); }, degrees);
        begin = k;
    }
    y += phase_height + gap;
    const Axes coherence{figure, left, y, width, coherence_height, hz, {0.0, 1.0, false, 0.25}, style};
    coherence.draw("coherence", "frequency, Hz", "");
    draw_runs(
        coherence, found, curve_colours[0], 0.0, [](std::size_t) { return true; },
        [&](std::size_t k) { return found.coherence[k]; });
    coherence.level(found.noise_coherence, axis_soft, "unrelated noise");
    return figure;
}

}  // namespace tactus::report
