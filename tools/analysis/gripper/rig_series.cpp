// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/gripper/rig_series.hpp"

#include "assets/table/number_table.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tactus::analysis {

namespace {

/// Resamples to the mean period by linear interpolation; flags come from the previous sample.
control::RigSeries evened(const std::vector<double>& times, control::RigSeries s, const SourceLocation& where) {
    const std::size_t count = times.size();
    if (count < 16) throw Error(where, "a record needs at least 16 samples");
    s.period = (times.back() - times.front()) / static_cast<double>(count - 1);
    double worst = 0.0;
    for (std::size_t i = 1; i < count; ++i) {
        if (!(times[i] > times[i - 1])) throw Error(where, "times must increase within a record");
        worst = std::max(worst, std::abs(times[i] - times[0] - static_cast<double>(i) * s.period));
    }
    if (worst < 0.01 * s.period) return s;
    control::RigSeries even = s;
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double time = times[0] + static_cast<double>(i) * s.period;
        while (at + 2 < count && times[at + 1] <= time) ++at;
        const double share = std::clamp((time - times[at]) / (times[at + 1] - times[at]), 0.0, 1.0);
        even.force[i] = s.force[at] + share * (s.force[at + 1] - s.force[at]);
        even.position[i] = s.position[at] + share * (s.position[at + 1] - s.position[at]);
        if (!s.slips.empty()) even.slips[i] = s.slips[at];
        if (!s.saturated.empty()) even.saturated[i] = s.saturated[at];
    }
    return even;
}

double number_or(const std::string& text, double standard, const SourceLocation& where, const char* name) {
    if (text.empty()) return standard;
    try {
        std::size_t used = 0;
        const double value = std::stod(text, &used);
        if (used == text.size() && std::isfinite(value) && value >= 0.0) return value;
    } catch (const std::exception&) {
    }
    throw Error(where, fmt::format("column '{}' holds '{}', which is not a number of at least 0", name, text));
}

}  // namespace

std::vector<std::pair<RigCell, control::RigSeries>> load_rig_series(const std::filesystem::path& path,
                                                                    std::vector<std::string>& notes) {
    const table::NumberTable table = table::load_number_table(path);
    const auto &motors = table.text("motor"), &objects = table.text("object"), &ks = table.text("stiffness_N_per_mm"),
               &bs = table.text("damping_Ns_per_mm"), &rates = table.text("rate_hz"),
               &amplitudes = table.text("amplitude_mm");
    const std::vector<double> times = table.numbers("time_s"), forces = table.numbers("force_N"),
                              positions = table.numbers("position_mm");
    const bool has_slip = table.has("slip"), has_saturated = table.has("saturated");
    const std::vector<double> slips = has_slip ? table.numbers("slip") : std::vector<double>{},
                              saturated = has_saturated ? table.numbers("saturated") : std::vector<double>{};
    if (table.rows() == 0) throw Error({path.string(), 1, 1}, "the record has no samples");
    if (!has_slip) notes.push_back("the record has no slip column: all samples are evaluated");
    std::vector<std::pair<RigCell, control::RigSeries>> all;
    for (std::size_t begin = 0, end = 0; begin < table.rows(); begin = end) {
        const auto same = [&](std::size_t i) {
            return motors[i] == motors[begin] && objects[i] == objects[begin] && ks[i] == ks[begin] &&
                   bs[i] == bs[begin] && rates[i] == rates[begin] && amplitudes[i] == amplitudes[begin];
        };
        for (end = begin + 1; end < table.rows() && same(end);) ++end;
        const SourceLocation where{path.string(), table.lines[begin], 1};
        RigCell cell;
        cell.motor = motors[begin];
        cell.object.name = objects[begin];
        cell.object.stiffness = 1e3 * number_or(ks[begin], 0.0, where, "stiffness_N_per_mm");
        cell.object.damping = 1e3 * number_or(bs[begin], 0.0, where, "damping_Ns_per_mm");
        const bool is_wall = objects[begin] == "wall" || (cell.object.stiffness == 0.0 && cell.object.damping == 0.0);
        cell.object.kind = is_wall ? control::ObjectKind::wall : control::ObjectKind::elastic;
        cell.rate = number_or(rates[begin], 0.0, where, "rate_hz");
        cell.amplitude = 1e-3 * number_or(amplitudes[begin], 0.0, where, "amplitude_mm");
        if (!(cell.rate > 0.0)) throw Error(where, "the rate of the rig must be above 0");
        control::RigSeries series;
        for (std::size_t i = begin; i < end; ++i) {
            series.force.push_back(forces[i]);
            series.position.push_back(positions[i] * 1e-3);
            if (has_slip) series.slips.push_back(slips[i] != 0.0);
            if (has_saturated) series.saturated.push_back(saturated[i] != 0.0);
        }
        const std::vector<double> mine(times.begin() + static_cast<std::ptrdiff_t>(begin),
                                       times.begin() + static_cast<std::ptrdiff_t>(end));
        all.emplace_back(std::move(cell), evened(mine, std::move(series), where));
    }
    return all;
}

std::string rig_series_csv(const RigCell& cell, const control::RigSeries& series, bool first) {
    std::string out =
        first ? "motor,object,stiffness_N_per_mm,damping_Ns_per_mm,rate_hz,amplitude_mm,time_s,force_N,position_mm,"
                "slip,saturated\n"
              : "";
    const std::string head =
        fmt::format("{},{},{:.9g},{:.9g},{:.9g},{:.9g}", cell.motor,
                    cell.object.kind == control::ObjectKind::wall ? std::string("wall") : cell.object.name,
                    cell.object.stiffness * 1e-3, cell.object.damping * 1e-3, cell.rate, cell.amplitude * 1e3);
    for (std::size_t i = 0; i < series.force.size(); ++i)
        fmt::format_to(std::back_inserter(out), "{},{:.6f},{:.7g},{:.8g},{},{}\n", head,
                       static_cast<double>(i) * series.period, series.force[i], series.position[i] * 1e3,
                       i < series.slips.size() && series.slips[i] ? 1 : 0,
                       i < series.saturated.size() && series.saturated[i] ? 1 : 0);
    return out;
}

}  // namespace tactus::analysis
