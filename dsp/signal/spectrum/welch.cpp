// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/welch.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/spectrum/fft_kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::signal {

namespace {

// Sums over groups of segments, then over groups: independent of how a record is cut into pieces or work is
// distributed, and more accurate than one long sum.
constexpr std::size_t group_segments = 64;

double start_of(Averaging averaging) {
    return averaging == Averaging::minimum ? std::numeric_limits<double>::infinity() : 0.0;
}

void fold(Averaging averaging, double& into, double power) noexcept {
    if (averaging == Averaging::maximum) into = std::max(into, power);
    else if (averaging == Averaging::minimum) into = std::min(into, power);
    else into += power;
}

template <class T>
void fold_segments(Averaging averaging, std::span<double> into, const Lanes<T>* spectrum, std::size_t count) noexcept {
    if (averaging == Averaging::mean) return detail::lane_kernels<T>().add_powers(spectrum, into.data(), into.size());
    for (std::size_t k = 0; k < into.size(); ++k) {
        const Lanes<T> re = spectrum[2 * k], im = spectrum[2 * k + 1], power = re * re + im * im;
        for (std::size_t lane = 0; lane < count; ++lane) fold(averaging, into[k], static_cast<double>(power[lane]));
    }
}

template <class T>
std::vector<T> power_of_lane(const Lanes<T>* spectrum, std::size_t bins, std::size_t lane) {
    std::vector<T> power(bins);
    for (std::size_t k = 0; k < bins; ++k) {
        const T re = spectrum[2 * k][lane], im = spectrum[2 * k + 1][lane];
        power[k] = re * re + im * im;
    }
    return power;
}

double median_of(std::vector<double>& values) {
    const std::size_t half = values.size() / 2;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half), values.end());
    if (values.size() % 2 != 0) return values[half];
    return 0.5 * (values[half] + *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half)));
}

template <class T>
std::vector<double> median_over(const std::vector<std::vector<T>>& segments, std::size_t bins) {
    std::vector<double> median(bins), values(segments.size());
    const double bias = median_bias(segments.size());
    for (std::size_t k = 0; k < bins; ++k) {
        for (std::size_t i = 0; i < segments.size(); ++i) values[i] = static_cast<double>(segments[i][k]);
        median[k] = median_of(values) / bias;
    }
    return median;
}

template <class T>
Spectrum scaled(std::vector<double> power, std::span<const T> window, const WelchSettings& settings,
                std::size_t segments, std::size_t kept) {
    Spectrum out;
    std::vector<double> w(window.begin(), window.end());
    double sum = 0.0, squares = 0.0;
    for (const double x : w) sum += x, squares += x * x;
    const auto n = static_cast<double>(settings.segment);
    out.df = settings.rate / n;
    out.noise_bandwidth = settings.rate * squares / (sum * sum);
    out.segments = segments;
    if (segments == 0) return out;
    double scale = settings.scaling == Scaling::density ? 1.0 / (settings.rate * squares) : 1.0 / (sum * sum);
    if (settings.averaging == Averaging::mean) scale /= static_cast<double>(segments);
    switch (settings.averaging) {
        case Averaging::mean: out.effective_segments = effective_segments(w, settings.step(), segments); break;
        case Averaging::median:
            // The median of exponentially distributed powers has a standard deviation 1/ln 2 times that of their mean.
            out.effective_segments =
                effective_segments(w, settings.step() * (segments / std::max<std::size_t>(kept, 1)), kept) *
                std::numbers::ln2 * std::numbers::ln2;
            break;
        default: out.effective_segments = 1.0;
    }
    const std::size_t nyquist = settings.segment % 2 == 0 ? settings.segment / 2 : power.size();
    for (std::size_t k = 0; k < power.size(); ++k) power[k] *= k == 0 || k == nyquist ? scale : 2.0 * scale;
    out.power = std::move(power);
    return out;
}

void each_in_turn(std::size_t count, const std::function<void(std::size_t)>& run) {
    for (std::size_t i = 0; i < count; ++i) run(i);
}

}  // namespace

double Spectrum::relative_deviation() const {
    return effective_segments > 0.0 ? 1.0 / std::sqrt(effective_segments) : 1.0;
}

double effective_segments(std::span<const double> window, std::size_t step, std::size_t segments) {
    double squares = 0.0;
    for (const double w : window) squares += w * w;
    double repeated = 1.0;
    for (std::size_t j = 1; j < segments && j * step < window.size(); ++j) {
        double product = 0.0;
        for (std::size_t i = 0; i + j * step < window.size(); ++i) product += window[i] * window[i + j * step];
        const double share = product / squares;
        repeated += 2.0 * (1.0 - static_cast<double>(j) / static_cast<double>(segments)) * share * share;
    }
    return static_cast<double>(segments) / repeated;
}

double median_bias(std::size_t segments) {
    double bias = 1.0;
    for (std::size_t i = 2; i + 1 <= segments; i += 2)
        bias += 1.0 / static_cast<double>(i + 1) - 1.0 / static_cast<double>(i);
    return bias;
}

std::size_t suggested_segment(double rate, std::size_t frames) {
    const double longest = std::min(0.75 * rate, static_cast<double>(frames) / 4.5);
    const auto segment = std::bit_floor(static_cast<std::size_t>(std::max(64.0, longest)));
    return std::min(segment, std::max<std::size_t>(1, frames));
}

void check(const WelchSettings& settings) {
    if (settings.segment == 0) throw Error("a spectrum needs segments of at least one sample");
    if (settings.segment > std::size_t{1} << 28) throw Error("segments of more than 2^28 samples are not supported");
    if (settings.overlap >= settings.segment)
        throw Error(fmt::format("segments of {} samples cannot overlap by {}: the overlap must be smaller",
                                settings.segment, settings.overlap));
    if (!(settings.rate > 0.0) || !std::isfinite(settings.rate))
        throw Error("a spectrum needs a sampling rate above 0 Hz");
}

template <class T>
Spectrum welch(std::span<const T> record, WelchSettings settings, const ForEach& for_each) {
    if (!record.empty() && record.size() < settings.segment) {
        settings.overlap = settings.overlap * record.size() / settings.segment;
        settings.segment = record.size();
    }
    check(settings);
    constexpr std::size_t lanes = SegmentFft<T>::lanes;
    const std::size_t segments = settings.segments_in(record.size());
    const std::size_t groups = (segments + group_segments - 1) / group_segments;
    SegmentFft<T> prototype(settings.segment, settings.window, settings.detrend);
    const std::size_t bins = prototype.bins();
    const bool median = settings.averaging == Averaging::median;
    std::vector<std::vector<double>> sums(groups);
    std::vector<std::vector<T>> kept(median ? segments : 0);

    const auto do_group = [&](SegmentFft<T>& transform, std::size_t group) {
        const std::size_t end = std::min(segments, (group + 1) * group_segments);
        std::vector<double> sum(median ? 0 : bins, start_of(settings.averaging));
        for (std::size_t first = group * group_segments; first < end; first += lanes) {
            const std::size_t count = std::min(lanes, end - first);
            std::array<const T*, lanes> starts{};
            for (std::size_t i = 0; i < count; ++i) starts[i] = record.data() + (first + i) * settings.step();
            const Lanes<T>* spectrum = transform({starts.data(), count});
            if (median)
                for (std::size_t i = 0; i < count; ++i) kept[first + i] = power_of_lane<T>(spectrum, bins, i);
            else fold_segments<T>(settings.averaging, sum, spectrum, count);
        }
        sums[group] = std::move(sum);
    };
    if (for_each) {
        for_each(groups, [&](std::size_t group) {
            SegmentFft<T> transform = prototype;
            do_group(transform, group);
        });
    } else {
        each_in_turn(groups, [&](std::size_t group) { do_group(prototype, group); });
    }
    if (segments == 0) return scaled<T>({}, prototype.window(), settings, 0, 0);
    std::vector<double> power(bins, start_of(settings.averaging));
    if (median) power = median_over(kept, bins);
    else
        for (const std::vector<double>& sum : sums)
            for (std::size_t k = 0; k < bins; ++k) fold(settings.averaging, power[k], sum[k]);
    return scaled<T>(std::move(power), prototype.window(), settings, segments, segments);
}

template <class T>
WelchStream<T>::WelchStream(const WelchSettings& settings)
    : settings_((check(settings), settings)),
      transform_(settings.segment, settings.window, settings.detrend),
      waiting_(settings.segment + (SegmentFft<T>::lanes - 1) * settings.step()),
      group_(transform_.bins(), start_of(settings.averaging)),
      total_(group_) {}

template <class T>
void WelchStream<T>::push(std::span<const T> samples) {
    constexpr std::size_t lanes = SegmentFft<T>::lanes;
    while (!samples.empty()) {
        const std::size_t part = std::min(samples.size(), waiting_.size() - held_);
        std::copy_n(samples.begin(), part, waiting_.begin() + static_cast<std::ptrdiff_t>(held_));
        held_ += part;
        samples = samples.subspan(part);
        if (held_ < waiting_.size()) return;
        take(lanes);
        const std::size_t used = lanes * settings_.step();
        std::copy(waiting_.begin() + static_cast<std::ptrdiff_t>(used), waiting_.end(), waiting_.begin());
        held_ -= used;
    }
}

template <class T>
void WelchStream<T>::take(std::size_t count) {
    constexpr std::size_t lanes = SegmentFft<T>::lanes;
    std::array<const T*, lanes> starts{};
    for (std::size_t i = 0; i < count; ++i) starts[i] = waiting_.data() + i * settings_.step();
    const Lanes<T>* spectrum = transform_({starts.data(), count});
    if (settings_.averaging == Averaging::median) {
        for (std::size_t i = 0; i < count; ++i, ++segments_) {
            if (segments_ % keep_every_ != 0) continue;
            if (kept_.size() == max_median_segments) {
                for (std::size_t j = 1; 2 * j < kept_.size(); ++j) kept_[j] = std::move(kept_[2 * j]);
                kept_.resize((kept_.size() + 1) / 2);
                keep_every_ *= 2;
                if (segments_ % keep_every_ != 0) continue;
            }
            kept_.push_back(power_of_lane<T>(spectrum, transform_.bins(), i));
        }
        return;
    }
    fold_segments<T>(settings_.averaging, group_, spectrum, count);
    const std::size_t group = segments_ / group_segments;
    segments_ += count;
    if (segments_ / group_segments == group) return;
    for (std::size_t k = 0; k < group_.size(); ++k) fold(settings_.averaging, total_[k], group_[k]);
    std::fill(group_.begin(), group_.end(), start_of(settings_.averaging));
}

template <class T>
void WelchStream<T>::forget_waiting() {
    if (held_ >= settings_.segment) take((held_ - settings_.segment) / settings_.step() + 1);
    held_ = 0;
}

template <class T>
Spectrum WelchStream<T>::spectrum() const {
    WelchStream end = *this;
    end.forget_waiting();
    if (end.segments_ == 0) return scaled<T>({}, transform_.window(), settings_, 0, 0);
    if (settings_.averaging == Averaging::median)
        return scaled<T>(median_over(end.kept_, transform_.bins()), transform_.window(), settings_, end.segments_,
                         end.kept_.size());
    for (std::size_t k = 0; k < end.total_.size(); ++k) fold(settings_.averaging, end.total_[k], end.group_[k]);
    return scaled<T>(std::move(end.total_), transform_.window(), settings_, end.segments_, end.segments_);
}

template Spectrum welch<double>(std::span<const double>, WelchSettings, const ForEach&);
template Spectrum welch<float>(std::span<const float>, WelchSettings, const ForEach&);
template class WelchStream<double>;
template class WelchStream<float>;

}  // namespace tactus::signal
