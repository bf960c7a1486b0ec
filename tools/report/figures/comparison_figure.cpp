// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/comparison_figure.hpp"

#include "dsp/core/readable.hpp"
#include "tools/report/figures/plot_panel.hpp"
#include "tools/report/figures/spectrogram_panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

// Distinguishable in grey and with red-green colour blindness.
constexpr display::Colour reference_colour{0x1F, 0x4E, 0x9E}, output_colour{0xE0, 0x7B, 0x10},
    added_colour{0xB8, 0x1D, 0x24}, pass_colour{0x1B, 0x7A, 0x3D}, ink{0x22, 0x26, 0x2E}, soft{0x6B, 0x72, 0x80},
    limit_colour{0x8A, 0x8F, 0x99}, band_colour{0x9A, 0xA3, 0xB2};

constexpr double left = 64.0, right = 300.0, panel_width = 560.0, gap = 34.0;
constexpr double picture_width = 352.0, picture_height = 150.0;

/// Density in dB relative to `top`.
std::vector<double> levels(const std::vector<double>& density, double top) {
    std::vector<double> out;
    for (const double power : density) out.push_back(10.0 * std::log10(std::max(power / top, 1e-20)));
    return out;
}

double greatest_in(const std::vector<double>& density, double step, double lowest, double highest) {
    double greatest = 1e-300;
    for (std::size_t k = 0; k < density.size(); ++k) {
        const double f = static_cast<double>(k) * step;
        if (f >= lowest && f <= highest) greatest = std::max(greatest, density[k]);
    }
    return greatest;
}

/// Hz: what the panels show.
PlotPanel::Range plotted_range(const analysis::ComparedPair& pair) {
    const signal::Comparison& c = pair.comparison;
    if (pair.plotted) return {pair.plotted->first, pair.plotted->second};
    return {20.0, c.end};
}

/// Shades what is shown beside the judged band, and says so where there is room.
void shade_not_judged(display::Figure& figure, const signal::Comparison& c, const PlotPanel& panel,
                      const PlotPanel::Range& hz, double y, double height, bool name) {
    constexpr display::Colour veil{0xEE, 0xF0, 0xF3};
    const auto shade = [&](double from, double to) {
        if (from >= to) return;
        figure.rectangle(panel.x_of(from), y, panel.x_of(to) - panel.x_of(from), height, veil);
        if (name && panel.x_of(to) - panel.x_of(from) > 70.0)
            figure.text({0.5 * (panel.x_of(from) + panel.x_of(to)), y + height - 6.0}, "not judged", 10.0, soft,
                        display::TextAnchor::middle);
    };
    shade(hz.lowest, std::min(c.lowest, hz.highest));
    shade(std::max(c.highest, hz.lowest), hz.highest);
}

double level_at(const std::vector<double>& level, double step, double hz) {
    const auto k = static_cast<std::size_t>(std::max(1.0, std::round(hz / step)));
    double best = -200.0;
    for (std::size_t i = k - 1; i <= k + 1 && i < level.size(); ++i) best = std::max(best, level[i]);
    return best;
}

void mark(display::Figure& figure, double x, double y, display::Colour colour, bool upwards) {
    const double s = upwards ? 1.0 : -1.0;
    figure.fill({{x, y}, {x - 4.5, y - 8.0 * s}, {x + 4.5, y - 8.0 * s}}, colour);
}

/// Names that stand close together, one above the other.
class Names {
public:
    /// Names go no higher than `top`; what has no room is left out.
    Names(display::Figure& figure, double top) : figure_(figure), top_(top) {}

    /// Writes around `x`, with the base line at `y` or above it.
    void write(double x, double y, const std::string& text, display::Colour colour,
               display::TextAnchor anchor = display::TextAnchor::middle) {
        const double half = 3.0 * static_cast<double>(text.size());
        const auto overlaps = [&](const Box& box) {
            return x + half > box.from && x - half < box.to && std::abs(y - box.y) < 11.0;
        };
        while (std::ranges::any_of(taken_, overlaps)) y -= 2.0;
        if (y < top_) return;
        taken_.push_back({x - half, x + half, y});
        figure_.text({x, y}, text, 10.0, colour, anchor);
    }

private:
    struct Box {
        double from, to, y;
    };
    display::Figure& figure_;
    double top_;
    std::vector<Box> taken_;
};

/// "×2" for the second order, "hum" for the mains, "hum?" for what may be either.
std::string short_name(const std::string& name) {
    if (name.empty()) return "";
    if (!name.starts_with("order ")) return "hum";
    return name.ends_with("or mains hum") ? "hum?" : "×" + name.substr(6);
}

std::string with_name(const std::string& text, const std::string& name) {
    return name.empty() ? text : text + " (" + short_name(name) + ")";
}

void draw_spectra(display::Figure& figure, const signal::Comparison& c, const PlotPanel::Range& hz, double y,
                  double height) {
    const double top = greatest_in(c.reference_density, c.step, c.lowest, c.highest);
    const std::vector<double> r = levels(c.reference_density, top), d = levels(c.output_density, top);
    const double greatest = std::max(greatest_in(c.reference_density, c.step, hz.lowest, hz.highest),
                                     greatest_in(c.output_density, c.step, hz.lowest, hz.highest));
    const double above = std::max(10.0, 10.0 * std::ceil(std::log10(greatest / top)) + 10.0);
    const PlotPanel panel(figure, left, y, panel_width, height, hz, {-60.0, above});
    shade_not_judged(figure, c, panel, hz, y, height, true);
    panel.axes(10.0, "dB re strongest judged", false);
    if (hz.highest > 500.0 && hz.lowest < 500.0) {
        panel.upright(500.0, limit_colour, 4.0);
        figure.text({panel.x_of(500.0) + 4.0, y + height - 6.0}, "limit of touch", 10.0, soft);
    }
    // The reference line is wider, so that it stays visible where both coincide.
    panel.curve(r, c.step, reference_colour, 3.2);
    panel.curve(d, c.step, output_colour, 1.3);
    double taken = -1e9;
    Names names(figure, y - 4.0);
    const analysis::LineNames line_names(c);
    for (const signal::SpectralLine& line : c.lines.in_both) {
        const double x = panel.x_of(line.frequency), level = level_at(r, c.step, line.frequency);
        if (line.frequency < hz.lowest || line.frequency > hz.highest) continue;
        if (level < -45.0 || x < taken + 26.0 || x > left + panel_width - 12.0) continue;
        const double at = panel.y_of(std::max(level, level_at(d, c.step, line.frequency))) - 5.0;
        const std::string number = fmt::format("{:.0f}", line.frequency);
        names.write(x, at, number, ink);
        if (const std::string name = short_name(line_names.of_reference(line.frequency)); !name.empty())
            names.write(x, at - 11.0, name, soft);
        taken = x;
    }
    for (const signal::SpectralLine& line : c.lines.only_in_reference) {
        if (line.frequency < hz.lowest || line.frequency > hz.highest) continue;
        const double x = panel.x_of(line.frequency), at = panel.y_of(level_at(r, c.step, line.frequency)) - 3.0;
        mark(figure, x, at, reference_colour, true);
        const std::string name =
            with_name(fmt::format("{:.0f} missing", line.frequency), line_names.of_reference(line.frequency));
        names.write(x, at - 11.0, name, reference_colour);
    }
    for (const signal::SpectralLine& line : c.lines.only_in_output) {
        const double f = line.frequency * (1.0 / c.speed_ratio);
        if (f < hz.lowest || f > hz.highest) continue;
        const double x = std::max(panel.x_of(f), left + 4.0);
        const double at = panel.y_of(level_at(d, c.step, f)) - 3.0;
        mark(figure, x, at, added_colour, true);
        const std::string name =
            with_name(fmt::format("{:.0f} added", line.frequency), line_names.of_output(line.frequency));
        names.write(x, at - 11.0, name, added_colour,
                    x < left + 30.0 ? display::TextAnchor::start : display::TextAnchor::middle);
    }
}

void draw_bands(display::Figure& figure, const signal::Comparison& c, const table::Thresholds& thresholds,
                const PlotPanel::Range& hz, double y, double height, bool last) {
    const double limit = thresholds.third_octave_max_db.value_or(0.0);
    double reach = 6.0;
    for (const signal::BandError& band : c.third_octaves) reach = std::max(reach, std::abs(band.error_db));
    reach = std::ceil(std::min(reach, 30.0) / 3.0) * 3.0;
    const PlotPanel panel(figure, left, y, panel_width, height, hz, {-reach, reach});
    shade_not_judged(figure, c, panel, hz, y, height, false);
    if (limit > 0.0)
        figure.rectangle(left, panel.y_of(limit), panel_width, panel.y_of(-limit) - panel.y_of(limit),
                         {0xD8, 0xEF, 0xDF, 0.7});
    panel.axes(reach > 9.0 ? 6.0 : 3.0, "band error, dB", last);
    figure.clip(left, y, panel_width, height);
    for (const signal::BandError& band : c.third_octaves) {
        if (band.hz < hz.lowest || band.hz > hz.highest) continue;
        const double a = std::max(left, panel.x_of(band.hz * std::pow(10.0, -0.045)));
        const double b = std::min(left + panel_width, panel.x_of(band.hz * std::pow(10.0, 0.045)));
        const double zero = panel.y_of(0.0), end = panel.y_of(band.error_db);
        const bool bad = limit > 0.0 && std::abs(band.error_db) > limit;
        figure.rectangle(a, std::min(zero, end), b - a, std::max(std::abs(end - zero), 0.8),
                         bad ? added_colour : band_colour);
    }
    figure.unclip();
    panel.level(0.0, soft, 0.0);
}

void draw_coherence(display::Figure& figure, const signal::Comparison& c, const PlotPanel::Range& hz, double y,
                    double height) {
    const PlotPanel panel(figure, left, y, panel_width, height, hz, {0.0, 1.08});
    shade_not_judged(figure, c, panel, hz, y, height, false);
    panel.axes(0.5, "coherence", true);
    panel.curve(c.coherence, c.coherence_step, soft, 1.4);
}

std::string number(double value) {
    if (value == std::round(value) && std::abs(value) != 1.0) return plain(value, 6);
    return fmt::format("{:.{}f}", value, std::abs(value) < 10.0 ? 3 : 1);
}

void draw_table(display::Figure& figure, const signal::Comparison& c, const analysis::Verdict& verdict, double x,
                double y) {
    const auto row = [&](const std::string& name, const std::string& value, const std::string& limit,
                         display::Colour colour) {
        figure.text({x, y}, name, 11.0, colour);
        figure.text({x + 190.0, y}, value, 11.0, colour, display::TextAnchor::end);
        figure.text({x + 262.0, y}, limit, 11.0, soft, display::TextAnchor::end);
        y += 18.0;
    };
    row("score", "value", "threshold", soft);
    for (const analysis::Judged& score : verdict.scores)
        row(score.name, number(score.value), fmt::format("{} {:g}", score.at_least ? "≥" : "≤", score.limit),
            score.passed ? ink : added_colour);
    y += 6.0;
    const auto extra = [&](const char* name, const std::optional<double>& value, const char* unit) {
        for (const analysis::Judged& score : verdict.scores)
            if (score.name == name) return;
        row(name, value ? number(*value) + unit : "none", "", ink);
    };
    extra("spectrogram_similarity", c.spectrogram_similarity, "");
    extra("st_sim", c.st_sim, "");
    extra("spqi", c.spqi, "");
    extra("coherence_mean", c.coherence_mean, "");
    extra("gain", c.gain_db, " dB");
    extra("fundamental, reference", c.reference_hz > 0.0 ? std::optional(c.reference_hz) : std::nullopt, " Hz");
    extra("fundamental, output", c.output_hz > 0.0 ? std::optional(c.output_hz) : std::nullopt, " Hz");
    if (c.alignment.significant) extra("delay", 1e3 * c.alignment.delay, " ms");
}

/// Both spectrograms, each from its own start and down to 60 dB below its maximum.
void draw_pictures(display::Figure& figure, const analysis::ComparedPair& pair, double y) {
    const PlotPanel::Range hz = plotted_range(pair);
    const std::string names[] = {pair.reference.filename().string(), pair.output.filename().string()};
    for (std::size_t i = 0; i < 2; ++i) {
        const double x = left + static_cast<double>(i) * (picture_width + 66.0);
        figure.text({x, y - 7.0}, names[i], 11.0, i == 0 ? reference_colour : output_colour);
        draw_spectrogram(figure, pair.spectrograms[i], {x, y, picture_width, picture_height},
                         {.lowest = hz.lowest,
                          .highest = hz.highest,
                          .rows = 64,
                          .columns = 160,
                          .legend = i == 1,
                          .relative = true,
                          .begin = pair.stretches[i].from});
    }
}

}  // namespace

display::Figure draw_comparison(const analysis::ComparedPair& pair) {
    const signal::Comparison& c = pair.comparison;
    const analysis::Verdict& verdict = pair.verdict;
    const std::string reference_name = pair.reference.filename().string(),
                      output_name = pair.output.filename().string();
    const bool coherent = !c.coherence.empty();
    const double top = 62.0, spectra = 250.0, bands = 110.0, coherence = coherent ? 70.0 + gap * 0.6 : 0.0;
    const double curves = std::max(top + spectra + gap * 0.6 + bands + coherence + 46.0, 470.0);
    const bool pictures = pair.spectrograms.size() == 2;
    display::Figure figure(left + panel_width + right, curves + (pictures ? picture_height + 76.0 : 0.0));
    // Green is kept for a verdict about all that the page shows.
    const bool is_partial = verdict.passed() ? pair.not_judged > 0.0 : !verdict.is_judged();
    figure.text({left, 24.0},
                verdict.words() + (verdict.passed() && is_partial
                                       ? fmt::format("; {:.0f} % of the power is not judged", 100.0 * pair.not_judged)
                                       : ""),
                16.0,
                is_partial         ? ink
                : verdict.passed() ? pass_colour
                                   : added_colour,
                display::TextAnchor::start, true);
    figure.line({{left, 42.0}, {left + 24.0, 42.0}}, reference_colour, 2.5);
    figure.text({left + 30.0, 46.0}, reference_name, 12.0, ink);
    figure.line({{left + 290.0, 42.0}, {left + 314.0, 42.0}}, output_colour, 2.5);
    figure.text({left + 320.0, 46.0}, fmt::format("{}, {:+.1f} dB", output_name, c.gain_db), 12.0, ink);
    double y = top;
    const PlotPanel::Range hz = plotted_range(pair);
    draw_spectra(figure, c, hz, y, spectra);
    y += spectra + gap * 0.6;
    draw_bands(figure, c, pair.thresholds, hz, y, bands, !coherent);
    y += bands;
    if (coherent) {
        y += gap * 0.6;
        draw_coherence(figure, c, hz, y, 70.0);
        y += 70.0;
    }
    figure.text({left + 0.5 * panel_width, y + 32.0}, "frequency, Hz", 11.0, ink, display::TextAnchor::middle);
    draw_table(figure, c, verdict, left + panel_width + 24.0, top + 10.0);
    if (pictures) draw_pictures(figure, pair, curves + 24.0);
    return figure;
}

}  // namespace tactus::report
