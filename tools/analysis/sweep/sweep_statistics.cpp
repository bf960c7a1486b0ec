// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/sweep/sweep_statistics.hpp"

#include "dsp/core/error.hpp"
#include "dsp/statistics/distributions.hpp"
#include "dsp/statistics/paired.hpp"
#include "dsp/statistics/proportion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace tactus::analysis {

namespace {

using file::Json;
using sweep::FigureChoice;

std::optional<double> number_of(const sweep::Row& row, const std::string& name) {
    const Json* value = row.values.find(name);
    if (!value || value->is_null()) return {};
    if (value->is_boolean()) return value->get<bool>() ? 1.0 : 0.0;
    if (!value->is_number())
        throw Error(fmt::format("'{}' is '{}' and no number; keep a number of the step's JSON", name,
                                value->is_string() ? value->as_text() : value->dump()));
    return value->get<double>();
}

/// A value of a row, and what is subtracted from it; 0 for figures that subtract nothing.
struct PairedValue {
    double value = 0.0, minus = 0.0;
};

void summarise_difference_of_fractions(FigureCell& cell, const std::vector<PairedValue>& rows) {
    statistics::PairedOutcomes pairs;
    for (const PairedValue& row : rows)
        ++(row.value != 0.0   ? row.minus != 0.0 ? pairs.both : pairs.first_only
           : row.minus != 0.0 ? pairs.second_only
                              : pairs.neither);
    cell.value = (static_cast<double>(pairs.first_only) - static_cast<double>(pairs.second_only)) /
                 static_cast<double>(rows.size());
    cell.interval = statistics::paired_difference_interval(pairs);
}

void summarise(FigureCell& cell, const std::vector<PairedValue>& rows, const FigureChoice& choice) {
    const FigureChoice::Statistic statistic = choice.statistic;
    cell.count = rows.size();
    if (statistic == FigureChoice::Statistic::fraction && !choice.minus.empty()) {
        summarise_difference_of_fractions(cell, rows);
        return;
    }
    std::vector<double> values;
    for (const PairedValue& row : rows) values.push_back(row.value - row.minus);
    const double n = static_cast<double>(values.size());
    if (statistic == FigureChoice::Statistic::fraction) {
        const auto hits = static_cast<std::size_t>(std::ranges::count_if(values, [](double v) { return v != 0.0; }));
        cell.value = static_cast<double>(hits) / n;
        cell.interval = statistics::wilson_interval(hits, values.size());
        return;
    }
    if (statistic == FigureChoice::Statistic::median) {
        std::ranges::sort(values);
        const std::size_t middle = values.size() / 2;
        cell.value = values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
        cell.interval = median_interval(values);
        return;
    }
    const statistics::Moments moments = statistics::moments(values);
    cell.value = moments.mean;
    if (values.size() < 2) return;
    const double half = statistics::student_quantile(0.975, n - 1.0) * moments.deviation / std::sqrt(n);
    cell.interval = {moments.mean - half, moments.mean + half};
}

}  // namespace

std::optional<std::pair<double, double>> median_interval(const std::vector<double>& sorted) {
    const std::size_t n = sorted.size();
    // Number of values that may be left out on each side: P(at most so many are below the median) ≤ 2.5 %, binomial with
    // p = 1/2.
    std::size_t outside = 0;
    if (n > 1000) {
        // The powers below underflow; the normal approximation is exact to a rank here.
        const auto count = static_cast<double>(n);
        outside = static_cast<std::size_t>(0.5 * count - 0.98 * std::sqrt(count));
    } else {
        double probability = std::exp2(-static_cast<double>(n)), sum = 0.0;
        for (; sum + probability <= 0.025; ++outside) {
            sum += probability;
            probability *= static_cast<double>(n - outside) / static_cast<double>(outside + 1);
        }
    }
    if (outside == 0) return {};
    return std::pair(sorted[outside - 1], sorted[n - outside]);
}

FigureData figure_data(const Results& results, const FigureChoice& choice) {
    const sweep::Sweep& sweep = results.folder().sweep();
    if (const std::string problem = sweep::figure_problem(sweep, choice); !problem.empty()) throw Error(problem);
    FigureData data;
    data.choice = choice;
    const std::array<std::pair<const std::string*, const sweep::Axis**>, 4> named{
        {{&choice.panel, &data.panel}, {&choice.series, &data.series}, {&choice.y, &data.y}, {&choice.x, &data.x}}};
    std::array<std::optional<std::size_t>, 4> places;
    for (std::size_t i = 0; i < named.size(); ++i) {
        if (named[i].first->empty()) continue;
        const sweep::Axis* axis = sweep.find_axis(*named[i].first);
        const std::size_t max_levels = i < 2 ? 24 : 10'000;
        if (axis->kind == sweep::Axis::Kind::design)
            throw Error(
                fmt::format("the axis '{}' is drawn at random: every level occurs once. Plot results.csv with a "
                            "scatter diagram",
                            axis->name));
        if (axis->levels.size() > max_levels)
            throw Error(fmt::format("the axis '{}' has {} levels; a figure shows at most {} there", axis->name,
                                    axis->levels.size(), max_levels));
        *named[i].second = axis;
        places[i] = static_cast<std::size_t>(axis - sweep.axes.data());
    }
    using Key = std::array<std::size_t, 5>;  // panel, series, column, y, x
    constexpr std::array<std::size_t, 4> at_key{0, 1, 3, 4};
    std::map<Key, std::vector<PairedValue>> groups;
    for (std::size_t index = 0; index < results.size(); ++index) {
        if (results.state(index) != Results::State::done) continue;
        const sweep::Row row = results.row(index);
        const bool is_excluded = !choice.unless.empty() && number_of(row, choice.unless).value_or(0.0) != 0.0;
        const sweep::Point point = results.folder().tasks().point(index);
        Key key{};
        for (std::size_t i = 0; i < places.size(); ++i)
            if (places[i]) key[at_key[i]] = point.levels[*places[i]];
        for (std::size_t column = 0; column < choice.values.size(); ++column) {
            const std::optional<double> value = number_of(row, choice.values[column]),
                                        minus = choice.minus.empty() ? std::optional(0.0)
                                                                     : number_of(row, choice.minus[column]);
            if (is_excluded || !value || !minus || !std::isfinite(*value - *minus)) {
                ++data.left_out;
                continue;
            }
            key[2] = column;
            groups[key].push_back({*value, *minus});
        }
    }
    for (const auto& [key, rows] : groups) {
        FigureCell cell;
        cell.panel = key[0];
        cell.series = key[1];
        cell.column = key[2];
        cell.y = key[3];
        cell.x = key[4];
        summarise(cell, rows, choice);
        data.cells.push_back(cell);
    }
    return data;
}

}  // namespace tactus::analysis
