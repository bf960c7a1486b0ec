// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/rig_figures.hpp"

#include "tools/report/figures/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace tactus::report {

namespace {

constexpr const auto& colours = curve_colours;
constexpr display::Colour ink = axis_ink, soft = axis_soft;

std::vector<std::string> motors_of(const analysis::RigReport& report) {
    std::vector<std::string> all;
    for (const analysis::RigRow& row : report.rows)
        if (std::ranges::find(all, row.cell.motor) == all.end()) all.push_back(row.cell.motor);
    return all;
}

std::vector<std::string> objects_of(const analysis::RigReport& report, bool springs_only) {
    std::vector<std::string> all;
    for (const analysis::RigRow& row : report.rows)
        if (std::ranges::find(all, row.cell.object.name) == all.end() &&
            (springs_only ? row.fidelity.gain_error_db.has_value() : true))
            all.push_back(row.cell.object.name);
    return all;
}

std::set<double> amplitudes_of(const analysis::RigReport& report) {
    std::set<double> all;
    for (const analysis::RigRow& row : report.rows) all.insert(row.cell.amplitude);
    return all;
}

Scale rates_of(const analysis::RigReport& report) {
    Scale scale{1e9, 0.0, true};
    for (const analysis::RigRow& row : report.rows) {
        scale.low = std::min(scale.low, row.cell.rate);
        scale.high = std::max(scale.high, row.cell.rate);
    }
    scale.low *= 0.9;
    scale.high *= 1.1;
    return scale;
}

display::Colour colour_of(const std::vector<std::string>& motors, const std::string& motor) {
    const auto at = static_cast<std::size_t>(std::ranges::find(motors, motor) - motors.begin());
    return colours[at % colours.size()];
}

/// Legend along the top: colours for motors, dashes for amplitudes.
void legend(display::Figure& figure, const analysis::RigReport& report, bool with_amplitudes) {
    const std::vector<std::string> motors = motors_of(report);
    double x = 60.0;
    for (const std::string& motor : motors) {
        figure.line({{x, 18.0}, {x + 24.0, 18.0}}, colour_of(motors, motor), 2.0);
        figure.text({x + 30.0, 22.0}, motor, 11.0, ink);
        x += 44.0 + 8.0 * static_cast<double>(motor.size());
    }
    if (!with_amplitudes) return;
    double dash = 0.0;
    for (const double amplitude : amplitudes_of(report)) {
        figure.line({{x, 18.0}, {x + 24.0, 18.0}}, soft, 1.5, dash);
        figure.text({x + 30.0, 22.0}, fmt::format("cord ±{:g} mm", amplitude * 1e3), 11.0, ink);
        x += 130.0;
        dash += 4.0;
    }
}

constexpr double panel_width = 230.0, panel_height = 150.0, left = 60.0, gap_across = 70.0, gap_down = 62.0, top = 54.0;

display::Figure sheet(std::size_t panels, std::size_t columns, std::size_t rows_per_panel = 1) {
    const auto rows = static_cast<double>((panels + columns - 1) / columns * rows_per_panel);
    return {left + static_cast<double>(columns) * (panel_width + gap_across) - 30.0,
            top + rows * (panel_height + gap_down) - 14.0};
}

Axes panel(display::Figure& figure, std::size_t column, std::size_t row, Scale across, Scale up) {
    return {figure,
            left + static_cast<double>(column) * (panel_width + gap_across),
            top + static_cast<double>(row) * (panel_height + gap_down),
            panel_width,
            panel_height,
            across,
            up};
}

template <class Value>
void curves(const Axes& axes, const analysis::RigReport& report, const std::string& object, Value&& value) {
    const std::vector<std::string> motors = motors_of(report);
    for (const std::string& motor : motors) {
        double dash = 0.0;
        for (const double amplitude : amplitudes_of(report)) {
            std::vector<display::FigurePoint> points;
            for (const analysis::RigRow& row : report.rows)
                if (row.cell.motor == motor && row.cell.object.name == object && row.cell.amplitude == amplitude)
                    if (const std::optional<double> v = value(row)) points.push_back({row.cell.rate, *v});
            axes.curve(points, colour_of(motors, motor), dash, true);
            dash += 4.0;
        }
    }
}

}  // namespace

display::Figure draw_rig_errors(const analysis::RigReport& report) {
    const std::vector<std::string> objects = objects_of(report, false);
    display::Figure figure = sheet(objects.size(), 3);
    legend(figure, report, true);
    const Scale rates = rates_of(report);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const bool is_wall = std::ranges::none_of(report.rows, [&](const analysis::RigRow& row) {
            return row.cell.object.name == objects[i] && row.fidelity.nrmse.has_value();
        });
        const Axes axes =
            panel(figure, i % 3, i / 3, rates, is_wall ? Scale{0.01, 50.0, true} : Scale{0.3, 300.0, true});
        axes.draw(objects[i], "rate of the rig, Hz", is_wall ? "penetration, mm" : "NRMSE, %");
        curves(axes, report, objects[i], [&](const analysis::RigRow& row) -> std::optional<double> {
            if (is_wall) return std::max(row.fidelity.penetration * 1e3, 0.01);
            return row.fidelity.nrmse ? std::optional(*row.fidelity.nrmse * 100.0) : std::nullopt;
        });
    }
    return figure;
}

display::Figure draw_rig_response(const analysis::RigReport& report) {
    std::vector<std::string> objects = objects_of(report, true);
    objects.resize(std::min<std::size_t>(objects.size(), 3));
    display::Figure figure = sheet(objects.size(), 3, 2);
    legend(figure, report, true);
    const Scale rates = rates_of(report);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const Axes gain = panel(figure, i, 0, rates, {-12.0, 6.0, false}),
                   phase = panel(figure, i, 1, rates, {-120.0, 30.0, false});
        gain.draw(objects[i], "", "gain error, dB");
        phase.draw("", "rate of the rig, Hz", "phase error, °");
        curves(gain, report, objects[i], [](const analysis::RigRow& row) { return row.fidelity.gain_error_db; });
        curves(phase, report, objects[i], [](const analysis::RigRow& row) { return row.fidelity.phase_error_deg; });
    }
    return figure;
}

display::Figure draw_rig_crossover(const analysis::RigReport& report) {
    display::Figure figure = sheet(report.crossover.size(), 3);
    legend(figure, report, false);
    for (std::size_t i = 0; i < report.crossover.size(); ++i) {
        const analysis::RigCrossover& c = report.crossover[i];
        const Axes axes =
            panel(figure, i % 3, i / 3, {c.rates.front() * 0.9, c.rates.back() * 1.1, true}, {0.3, 300.0, true});
        axes.draw(fmt::format("{:g} N/mm, cord ±{:.3g} mm", c.stiffness * 1e-3, c.amplitude * 1e3),
                  "rate of the rig, Hz", "NRMSE, %");
        const auto band = [&](const std::vector<std::pair<double, double>>& ends, display::Colour colour) {
            std::vector<display::FigurePoint> outline, low, high;
            for (std::size_t n = 0; n < ends.size(); ++n) {
                low.push_back({c.rates[n], ends[n].first * 100.0});
                high.push_back({c.rates[n], ends[n].second * 100.0});
                outline.push_back(axes.at(low.back().x, low.back().y));
            }
            for (std::size_t n = ends.size(); n-- > 0;) outline.push_back(axes.at(high[n].x, high[n].y));
            display::Colour pale = colour;
            pale.opacity = 0.18;
            figure.fill(outline, pale);
            axes.curve(low, colour, 0.0, false);
            axes.curve(high, colour, 0.0, false);
        };
        band(c.slow_motor, colours[0]);
        band(c.fast_motor, colours[1]);
        if (!c.low) continue;
        for (const double rate : {*c.low, c.high.value_or(*c.low)})
            figure.line({axes.at(rate, axes.up.low), axes.at(rate, axes.up.high)}, soft, 1.2, 4.0);
        const bool is_left = c.low.value() < std::sqrt(c.rates.front() * c.rates.back());
        figure.text({axes.at(*c.low, 1.0).x + (is_left ? 4.0 : -4.0), axes.y + 14.0},
                    fmt::format("{:.2g}–{:.2g} Hz", *c.low, c.high.value_or(*c.low)), 10.0, ink,
                    is_left ? display::TextAnchor::start : display::TextAnchor::end);
    }
    return figure;
}

display::Figure draw_rig_leads(const analysis::RigReport& report) {
    std::vector<std::string> objects;
    for (const analysis::RigLead& lead : report.leads)
        if (std::ranges::find(objects, lead.cell.object.name) == objects.end())
            objects.push_back(lead.cell.object.name);
    objects.resize(std::min<std::size_t>(objects.size(), 6));
    display::Figure figure = sheet(objects.size(), 3);
    legend(figure, report, false);
    const std::vector<std::string> motors = motors_of(report);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const Axes axes = panel(figure, i % 3, i / 3, rates_of(report), {0.5, 50.0, true});
        axes.draw(objects[i], "rate of the rig, Hz", "error without / with");
        axes.curve({{axes.across.low, 1.0}, {axes.across.high, 1.0}}, soft, 4.0, false);
        for (const std::string& motor : motors) {
            std::vector<display::FigurePoint> points;
            for (const analysis::RigLead& lead : report.leads)
                if (lead.cell.motor == motor && lead.cell.object.name == objects[i])
                    points.push_back({lead.cell.rate, lead.ratio()});
            axes.curve(points, colour_of(motors, motor), 0.0, true);
        }
    }
    return figure;
}

display::Figure draw_rig_examples(const analysis::RigReport& report) {
    display::Figure figure = sheet(report.examples.size(), 3);
    legend(figure, report, false);
    const std::vector<std::string> motors = motors_of(report);
    for (std::size_t i = 0; i < report.examples.size(); ++i) {
        const analysis::RigExample& e = report.examples[i];
        const auto count = static_cast<std::size_t>(std::lround(1.0 / (e.cell.rate * e.series.period)));
        const std::size_t from = e.series.force.size() - std::min(count, e.series.force.size());
        double force = 0.1, position = 1e-4;
        std::vector<display::FigurePoint> loop, ideal;
        for (std::size_t n = from; n < e.series.force.size(); ++n) {
            force = std::max(force, std::abs(e.series.force[n]));
            position = std::max(position, std::abs(e.series.position[n]));
            loop.push_back({e.series.force[n], e.series.position[n] * 1e3});
        }
        const std::vector<double> object = control::ideal_response(e.series, analysis::object_of(e.cell.object));
        for (std::size_t n = from; n < e.series.force.size(); ++n) {
            position = std::max(position, std::abs(object[n]));
            ideal.push_back({e.series.force[n], object[n] * 1e3});
        }
        const Axes axes = panel(figure, i % 3, i / 3, {-1.1 * force, 1.1 * force, false},
                                {-1.1e3 * position, 1.1e3 * position, false});
        axes.draw(e.title, "force, N", "position, mm");
        axes.curve(ideal, soft, 4.0, false);
        axes.curve(loop, colour_of(motors, e.cell.motor), 0.0, false);
    }
    return figure;
}

}  // namespace tactus::report
