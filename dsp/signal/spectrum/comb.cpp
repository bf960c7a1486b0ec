// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/comb.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace tactus::signal {

namespace {

constexpr int most_teeth = 10;

struct Weighted {
    double frequency, weight;
};

/// Least-squares fit of the teeth to nearby lines, weighted by amplitude (strongest first); twice, as the far teeth
/// move.
CombFit fit(std::span<const Weighted> lines, double frequency, double df) {
    CombFit comb{frequency, 0.0, 0.0};
    double total = 0.0, explained = 0.0, chance = 0.0;
    double teeth[most_teeth + 1] = {};
    for (int round = 0; round < 2; ++round) {
        double products = 0.0, squares = 0.0;
        total = explained = chance = 0.0;
        std::fill(std::begin(teeth), std::end(teeth), 0.0);
        for (const Weighted& line : lines) {
            const double order = std::round(line.frequency / comb.frequency);
            const double reach = std::min(0.75 * df + 0.004 * line.frequency, 0.25 * comb.frequency);
            total += line.weight;
            chance += line.weight * std::min(1.0, 2.0 * reach / comb.frequency);
            if (order < 1.0 || std::abs(line.frequency - order * comb.frequency) > reach) continue;
            explained += line.weight;
            products += line.weight * order * line.frequency;
            squares += line.weight * order * order;
            if (order <= most_teeth) teeth[static_cast<int>(order)] += line.weight;
        }
        if (squares > 0.0) comb.frequency = products / squares;
    }
    chance /= std::max(total, 1e-30);
    comb.explained = std::max(0.0, (explained / std::max(total, 1e-30) - chance) / std::max(1.0 - chance, 1e-3));
    int last = 0;
    for (int i = 1; i <= most_teeth; ++i)
        if (teeth[i] > 0.0) last = i;
    // A tooth within 30 dB of the strongest line is present; a much weaker one is an accident.
    const double whole = 0.03 * lines.front().weight;
    double there = 0.0, wanted = 0.0;
    for (int i = 1; i <= last; ++i) {
        // A missing low tooth costs more than a missing high one.
        const double weight = 1.0 / std::sqrt(i);
        wanted += weight;
        there += weight * std::min(1.0, teeth[i] / whole);
    }
    comb.complete = wanted > 0.0 ? there / wanted : 0.0;
    return comb;
}

/// The strongest lines, by amplitude: they dominate what is felt and the error of the rate; the weakest of many are
/// clutter.
struct StrongestLines {
    static constexpr std::size_t most = 24;

    std::array<Weighted, most> lines;
    std::size_t count = 0;

    void add(const Weighted& line) noexcept {
        const auto heavier = [](const Weighted& a, const Weighted& b) { return a.weight > b.weight; };
        Weighted* const end = lines.data() + count;
        Weighted* const place = std::upper_bound(lines.data(), end, line, heavier);
        if (place == lines.data() + most) return;
        Weighted* const last = count < most ? lines.data() + count++ : end - 1;
        std::move_backward(place, last, last + 1);
        *place = line;
    }
    std::span<const Weighted> worth_fitting() const noexcept {
        std::size_t kept = count;
        while (kept > 0 && lines[kept - 1].weight < 1e-3 * lines[0].weight) --kept;
        return {lines.data(), kept};
    }
};

}  // namespace

Comb fit_comb(const Spectrum& spectrum, double lowest, double highest) noexcept {
    Comb out;
    const double top = std::min(most_teeth * highest, spectrum.df * static_cast<double>(spectrum.power.size()));
    StrongestLines strongest;
    each_line(spectrum, std::max(0.7 * lowest, 3.0 * spectrum.df), top, 8.0,
              [&](const SpectralLine& line) { strongest.add({line.frequency, std::sqrt(line.power)}); });
    const std::span<const Weighted> lines = strongest.worth_fitting();
    std::array<CombFit, StrongestLines::most * most_teeth> fits;
    std::size_t count = 0;
    for (const Weighted& line : lines)
        for (int order = 1; order <= most_teeth; ++order) {
            const double frequency = line.frequency / order;
            if (frequency < lowest || frequency > highest) continue;
            const CombFit one = fit(lines, frequency, spectrum.df);
            if (one.frequency >= lowest && one.frequency <= highest && one.score() > 0.0) fits[count++] = one;
        }
    if (count == 0) return out;
    const std::span<CombFit> found(fits.data(), count);
    std::sort(found.begin(), found.end(), [](const CombFit& a, const CombFit& b) {
        return a.score() != b.score() ? a.score() > b.score() : a.frequency > b.frequency;
    });
    out.best = found.front();
    for (const CombFit& one : found) {
        const auto near = [&](const CombFit& other) { return std::abs(one.frequency / other.frequency - 1.0) < 0.02; };
        if (near(out.best) || std::ranges::any_of(out.others(), near)) continue;
        if (out.rival_count < Comb::most_rivals) out.rivals[out.rival_count++] = one;
    }
    const double rival = out.rival_count == 0 ? 0.0 : out.rivals.front().score() / out.best.score();
    out.confidence = std::clamp(out.best.score() * (1.0 - 0.5 * rival), 0.0, 1.0);
    return out;
}

}  // namespace tactus::signal
