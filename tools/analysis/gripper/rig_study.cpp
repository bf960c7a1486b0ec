// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/gripper/rig_study.hpp"

#include "dsp/simulate/gripper/rig.hpp"
#include "tools/analysis/gripper/rig_findings.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <tuple>

namespace tactus::analysis {

namespace {

/// Settings of a motor: all combinations of the limits of its assumptions.
std::vector<std::vector<std::string>> corners(const RigMatrix& matrix, const std::string& motor) {
    std::vector<std::vector<std::string>> all{{}};
    for (const RigAssumption& a : matrix.assumptions) {
        if (a.motor != motor) continue;
        std::vector<std::vector<std::string>> both;
        for (const auto& settings : all)
            for (const std::string& end : {a.low, a.high}) {
                both.push_back(settings);
                both.back().push_back(fmt::format("devices.{}.{}={}", motor, a.option, end));
            }
        all = std::move(both);
    }
    return all;
}

std::optional<RigObject> spring_of(const RigMatrix& matrix, bool stiffest) {
    std::optional<RigObject> found;
    for (const RigObject& o : matrix.objects)
        if (o.kind == control::ObjectKind::elastic && o.stiffness > 0.0 && o.damping == 0.0 &&
            (!found || (stiffest ? o.stiffness > found->stiffness : o.stiffness < found->stiffness)))
            found = o;
    return found;
}

double nearest(const std::vector<double>& all, double to) {
    return *std::ranges::min_element(all, {}, [to](double v) { return std::abs(std::log(v / to)); });
}

/// Amplitude of the cord for which a spring of `stiffness` bears at most `force`.
double swing_for(double force, double stiffness, double widest) {
    const double rig = simulate::RigSprings{}.at_finger();
    return std::min(widest, force * (rig + stiffness) / (rig * stiffness));
}

/// The object with the smallest impedance at `rate`.
std::optional<RigObject> freest(const RigMatrix& matrix, double rate) {
    std::optional<RigObject> found;
    for (const RigObject& o : matrix.objects)
        if (o.kind == control::ObjectKind::elastic &&
            (!found || std::abs(control::ideal_admittance(object_of(o), rate)) >
                           std::abs(control::ideal_admittance(object_of(*found), rate))))
            found = o;
    return found;
}

/// The cells to run, in order; each part of the study adds its cells and stores the index of the first.
class Cells {
public:
    std::size_t add(RigCell cell) {
        cells_.push_back(std::move(cell));
        return cells_.size() - 1;
    }
    const std::vector<RigCell>& all() const { return cells_; }

private:
    std::vector<RigCell> cells_;
};

/// The cells of one motor, per combination of assumptions and rate.
struct Sweep {
    std::vector<std::vector<std::size_t>> cells;  ///< per combination and rate
};

Sweep add_sweep(Cells& cells, const RigMatrix& matrix, const std::string& motor, const RigObject& object,
                double amplitude, const std::vector<double>& rates) {
    Sweep sweep;
    for (const auto& settings : corners(matrix, motor)) {
        sweep.cells.emplace_back();
        for (const double rate : rates)
            sweep.cells.back().push_back(cells.add({motor, object, rate, amplitude, {}, settings}));
    }
    return sweep;
}

std::vector<std::vector<double>> errors_of(const Sweep& sweep, const std::vector<RigRow>& rows) {
    std::vector<std::vector<double>> all;
    for (const auto& corner : sweep.cells) {
        all.emplace_back();
        for (const std::size_t cell : corner)
            all.back().push_back(rows[cell].fidelity.nrmse.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    return all;
}

double largest_amplitude(const std::vector<RigRow>& rows) {
    double most = 0.0;
    for (const RigRow& row : rows) most = std::max(most, row.cell.amplitude);
    return most;
}

}  // namespace

RigReport study_rig(const run::PatchChoice& choice, const RigMatrix& matrix, const RunJobs& run,
                    const std::function<void(int, int)>& progress,
                    const std::function<void(const RigCell&, const control::RigSeries&)>& keep) {
    const RigNodes nodes = find_rig_nodes(choice);
    Cells cells;
    for (const std::string& motor : matrix.motors)
        for (const RigObject& object : matrix.objects)
            for (const double amplitude : matrix.amplitudes)
                for (const double rate : matrix.rates) cells.add({motor, object, rate, amplitude, {}, {}});
    const std::size_t main_cells = cells.all().size();

    struct Lead {
        std::size_t plain, led;
    };
    std::vector<Lead> leads;
    const double gentle = *std::ranges::min_element(matrix.amplitudes),
                 wide = *std::ranges::max_element(matrix.amplitudes);
    for (const std::string& motor : matrix.motors)
        for (const RigObject& object : matrix.objects)
            for (const double rate : matrix.rates)
                if (object.kind == control::ObjectKind::elastic)
                    leads.push_back({cells.add({motor, object, rate, gentle, 0.0, {}}),
                                     cells.add({motor, object, rate, gentle, 1.0, {}})});

    const bool two = matrix.motors.size() == 2;
    std::vector<std::pair<Sweep, Sweep>> sweeps;
    if (two)
        for (const double k : matrix.crossover_stiffness) {
            const RigObject spring{fmt::format("spring {:g} N/mm", k * 1e-3), control::ObjectKind::elastic, k, 0.0};
            sweeps.emplace_back(add_sweep(cells, matrix, matrix.motors[0], spring,
                                          swing_for(matrix.crossover_force, k, wide), matrix.crossover_rates),
                                add_sweep(cells, matrix, matrix.motors[1], spring,
                                          swing_for(matrix.crossover_force, k, wide), matrix.crossover_rates));
        }
    const std::optional<RigObject> stiff = spring_of(matrix, true), soft = spring_of(matrix, false);
    const double slowest = *std::ranges::min_element(matrix.rates), fast = nearest(matrix.rates, 1.0);
    std::vector<std::pair<Sweep, Sweep>> points;
    if (two && stiff)
        for (const auto& [object, amplitude, rate] : {std::tuple{*stiff, std::min(gentle, 0.005), slowest},
                                                      std::tuple{*freest(matrix, fast), 0.7 * wide, fast}})
            points.emplace_back(add_sweep(cells, matrix, matrix.motors[0], object, amplitude, {rate}),
                                add_sweep(cells, matrix, matrix.motors[1], object, amplitude, {rate}));

    const int total = static_cast<int>(cells.all().size());
    std::vector<RigRow> rows(cells.all().size());
    std::vector<control::RigSeries> series(main_cells);
    std::vector<double> max_speeds(main_cells);
    std::mutex telling;
    int done = 0;
    run(total, [&](int n) {
        const auto i = static_cast<std::size_t>(n);
        const RigCell& cell = cells.all()[i];
        compile::AssetCache assets;
        RigRun measured = run_rig_cell(choice, nodes, cell, matrix.cycles, assets);
        rows[i] = judge_rig_cell(cell, measured.series);
        if (i < main_cells) {
            series[i] = std::move(measured.series);
            max_speeds[i] = measured.max_speed;
        }
        const std::lock_guard lock(telling);
        progress(++done, total);
    });

    RigReport report;
    report.rows.assign(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(main_cells));
    report.peak_cord_speed = simulate::peak_cord_speed(2.0 * wide, 1.0);
    report.assumptions = matrix.assumptions;
    for (std::size_t i = 0; i < main_cells; ++i) keep(rows[i].cell, series[i]);
    for (std::size_t i = 0; i < sweeps.size(); ++i)
        report.crossover.push_back(
            find_crossover(matrix.crossover_rates, matrix.crossover_stiffness[i],
                           swing_for(matrix.crossover_force, matrix.crossover_stiffness[i], wide),
                           errors_of(sweeps[i].first, rows), errors_of(sweeps[i].second, rows)));
    if (points.size() == 2) {
        const RigObject free = *freest(matrix, fast);
        report.findings.push_back(count_cases(fmt::format("{} is better at low rate and high stiffness ({}, {:g} Hz)",
                                                          matrix.motors[0], stiff->name, slowest),
                                              errors_of(points[0].first, rows), errors_of(points[0].second, rows)));
        report.findings.push_back(count_cases(fmt::format("{} is better at high rate ({}, {:g} Hz, ±{:g} mm)",
                                                          matrix.motors[1], free.name, fast, 700.0 * wide),
                                              errors_of(points[1].second, rows), errors_of(points[1].first, rows)));
    }
    for (const Lead& lead : leads)
        if (rows[lead.plain].fidelity.nrmse && rows[lead.led].fidelity.nrmse)
            report.leads.push_back(
                {rows[lead.plain].cell, *rows[lead.plain].fidelity.nrmse, *rows[lead.led].fidelity.nrmse});

    for (std::size_t i = 0; i < main_cells; ++i) {
        const RigCell& c = rows[i].cell;
        const bool is_stiff = stiff && c.object.name == stiff->name && c.rate == slowest && c.amplitude == gentle;
        const bool is_soft = soft && c.object.name == soft->name && c.rate == fast && c.amplitude == wide;
        const bool is_wall = c.object.kind == control::ObjectKind::wall && c.rate == slowest && c.amplitude == wide;
        if (is_stiff || is_soft || is_wall)
            report.examples.push_back(
                {fmt::format("{}: {}, {:g} Hz, ±{:g} mm", c.motor, c.object.name, c.rate, c.amplitude * 1e3), series[i],
                 c});
    }

    // Free motion: the weakest damper that keeps the loop well stable.
    const auto slow_cell = static_cast<std::size_t>(std::ranges::min_element(max_speeds) - max_speeds.begin());
    if (const double speed = max_speeds[slow_cell]; speed > 0.0) {
        const double expected = simulate::saturation_rate(speed, wide, simulate::RigSprings{}.at_finger(), 0.0);
        RigCell cell{rows[slow_cell].cell.motor,
                     {"free motion", control::ObjectKind::elastic, 0.0, 20.0},
                     expected,
                     wide,
                     {},
                     {}};
        double low = 0.5 * expected, high = 2.0 * expected;
        for (int halving = 0; halving < 12; ++halving) {
            cell.rate = 0.5 * (low + high);
            compile::AssetCache assets;
            const RigRow row = judge_rig_cell(cell, run_rig_cell(choice, nodes, cell, matrix.cycles, assets).series);
            (row.fidelity.saturated_share > 0.0 ? high : low) = cell.rate;
        }
        report.saturation_rate = 0.5 * (low + high);
        report.saturation_closed_form = expected;
    }
    return report;
}

RigReport study_rig_series(const std::vector<std::pair<RigCell, control::RigSeries>>& records) {
    RigReport report;
    for (const auto& [cell, series] : records) {
        report.rows.push_back(judge_rig_cell(cell, series));
        if (report.examples.size() < 6)
            report.examples.push_back({fmt::format("{}: {}, {:g} Hz, ±{:g} mm", cell.motor, cell.object.name, cell.rate,
                                                   cell.amplitude * 1e3),
                                       series, cell});
    }
    report.peak_cord_speed = simulate::peak_cord_speed(2.0 * largest_amplitude(report.rows), 1.0);
    // With two motors on the same springs the crossover can be determined.
    std::vector<std::string> motors;
    for (const RigRow& row : report.rows)
        if (std::ranges::find(motors, row.cell.motor) == motors.end()) motors.push_back(row.cell.motor);
    if (motors.size() != 2) return report;
    std::vector<std::pair<double, double>> tried;  // stiffness, amplitude
    for (const RigRow& row : report.rows) {
        const std::pair key{row.cell.object.stiffness, row.cell.amplitude};
        const bool spring = row.cell.object.kind == control::ObjectKind::elastic && row.cell.object.damping == 0.0;
        if (spring && std::ranges::find(tried, key) == tried.end()) tried.push_back(key);
    }
    for (const auto& [stiffness, amplitude] : tried) {
        std::vector<std::array<double, 3>> both;  // rate, error of each motor
        for (const RigRow& a : report.rows)
            for (const RigRow& b : report.rows)
                if (a.cell.motor == motors[0] && b.cell.motor == motors[1] && a.cell.rate == b.cell.rate &&
                    a.fidelity.nrmse && b.fidelity.nrmse && a.cell.object.stiffness == stiffness &&
                    b.cell.object.stiffness == stiffness && a.cell.object.damping == 0.0 &&
                    b.cell.object.damping == 0.0 && a.cell.amplitude == amplitude && b.cell.amplitude == amplitude)
                    both.push_back({a.cell.rate, *a.fidelity.nrmse, *b.fidelity.nrmse});
        if (both.size() < 2) continue;
        std::ranges::sort(both);
        std::vector<double> rates_tried;
        std::vector<std::vector<double>> slow(1), quick(1);
        for (const auto& [rate, first, second] : both) {
            rates_tried.push_back(rate);
            slow[0].push_back(first);
            quick[0].push_back(second);
        }
        report.crossover.push_back(find_crossover(rates_tried, stiffness, amplitude, slow, quick));
    }
    return report;
}

}  // namespace tactus::analysis
