// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/regularise.hpp"

#include "dsp/core/error.hpp"
#include "dsp/geometry/spline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

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

/// The step of the clock itself: the largest length of which all steps are whole multiples. 0 if there is none above a
/// thousandth of the mean step, or if nothing shows it.
double clock_step(std::span<const double> times) {
    const double least = 1e-3 * (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    // Times are rounded to the digits of a double.
    const double error = std::max(1e-4 * least, 8e-16 * std::max(std::abs(times.front()), std::abs(times.back())));
    double common = 0.0;
    for (std::size_t i = 1; i < times.size(); ++i) {
        double a = common, b = times[i] - times[i - 1];
        while (b > 2.0 * error) {
            if (a == 0.0) {
                a = b;
                break;
            }
            const double rest = std::abs(a - b * std::round(a / b));
            a = b, b = rest;
            if (a < least) return 0.0;
        }
        common = a;
    }
    return common;
}

/// Times of an even sampling that a coarse clock rounded to its own steps: a line explains them within one step. Returns
/// the times on that line, piece by piece between gaps; none if the steps themselves are uneven, or if the clock is so
/// fine that its rounding does not matter.
std::optional<std::vector<double>> without_rounding(std::span<const double> times) {
    const double step = clock_step(times);
    const double mean = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    if (step < 0.01 * mean) return std::nullopt;
    std::vector<double> steps;
    std::map<long, std::size_t> counts;  // steps by their length in steps of the clock
    for (std::size_t i = 1; i < times.size(); ++i) {
        const double length = times[i] - times[i - 1];
        ++counts[std::lround(std::min(length / step, 1e6))];
        if (length > 0.0) steps.push_back(length);
    }
    // Even times in which a few samples are missing: the other steps are multiples of the usual one. Rounding makes steps
    // that differ by one.
    const auto usual = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
    std::size_t multiples = 0;
    for (const auto& [length, count] : counts)
        if (usual->first > 0 && length > usual->first && length % usual->first == 0) multiples += count;
    if (20 * usual->second > 19 * (times.size() - 1) && usual->second + multiples == times.size() - 1)
        return std::nullopt;
    // A clock whose step divides the mean step rounds all samples alike: other steps are jitter of the samples.
    const double drift = std::abs(mean / step - std::round(mean / step)) * static_cast<double>(times.size() - 1);
    if (drift < 2.0 && usual->second + 8 < times.size() - 1) return std::nullopt;
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
    const double gap = 5.0 * steps[steps.size() / 2];
    std::vector<double> even(times.begin(), times.end());
    bool is_changed = false;
    for (std::size_t first = 0; first < times.size();) {
        std::size_t end = first + 1;
        while (end < times.size() && times[end] - times[end - 1] <= gap) ++end;
        if (end - first < 8) {
            first = end;
            continue;
        }
        const auto count = static_cast<double>(end - first);
        double sum = 0.0, moment = 0.0;
        const double middle = 0.5 * (count - 1.0);
        for (std::size_t i = first; i < end; ++i) {
            const double time = times[i] - times[first], place = static_cast<double>(i - first) - middle;
            sum += time, moment += place * time;
        }
        const double slope = moment / (count * (count * count - 1.0) / 12.0), mean_time = sum / count;
        double low = 0.0, high = 0.0;
        for (std::size_t i = first; i < end; ++i) {
            const double line = mean_time + slope * (static_cast<double>(i - first) - middle);
            const double off = times[i] - times[first] - line;
            low = std::min(low, off), high = std::max(high, off);
        }
        // Rounding, up, down or to the nearest, moves a time by less than one step; the fitted line lies within it.
        if (high - low > 1.2 * step) return std::nullopt;
        is_changed = true;
        for (std::size_t i = first; i < end; ++i)
            even[i] = times[first] + mean_time + slope * (static_cast<double>(i - first) - middle);
        first = end;
    }
    if (!is_changed) return std::nullopt;
    return even;
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
    const std::optional<std::vector<double>> unrounded = without_rounding(times);
    const std::vector<double> spread = unrounded ? *unrounded : spread_equal_times(times);
    std::vector<double> steps;
    for (std::size_t i = 1; i < spread.size(); ++i) steps.push_back(spread[i] - spread[i - 1]);
    std::vector<double> sorted = steps;
    std::sort(sorted.begin(), sorted.end());
    const double gap = 5.0 * sorted[sorted.size() / 2];

    EvenRecord even;
    if (unrounded) even.clock_step = clock_step(times);
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
