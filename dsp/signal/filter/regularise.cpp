// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/regularise.hpp"

#include "dsp/core/error.hpp"
#include "dsp/geometry/spline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::signal {

namespace {

/// A clock coarser than the samples gives several samples the same time.
std::vector<double> spread_equal_times(std::span<const double> times) {
    std::vector<double> spread(times.begin(), times.end());
    for (std::size_t i = 0; i < spread.size();) {
        std::size_t end = i + 1;
        while (end < times.size() && times[end] == times[i]) ++end;
        // The last run has no next time: its samples keep the step of the previous run.
        const std::size_t before = i > 0 ? i - 1 : 0;
        const double step =
            end < times.size() ? (times[end] - times[i]) / static_cast<double>(end - i) : spread[i] - spread[before];
        for (std::size_t j = i + 1; j < end; ++j) spread[j] = spread[j - 1] + step;
        i = end;
    }
    return spread;
}

}  // namespace

EvenRecord regularise(std::span<const double> times, std::span<const std::vector<double>> channels) {
    if (times.size() < 4) throw Error(fmt::format("there are {} samples; a spectrum needs at least 4", times.size()));
    for (std::size_t i = 1; i < times.size(); ++i)
        if (!(times[i] >= times[i - 1])) throw Error(fmt::format("time runs backwards at sample {}", i + 1));
    if (!(times.back() > times.front())) throw Error("time stands still: every sample has the same time");
    const std::vector<double> spread = spread_equal_times(times);
    std::vector<double> steps;
    for (std::size_t i = 1; i < spread.size(); ++i) steps.push_back(spread[i] - spread[i - 1]);
    std::vector<double> sorted = steps;
    std::sort(sorted.begin(), sorted.end());
    const double gap = 5.0 * sorted[sorted.size() / 2];

    EvenRecord even;
    double present = 0.0;
    for (const double step : steps) {
        if (step > gap) {
            ++even.gaps;
            even.lost += step;
        } else {
            present += step;
            even.longest_step = std::max(even.longest_step, step);
        }
    }
    even.shortest_step = sorted.front();
    const std::size_t counted = steps.size() - even.gaps;
    if (!(present > 0.0)) throw Error("time stands still: no two samples follow each other");
    even.rate = static_cast<double>(counted) / present;
    even.usable =
        0.5 / std::max(sorted[static_cast<std::size_t>(0.99 * static_cast<double>(counted - 1))], 1.0 / even.rate);
    for (std::size_t first = 0; first < spread.size();) {
        std::size_t end = first + 1;
        while (end < spread.size() && steps[end - 1] <= gap) ++end;
        if (end - first >= 4) {
            const double length = spread[end - 1] - spread[first];
            const auto count = static_cast<std::size_t>(std::floor(length * even.rate * (1.0 + 1e-12))) + 1;
            std::vector<std::vector<double>>& piece = even.pieces.emplace_back();
            for (const std::vector<double>& values : channels) {
                const auto from = static_cast<std::ptrdiff_t>(first), to = static_cast<std::ptrdiff_t>(end);
                const geometry::Spline curve({spread.begin() + from, spread.begin() + to},
                                             {values.begin() + from, values.begin() + to});
                std::vector<double>& out = piece.emplace_back(count);
                for (std::size_t i = 0; i < count; ++i)
                    out[i] = curve(spread[first] + static_cast<double>(i) / even.rate).value;
            }
        }
        first = end;
    }
    if (even.pieces.empty()) throw Error("no four samples follow each other without a gap");
    return even;
}

}  // namespace tactus::signal
