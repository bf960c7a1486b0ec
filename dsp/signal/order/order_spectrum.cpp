// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/order/order_spectrum.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/spectrum/welch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::signal {

namespace {

/// Tabulated sinc(u) with a Blackman window of 16 zero crossings on each side.
class Kernel {
public:
    static constexpr double reach = 16.0;

    Kernel() : table_(static_cast<std::size_t>(reach) * per_crossing + 2) {
        for (std::size_t i = 0; i < table_.size(); ++i) {
            const double u = static_cast<double>(i) / per_crossing, phase = std::numbers::pi * u / reach;
            const double window = u < reach ? 0.42 + 0.5 * std::cos(phase) + 0.08 * std::cos(2.0 * phase) : 0.0;
            const double angle = std::numbers::pi * u;
            table_[i] = window * (angle < 1e-9 ? 1.0 : std::sin(angle) / angle);
        }
    }
    double operator()(double u) const noexcept {
        const double at = std::min(std::abs(u), reach) * per_crossing;
        const auto i = static_cast<std::size_t>(at);
        return table_[i] + (at - static_cast<double>(i)) * (table_[i + 1] - table_[i]);
    }

private:
    static constexpr std::size_t per_crossing = 1024;
    std::vector<double> table_;
};

}  // namespace

std::vector<double> resample_over_angle(std::span<const double> record, double rate, const Rotation& rotation,
                                        std::size_t per_turn) {
    const Kernel kernel;
    std::vector<double> out;
    const auto last = static_cast<double>(record.size());
    const double first_turn = std::ceil(rotation.first()), turns = std::floor(rotation.last() - first_turn);
    const auto count = static_cast<std::size_t>(std::max(0.0, turns) * static_cast<double>(per_turn));
    for (std::size_t j = 0; j < count; ++j) {
        const auto [time, period] = rotation(first_turn + static_cast<double>(j) / static_cast<double>(per_turn));
        // The kernel's zero crossings are at the samples, or at the new spacing when that is wider.
        const double spacing = std::max(1.0, rate * period / static_cast<double>(per_turn)), place = time * rate;
        const double from = std::max(0.0, std::ceil(place - Kernel::reach * spacing));
        const double to = std::min(last - 1.0, std::floor(place + Kernel::reach * spacing));
        double sum = 0.0, weights = 0.0;
        for (double n = from; n <= to; ++n) {
            const double weight = kernel((n - place) / spacing);
            sum += weight * record[static_cast<std::size_t>(n)];
            weights += weight;
        }
        out.push_back(weights > 0.0 ? sum / weights : 0.0);
    }
    return out;
}

OrderSpectrum order_spectrum(std::span<const double> record, double rate, const Rotation& rotation, int highest) {
    const auto per_turn = static_cast<std::size_t>(std::ceil(2.56 * highest));
    const std::vector<double> turned = resample_over_angle(record, rate, rotation, per_turn);
    const std::size_t turns = turned.size() / per_turn;
    if (turns < 8) throw Error(fmt::format("the record holds {} whole turns; order analysis needs at least 8", turns));
    const std::size_t together = std::min<std::size_t>(32, turns >= 32 ? 32 : turns);
    WelchSettings settings;
    settings.rate = static_cast<double>(per_turn);
    settings.segment = together * per_turn;
    settings.overlap = settings.segment * 3 / 4;
    settings.window = WindowKind::flat_top;
    settings.scaling = Scaling::spectrum;
    const Spectrum spectrum = welch<double>(turned, settings);
    OrderSpectrum out;
    out.step = spectrum.df;
    out.segments = spectrum.segments;
    out.turns = static_cast<double>(turns);
    for (const double p : spectrum.power) out.amplitude.push_back(std::sqrt(2.0 * p));
    for (int order = 1; order <= highest; ++order) {
        const std::size_t bin = static_cast<std::size_t>(order) * together;
        if (bin >= out.amplitude.size()) break;
        // Flat-top lines are five bins wide on each side; the noise floor is read half-way to the neighbouring orders.
        std::vector<double> around;
        for (std::size_t k = bin - together / 2 - 1; k <= bin - together / 2 + 1; ++k)
            around.push_back(out.amplitude[k]);
        for (std::size_t k = bin + together / 2 - 1; k <= bin + together / 2 + 1 && k < out.amplitude.size(); ++k)
            around.push_back(out.amplitude[k]);
        std::nth_element(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2), around.end());
        const double floor = around[around.size() / 2], amplitude = out.amplitude[bin];
        const double snr = amplitude > 0.0 ? 20.0 * std::log10(amplitude / std::max(floor, 1e-10 * amplitude)) : 0.0;
        out.orders.push_back({static_cast<double>(order), amplitude, snr});
    }
    return out;
}

}  // namespace tactus::signal
