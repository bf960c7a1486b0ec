// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/regularise.hpp"

#include "dsp/core/error.hpp"
#include "dsp/geometry/spline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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

/// Band-limited interpolation between even values: sinc with a Kaiser window of 16 zero crossings to each side.
class Interpolation {
public:
    Interpolation() {
        const auto bessel = [](double x) {
            double sum = 1.0, term = 1.0;
            for (int k = 1; k < 40; ++k) term *= 0.25 * x * x / (k * k), sum += term;
            return sum;
        };
        for (std::size_t i = 0; i < table_.size(); ++i) {
            const double u = static_cast<double>(i) / per_step, share = u / reach, angle = std::numbers::pi * u;
            const double window = share < 1.0 ? bessel(7.0 * std::sqrt(1.0 - share * share)) / bessel(7.0) : 0.0;
            table_[i] = window * (i == 0 ? 1.0 : std::sin(angle) / angle);
        }
    }
    /// Calls use(index, weight) for the values around `place`.
    template <class Use>
    void at(double place, std::size_t size, const Use& use) const {
        const double from = std::max(0.0, std::ceil(place - reach + 1e-9));
        const double to = std::min(static_cast<double>(size) - 1.0, std::floor(place + reach - 1e-9));
        for (double n = from; n <= to; ++n) {
            const double u = std::abs(place - n) * per_step;
            const auto i = static_cast<std::size_t>(u);
            const double share = u - static_cast<double>(i);
            use(static_cast<std::size_t>(n), (1.0 - share) * table_[i] + share * table_[i + 1]);
        }
    }

private:
    static constexpr double reach = 16.0, per_step = 512.0;
    std::vector<double> table_ = std::vector<double>(static_cast<std::size_t>(reach * per_step) + 2);
};

/// Makes even values fit the uneven samples better than a spline does near half the rate: three steps of conjugate
/// gradients towards the least squares of the band-limited interpolation. More would follow the noise of the times.
void fit_samples(std::span<const double> places, std::span<const double> values, std::vector<double>& even) {
    static const Interpolation interpolation;
    const std::size_t size = even.size();
    const auto residual_of = [&](const std::vector<double>& x, std::size_t i) {
        double sum = 0.0;
        interpolation.at(places[i], size, [&](std::size_t n, double weight) { sum += weight * x[n]; });
        return sum;
    };
    const auto back = [&](const std::vector<double>& rest) {
        std::vector<double> out(size);
        for (std::size_t i = 0; i < rest.size(); ++i)
            interpolation.at(places[i], size, [&](std::size_t n, double weight) { out[n] += weight * rest[i]; });
        return out;
    };
    const auto square = [](const std::vector<double>& x) {
        double sum = 0.0;
        for (const double v : x) sum += v * v;
        return sum;
    };
    // Near the ends the kernel lacks values on one side.
    std::vector<double> rest(places.size()), moved(places.size());
    const auto is_inside = [&](double place) { return place >= 16.0 && place <= static_cast<double>(size) - 17.0; };
    for (std::size_t i = 0; i < places.size(); ++i)
        rest[i] = is_inside(places[i]) ? values[i] - residual_of(even, i) : 0.0;
    std::vector<double> slope = back(rest), step = slope;
    double steep = square(slope);
    for (int round = 0; round < 3 && steep > 0.0; ++round) {
        for (std::size_t i = 0; i < places.size(); ++i) moved[i] = is_inside(places[i]) ? residual_of(step, i) : 0.0;
        const double length = square(moved);
        if (!(length > 0.0)) return;
        const double share = steep / length;
        for (std::size_t n = 0; n < size; ++n) even[n] += share * step[n];
        for (std::size_t i = 0; i < places.size(); ++i) rest[i] -= share * moved[i];
        slope = back(rest);
        const double next = square(slope);
        for (std::size_t n = 0; n < size; ++n) step[n] = slope[n] + next / steep * step[n];
        steep = next;
    }
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
                std::vector<double> places;
                for (std::size_t i = first; i < end; ++i) places.push_back((spread[i] - spread[first]) * even.rate);
                fit_samples(places, std::span(values).subspan(first, end - first), out);
            }
        }
        first = end;
    }
    if (even.pieces.empty()) throw Error("no four samples follow each other without a gap");
    return even;
}

}  // namespace tactus::signal
