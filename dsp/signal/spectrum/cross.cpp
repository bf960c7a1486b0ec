// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/cross.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::signal {

namespace {

constexpr std::size_t group_segments = 64;

template <class T>
double sum_lanes(const Lanes<T>& v) noexcept {
    double sum = static_cast<double>(v[0]) + static_cast<double>(v[1]);
    for (std::size_t lane = 2; lane < lane_count<T>; ++lane) sum += static_cast<double>(v[lane]);
    return sum;
}

}  // namespace

std::vector<double> CrossSpectra::coherence() const {
    if (segments < 4)
        throw Error(fmt::format("coherence needs at least 4 segments, there are {}: take shorter ones", segments));
    std::vector<double> gamma(xx.size());
    for (std::size_t k = 0; k < xx.size(); ++k) {
        const double powers = xx[k] * yy[k];
        gamma[k] = powers > 0.0 ? std::norm(xy[k]) / powers : 0.0;
    }
    return gamma;
}

std::vector<std::complex<double>> CrossSpectra::h1() const {
    std::vector<std::complex<double>> h(xx.size());
    for (std::size_t k = 0; k < xx.size(); ++k)
        if (xx[k] > 0.0) h[k] = xy[k] / xx[k];
    return h;
}

std::vector<std::complex<double>> CrossSpectra::h2() const {
    std::vector<std::complex<double>> h(xx.size());
    for (std::size_t k = 0; k < xx.size(); ++k)
        if (std::norm(xy[k]) > 0.0) h[k] = yy[k] / std::conj(xy[k]);
    return h;
}

std::vector<std::complex<double>> CrossSpectra::hv() const {
    std::vector<std::complex<double>> h(xx.size());
    for (std::size_t k = 0; k < xx.size(); ++k)
        if (xx[k] > 0.0 && std::norm(xy[k]) > 0.0) h[k] = std::polar(std::sqrt(yy[k] / xx[k]), std::arg(xy[k]));
    return h;
}

std::vector<double> CrossSpectra::response_deviation() const {
    std::vector<double> deviation = coherence();
    for (double& gamma : deviation)
        gamma = gamma > 0.0 ? std::sqrt(std::max(0.0, 1.0 - gamma) / (2.0 * gamma * effective_segments)) : 1.0;
    return deviation;
}

template <class T>
void CrossStream<T>::Sums::add(Sums& part) {
    for (std::size_t k = 0; k < xx.size(); ++k) {
        xx[k] += part.xx[k];
        yy[k] += part.yy[k];
        re[k] += part.re[k];
        im[k] += part.im[k];
    }
    for (std::vector<double>* sum : {&part.xx, &part.yy, &part.re, &part.im}) std::fill(sum->begin(), sum->end(), 0.0);
}

template <class T>
CrossStream<T>::CrossStream(const WelchSettings& settings)
    : settings_((check(settings), settings)),
      transform_x_(settings.segment, settings.window, settings.detrend),
      transform_y_(transform_x_),
      waiting_x_(settings.segment + (SegmentFft<T>::lanes - 1) * settings.step()),
      waiting_y_(waiting_x_.size()),
      group_(transform_x_.bins()),
      total_(group_) {}

template <class T>
void CrossStream<T>::push(std::span<const T> x, std::span<const T> y) {
    while (!x.empty()) {
        const std::size_t part = std::min(x.size(), waiting_x_.size() - held_);
        std::copy_n(x.begin(), part, waiting_x_.begin() + static_cast<std::ptrdiff_t>(held_));
        std::copy_n(y.begin(), part, waiting_y_.begin() + static_cast<std::ptrdiff_t>(held_));
        held_ += part;
        x = x.subspan(part);
        y = y.subspan(part);
        if (held_ < waiting_x_.size()) return;
        take(SegmentFft<T>::lanes);
        const std::size_t used = SegmentFft<T>::lanes * settings_.step();
        for (std::vector<T>* waiting : {&waiting_x_, &waiting_y_})
            std::copy(waiting->begin() + static_cast<std::ptrdiff_t>(used), waiting->end(), waiting->begin());
        held_ -= used;
    }
}

template <class T>
void CrossStream<T>::forget_waiting() noexcept {
    // The segments that are complete count; the rest would span the gap.
    if (held_ >= settings_.segment) take((held_ - settings_.segment) / settings_.step() + 1);
    held_ = 0;
}

template <class T>
void CrossStream<T>::take(std::size_t count) {
    std::array<const T*, SegmentFft<T>::lanes> at_x{}, at_y{};
    for (std::size_t i = 0; i < count; ++i) {
        at_x[i] = waiting_x_.data() + i * settings_.step();
        at_y[i] = waiting_y_.data() + i * settings_.step();
    }
    const Lanes<T>* x = transform_x_({at_x.data(), count});
    const Lanes<T>* y = transform_y_({at_y.data(), count});
    for (std::size_t k = 0; k < group_.xx.size(); ++k) {
        const Lanes<T> a = x[2 * k], b = x[2 * k + 1], c = y[2 * k], d = y[2 * k + 1];
        group_.xx[k] += sum_lanes<T>(a * a + b * b);
        group_.yy[k] += sum_lanes<T>(c * c + d * d);
        group_.re[k] += sum_lanes<T>(a * c + b * d);
        group_.im[k] += sum_lanes<T>(a * d - b * c);
    }
    segments_ += count;
    if (segments_ / group_segments != (segments_ - count) / group_segments) total_.add(group_);
}

template <class T>
CrossSpectra CrossStream<T>::spectra() const {
    CrossStream end = *this;
    end.forget_waiting();
    end.total_.add(end.group_);
    const std::vector<double> window(transform_x_.window().begin(), transform_x_.window().end());
    double sum = 0.0, squares = 0.0;
    for (const double w : window) sum += w, squares += w * w;
    CrossSpectra out;
    out.segments = end.segments_;
    out.df = settings_.rate / static_cast<double>(settings_.segment);
    out.noise_bandwidth = settings_.rate * squares / (sum * sum);
    if (out.segments == 0) return out;
    out.effective_segments = effective_segments(window, settings_.step(), out.segments);
    const double scale =
        (settings_.scaling == Scaling::density ? 1.0 / (settings_.rate * squares) : 1.0 / (sum * sum)) /
        static_cast<double>(out.segments);
    const std::size_t nyquist = settings_.segment % 2 == 0 ? settings_.segment / 2 : end.total_.xx.size();
    for (std::size_t k = 0; k < end.total_.xx.size(); ++k) {
        const double s = k == 0 || k == nyquist ? scale : 2.0 * scale;
        out.xx.push_back(s * end.total_.xx[k]);
        out.yy.push_back(s * end.total_.yy[k]);
        out.xy.emplace_back(s * end.total_.re[k], s * end.total_.im[k]);
    }
    return out;
}

template <class T>
CrossSpectra cross_spectra(std::span<const T> x, std::span<const T> y, WelchSettings settings) {
    if (x.size() != y.size())
        throw Error(
            fmt::format("a cross-spectrum needs channels of one length, not {} and {} samples", x.size(), y.size()));
    if (!x.empty() && x.size() < settings.segment) {
        settings.overlap = settings.overlap * x.size() / settings.segment;
        settings.segment = x.size();
    }
    CrossStream<T> stream(settings);
    stream.push(x, y);
    return stream.spectra();
}

template CrossSpectra cross_spectra<double>(std::span<const double>, std::span<const double>, WelchSettings);
template CrossSpectra cross_spectra<float>(std::span<const float>, std::span<const float>, WelchSettings);
template class CrossStream<double>;
template class CrossStream<float>;

}  // namespace tactus::signal
