// SPDX-License-Identifier: Apache-2.0
#include "dsp/spectrum/line_match.hpp"

#include "dsp/spectrum/similarity.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus {

namespace {

constexpr double least_snr_db = 10.0, deepest_db = 60.0, missing_db = 6.0, order_snr_db = 6.0;
constexpr double lowest_rate = 60.0, highest_rate = 400.0;  // Hz
constexpr int fewest_orders = 2, most_orders = 10;

double decibel(double power_ratio) { return 10.0 * std::log10(std::max(power_ratio, 1e-30)); }

/// Median power of the bins 4 to 16 away on both sides.
double neighbourhood(const std::vector<double>& power, std::size_t bin) {
    std::vector<double> around;
    for (std::size_t away = 4; away <= 16; ++away) {
        if (bin >= away + 1) around.push_back(power[bin - away]);
        if (bin + away < power.size()) around.push_back(power[bin + away]);
    }
    if (around.empty()) return 0.0;
    const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
    std::nth_element(around.begin(), middle, around.end());
    return *middle;
}

/// Where the line around the highest bin lies and how high it is, from the ratio of the two highest bins (Hann window).
Line line_at(const Spectrum& density, std::size_t bin) {
    const std::vector<double>& p = density.power;
    const bool right = p[bin + 1] > p[bin - 1];
    const double ratio = std::sqrt(std::max(p[right ? bin + 1 : bin - 1], 0.0) / p[bin]);
    const double shift = std::clamp((2.0 * ratio - 1.0) / (ratio + 1.0), 0.0, 0.5);
    const double x = std::numbers::pi * shift;
    const double scallop = shift > 1e-9 ? x * (1.0 - shift * shift) / std::sin(x) : 1.0;
    const double amplitude = std::sqrt(2.0 * p[bin] * density.noise_bandwidth) * scallop;
    Line line;
    line.hz = (static_cast<double>(bin) + (right ? shift : -shift)) * density.df;
    line.db = 20.0 * std::log10(std::max(amplitude, 1e-30));
    line.snr_db = std::min(200.0, decibel(p[bin] / std::max(neighbourhood(p, bin), 1e-30)));
    return line;
}

double tolerance(const Spectrum& density, double hz) { return std::max(0.003 * hz, 2.0 * density.df); }

const Line* nearest(const std::vector<Line>& lines, double hz, double within) {
    const Line* best = nullptr;
    for (const Line& line : lines)
        if (std::abs(line.hz - hz) <= within && (!best || std::abs(line.hz - hz) < std::abs(best->hz - hz)))
            best = &line;
    return best;
}

/// Power of an order: within a hundredth of its frequency, at least three bins to each side.
double order_power(const Spectrum& density, double hz) {
    const double reach = std::max(0.01 * hz, 3.0 * density.df);
    return band_power(density.power, density.df, hz - reach, hz + reach);
}

/// Level of the spectrum around a frequency as if it were one line, dB of amplitude.
double level_near(const Spectrum& density, double hz) {
    const double within = tolerance(density, hz);
    return decibel(2.0 * band_power(density.power, density.df, hz - within, hz + within));
}

}  // namespace

std::vector<Line> find_lines(const Spectrum& density, double lowest, double highest) {
    std::vector<Line> lines;
    double strongest = -1e9;
    const std::vector<double>& p = density.power;
    for (std::size_t k = 1; k + 1 < p.size(); ++k) {
        const double f = density.frequency(k);
        if (f < lowest || f > highest || p[k] <= p[k - 1] || p[k] < p[k + 1] || !(p[k] > 0.0)) continue;
        const Line line = line_at(density, k);
        if (line.snr_db < least_snr_db) continue;
        lines.push_back(line);
        strongest = std::max(strongest, line.db);
    }
    std::erase_if(lines, [&](const Line& line) { return line.db < strongest - deepest_db; });
    return lines;
}

double fundamental_of(const std::vector<Line>& lines, double highest) {
    double strongest = -1e9;
    for (const Line& line : lines) strongest = std::max(strongest, line.db);
    // How far the orders of a rate rise above −60 dB of the strongest line, on average.
    const auto strength = [&](double rate, double& refined) {
        double sum = 0.0, weights = 0.0, places = 0.0;
        const int orders = std::min(most_orders, static_cast<int>(highest / rate));
        int found = 0;
        for (int k = 1; k <= orders; ++k) {
            const Line* line = nearest(lines, k * rate, std::max(0.01 * rate, 1.5));
            if (!line) continue;
            ++found;
            const double height = line->db - strongest + deepest_db;
            sum += height;
            weights += height * k;
            places += height * k * line->hz / k;
        }
        if (found < fewest_orders) return 0.0;
        refined = places / weights;
        return sum / orders;
    };
    struct Candidate {
        double rate, strength;
    };
    std::vector<Candidate> candidates;
    double best = 0.0;
    for (const Line& line : lines)
        for (int k = 1; k <= 4; ++k) {
            double refined = line.hz / k;
            if (refined < lowest_rate || refined > highest_rate) continue;
            const double value = strength(refined, refined);
            if (value > 0.0) candidates.push_back({refined, value});
            best = std::max(best, value);
        }
    double lowest = 0.0;
    for (const Candidate& candidate : candidates)
        if (candidate.strength >= 0.8 * best && (lowest == 0.0 || candidate.rate < lowest)) lowest = candidate.rate;
    return lowest;
}

std::optional<double> harmonic_error(const Spectrum& reference, double reference_hz, const Spectrum& output,
                                     double output_hz, double highest) {
    if (!(reference_hz > 0.0 && output_hz > 0.0)) return std::nullopt;
    std::vector<double> differences;
    for (int k = 1; k <= most_orders && k * reference_hz <= highest; ++k) {
        const auto bin = static_cast<std::size_t>(std::llround(k * reference_hz / reference.df));
        if (bin < 1 || bin + 1 >= reference.power.size()) break;
        const double top = std::max({reference.power[bin - 1], reference.power[bin], reference.power[bin + 1]});
        if (decibel(top / std::max(neighbourhood(reference.power, bin), 1e-30)) < order_snr_db) continue;
        differences.push_back(decibel(std::max(order_power(output, k * output_hz), 1e-30) /
                                      std::max(order_power(reference, k * reference_hz), 1e-30)));
    }
    if (differences.size() < fewest_orders) return std::nullopt;
    double mean = 0.0, worst = 0.0;
    for (const double difference : differences) mean += difference / static_cast<double>(differences.size());
    for (const double difference : differences) worst = std::max(worst, std::abs(difference - mean));
    return worst;
}

MatchedLines match_lines(const Spectrum& reference, const Spectrum& output, double gain, double speed_ratio,
                         double lowest, double highest) {
    const std::vector<Line> r = find_lines(reference, lowest, highest), d = find_lines(output, lowest, highest);
    const double gain_db = 20.0 * std::log10(gain);
    MatchedLines matched;
    for (const Line& line : r) {
        const double within = tolerance(reference, line.hz), moved = line.hz * speed_ratio;
        if (nearest(d, line.hz, within) || nearest(d, moved, within)) matched.in_both.push_back(line);
        else if (std::max(level_near(output, line.hz), level_near(output, moved)) + gain_db < line.db - missing_db)
            matched.only_in_reference.push_back(line);
    }
    for (const Line& line : d) {
        const double within = tolerance(output, line.hz), moved = line.hz / speed_ratio;
        if (nearest(r, line.hz, within) || nearest(r, moved, within)) continue;
        if (std::max(level_near(reference, line.hz), level_near(reference, moved)) < line.db + gain_db - missing_db)
            matched.only_in_output.push_back(line);
    }
    return matched;
}

}  // namespace tactus
