// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/window.hpp"

#include <cmath>
#include <numbers>

namespace tactus::signal {

namespace {

std::span<const double> cosine_terms(WindowKind kind) {
    static constexpr double rectangular[] = {1.0};
    static constexpr double hann[] = {0.5, 0.5};
    static constexpr double hamming[] = {0.54, 0.46};
    static constexpr double blackman[] = {0.42, 0.50, 0.08};
    static constexpr double blackman_harris[] = {0.35875, 0.48829, 0.14128, 0.01168};
    static constexpr double flat_top[] = {0.21557895, 0.41663158, 0.277263158, 0.083578947, 0.006947368};
    switch (kind) {
        case WindowKind::hann: return hann;
        case WindowKind::hamming: return hamming;
        case WindowKind::blackman: return blackman;
        case WindowKind::blackman_harris: return blackman_harris;
        case WindowKind::flat_top: return flat_top;
        case WindowKind::rectangular: break;
    }
    return rectangular;
}

}  // namespace

std::vector<double> make_window(WindowKind kind, std::size_t n, WindowSymmetry symmetry) {
    std::vector<double> window(n, 1.0);
    if (n < 2) return window;
    const std::span<const double> terms = cosine_terms(kind);
    const double period = static_cast<double>(symmetry == WindowSymmetry::periodic ? n : n - 1);
    for (std::size_t i = 0; i < n; ++i) {
        double sum = 0.0;
        for (std::size_t j = 0; j < terms.size(); ++j) {
            const double angle = 2.0 * std::numbers::pi * static_cast<double>(j * i) / period;
            sum += (j % 2 == 0 ? terms[j] : -terms[j]) * std::cos(angle);
        }
        window[i] = sum;
    }
    return window;
}

double noise_bandwidth_bins(std::span<const double> window) {
    double sum = 0.0, squares = 0.0;
    for (const double w : window) sum += w, squares += w * w;
    return static_cast<double>(window.size()) * squares / (sum * sum);
}

}  // namespace tactus::signal
