// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/segment_fft.hpp"

#include "dsp/signal/spectrum/fft_kernel.hpp"

#include <array>

namespace tactus::signal {

namespace {

/// Eight independent partial sums, which run in parallel, in a fixed order.
template <class T>
double mean_of(const T* x, std::size_t n) noexcept {
    double part[8] = {};
    std::size_t i = 0;
    for (; i + 8 <= n; i += 8)
        for (std::size_t j = 0; j < 8; ++j) part[j] += static_cast<double>(x[i + j]);
    for (; i < n; ++i) part[i % 8] += static_cast<double>(x[i]);
    const double sum = ((part[0] + part[4]) + (part[2] + part[6])) + ((part[1] + part[5]) + (part[3] + part[7]));
    return sum / static_cast<double>(n);
}

struct Line {
    double middle = 0.0, slope = 0.0;  // value at the middle of the segment; per sample
};

/// Least-squares line.
template <class T>
Line line_through(const T* x, std::size_t n) noexcept {
    Line line{mean_of(x, n), 0.0};
    const double middle = 0.5 * static_cast<double>(n - 1);
    double products = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const double t = static_cast<double>(i) - middle;
        products += t * (static_cast<double>(x[i]) - line.middle);
        squares += t * t;
    }
    if (squares > 0.0) line.slope = products / squares;
    return line;
}

}  // namespace

template <class T>
SegmentFft<T>::SegmentFft(std::size_t length, WindowKind window, Detrend detrend)
    : detrend_(detrend), plan_(length), silence_(length) {
    for (const double w : make_window(window, length)) window_.push_back(static_cast<T>(w));
}

template <class T>
const Lanes<T>* SegmentFft<T>::operator()(std::span<const T* const> starts) noexcept {
    const std::size_t n = length();
    std::array<const T*, lanes> x;
    for (std::size_t lane = 0; lane < lanes; ++lane) x[lane] = lane < starts.size() ? starts[lane] : silence_.data();
    Lanes<T>* in = plan_.input();
    const T* w = window_.data();
    if (detrend_ == Detrend::linear) {
        std::array<Line, lanes> line;
        for (std::size_t lane = 0; lane < lanes; ++lane) line[lane] = line_through(x[lane], n);
        const double middle = 0.5 * static_cast<double>(n - 1);
        for (std::size_t i = 0; i < n; ++i) {
            const double t = static_cast<double>(i) - middle;
            for (std::size_t lane = 0; lane < lanes; ++lane) {
                const double trend = line[lane].middle + line[lane].slope * t;
                in[i][lane] = static_cast<T>(static_cast<double>(x[lane][i]) - trend) * w[i];
            }
        }
        return plan_.forward();
    }
    std::array<T, lanes> mean{};
    if (detrend_ == Detrend::constant)
        for (std::size_t lane = 0; lane < lanes; ++lane) mean[lane] = static_cast<T>(mean_of(x[lane], n));
    detail::lane_kernels<T>().window(x.data(), mean.data(), w, in, n);
    return plan_.forward();
}

template class SegmentFft<double>;
template class SegmentFft<float>;

}  // namespace tactus::signal
