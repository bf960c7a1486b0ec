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

/// Distribution-free interval of a median: the widest pair of order statistics that leaves at most 2.5 % on each side.
std::pair<double, double> median_interval(const std::vector<double>& sorted) {
    const std::size_t n = sorted.size();
    // P(at most k of n below the median), binomial with p = 1/2.
    double probability = std::exp2(-static_cast<double>(n)), sum = 0.0;
    std::size_t k = 0;
    for (; k < n / 2; ++k) {
        if (sum + probability > 0.025) break;
        sum += probability;
        probability *= static_cast<double>(n - k) / static_cast<double>(k + 1);
    }
    if (n > 1000) {
        // The power above underflows; the normal approximation is exact to a rank here.
        const double half = 0.5 * static_cast<double>(n) - 0.98 * std::sqrt(static_cast<double>(n));
        k = static_cast<std::size_t>(std::max(1.0, std::floor(half)));
    }
    const std::size_t low = k > 0 ? k - 1 : 0;
    return {sorted[low], sorted[n - 1 - low]};
}

void summarise(FigureCell& cell, std::vector<double>& values, FigureChoice::Statistic statistic) {
    cell.count = values.size();
    const double n = static_cast<double>(values.size());
    if (statistic == FigureChoice::Statistic::fraction) {
        const auto hits = static_cast<std::size_t>(std::ranges::count_if(values, [](double v) { return v != 0.0; }));
        cell.value = static_cast<double>(hits) / n;
        std::tie(cell.low, cell.high) = statistics::wilson_interval(hits, values.size());
        return;
    }
    if (statistic == FigureChoice::Statistic::median) {
        std::ranges::sort(values);
        const std::size_t middle = values.size() / 2;
        cell.value = values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
        std::tie(cell.low, cell.high) = median_interval(values);
        return;
    }
    const statistics::Moments moments = statistics::moments(values);
    cell.value = cell.low = cell.high = moments.mean;
    if (values.size() < 2) return;
    const double half = statistics::student_quantile(0.975, n - 1.0) * moments.deviation / std::sqrt(n);
    cell.low -= half;
    cell.high += half;
}

}  // namespace

FigureData figure_data(const Results& results, const FigureChoice& choice) {
    const sweep::Sweep& sweep = results.folder().sweep();
    FigureData data;
    data.choice = choice;
    const std::array<std::pair<const std::string*, const sweep::Axis**>, 4> named{
        {{&choice.panel, &data.panel}, {&choice.series, &data.series}, {&choice.y, &data.y}, {&choice.x, &data.x}}};
    std::array<std::optional<std::size_t>, 4> places;
    for (std::size_t i = 0; i < named.size(); ++i) {
        if (named[i].first->empty()) continue;
        const sweep::Axis* axis = sweep.find_axis(*named[i].first);
        if (!axis) throw Error(fmt::format("the sweep has no axis '{}'", *named[i].first));
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
    std::map<std::array<std::size_t, 4>, std::vector<double>> groups;
    for (std::size_t index = 0; index < results.size(); ++index) {
        if (results.state(index) != Results::State::done) continue;
        const sweep::Row row = results.row(index);
        std::optional<double> value = number_of(row, choice.value);
        if (!choice.minus.empty()) {
            const std::optional<double> minus = number_of(row, choice.minus);
            value = value && minus ? std::optional(*value - *minus) : std::nullopt;
        }
        if (!choice.unless.empty() && number_of(row, choice.unless).value_or(0.0) != 0.0) value.reset();
        if (!value || !std::isfinite(*value)) {
            ++data.left_out;
            continue;
        }
        const sweep::Point point = results.folder().tasks().point(index);
        std::array<std::size_t, 4> key{};
        for (std::size_t i = 0; i < key.size(); ++i)
            if (places[i]) key[i] = point.levels[*places[i]];
        groups[key].push_back(*value);
    }
    for (auto& [key, values] : groups) {
        FigureCell cell;
        cell.panel = key[0];
        cell.series = key[1];
        cell.y = key[2];
        cell.x = key[3];
        summarise(cell, values, choice.statistic);
        data.cells.push_back(cell);
    }
    return data;
}

}  // namespace tactus::analysis
