// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/order/order_spectrum.hpp"

#include "dsp/core/error.hpp"

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

OrderStream::OrderStream(double rate, std::size_t frames, const Rotation& rotation, int highest)
    : rate_(rate),
      first_turn_(std::ceil(rotation.first())),
      rotation_(rotation),
      frames_(frames),
      per_turn_(static_cast<std::size_t>(std::ceil(2.56 * highest))),
      turns_(static_cast<std::size_t>(std::max(0.0, std::floor(rotation.last() - first_turn_)))),
      together_(std::min<std::size_t>(32, turns_)),
      count_(turns_ * per_turn_),
      highest_(highest) {
    if (turns_ < 8)
        throw Error(fmt::format("the record holds {} whole turns; order analysis needs at least 8", turns_));
    WelchSettings settings;
    settings.rate = static_cast<double>(per_turn_);
    settings.segment = together_ * per_turn_;
    settings.overlap = settings.segment * 3 / 4;
    settings.window = WindowKind::flat_top;
    settings.scaling = Scaling::spectrum;
    welch_.emplace(settings);
}

void OrderStream::push(std::span<const double> samples) {
    held_.insert(held_.end(), samples.begin(), samples.end());
    produce(false);
}

void OrderStream::produce(bool all) {
    static const Kernel kernel;
    const double last = static_cast<double>(frames_), held_until = static_cast<double>(held_from_ + held_.size());
    turned_.clear();
    double needed = static_cast<double>(held_from_);
    for (; done_ < count_; ++done_) {
        const auto [time, period] =
            rotation_(first_turn_ + static_cast<double>(done_) / static_cast<double>(per_turn_));
        // The kernel's zero crossings are at the samples, or at the new spacing when that is wider.
        const double spacing = std::max(1.0, rate_ * period / static_cast<double>(per_turn_)), place = time * rate_;
        const double from = std::max({0.0, std::ceil(place - Kernel::reach * spacing), needed});
        const double to = std::min(last - 1.0, std::floor(place + Kernel::reach * spacing));
        if (to >= held_until && !all) {
            // The next value may reach a little further back than this one.
            needed = std::max(needed, std::floor(from - 2.0 * spacing));
            break;
        }
        double sum = 0.0, weights = 0.0;
        for (double n = from; n <= std::min(to, held_until - 1.0); ++n) {
            const double weight = kernel((n - place) / spacing);
            sum += weight * held_[static_cast<std::size_t>(n) - held_from_];
            weights += weight;
        }
        turned_.push_back(weights > 0.0 ? sum / weights : 0.0);
    }
    welch_->push(turned_);
    const std::size_t drop = std::min(held_.size(), static_cast<std::size_t>(needed) - held_from_);
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(drop));
    held_from_ += drop;
}

OrderSpectrum OrderStream::spectrum() {
    produce(true);
    const Spectrum spectrum = welch_->spectrum();
    OrderSpectrum out;
    out.step = spectrum.df;
    out.segments = spectrum.segments;
    out.turns = static_cast<double>(turns_);
    out.end = 0.5 * rate_ / highest_rate(rotation_);
    for (const double p : spectrum.power) out.amplitude.push_back(std::sqrt(2.0 * p));
    for (int order = 1; order <= highest_; ++order) {
        if (static_cast<double>(order) > out.end) {
            out.orders.push_back({static_cast<double>(order), 0.0, 0.0, true});
            continue;
        }
        const std::size_t bin = static_cast<std::size_t>(order) * together_;
        if (bin >= out.amplitude.size()) break;
        // Flat-top lines are five bins wide on each side; the noise floor is read half-way to the neighbouring orders.
        std::vector<double> around;
        for (std::size_t k = bin - together_ / 2 - 1; k <= bin - together_ / 2 + 1; ++k)
            around.push_back(out.amplitude[k]);
        for (std::size_t k = bin + together_ / 2 - 1; k <= bin + together_ / 2 + 1 && k < out.amplitude.size(); ++k)
            around.push_back(out.amplitude[k]);
        std::nth_element(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2), around.end());
        const double floor = around[around.size() / 2], amplitude = out.amplitude[bin];
        const double snr = amplitude > 0.0 ? 20.0 * std::log10(amplitude / std::max(floor, 1e-10 * amplitude)) : 0.0;
        out.orders.push_back({static_cast<double>(order), amplitude, snr, false});
    }
    const auto kept = static_cast<std::size_t>(out.end / out.step) + 1;
    if (out.amplitude.size() > kept) out.amplitude.resize(kept);
    return out;
}

OrderSpectrum order_spectrum(std::span<const double> record, double rate, const Rotation& rotation, int highest) {
    OrderStream stream(rate, record.size(), rotation, highest);
    stream.push(record);
    return stream.spectrum();
}

double highest_rate(const Rotation& rotation) {
    const double turns = rotation.last() - rotation.first();
    const int points = static_cast<int>(std::clamp(turns, 1000.0, 1e6));
    double highest = 0.0;
    for (int i = 0; i <= points; ++i)
        highest = std::max(highest, 1.0 / rotation(rotation.first() + turns * i / points).slope);
    return highest;
}

}  // namespace tactus::signal
