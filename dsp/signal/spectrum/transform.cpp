// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/transform.hpp"

#include "dsp/signal/spectrum/fft.hpp"

#include <memory>

namespace tactus::signal {

namespace {

/// Caches the plan of the last size: consecutive records and blocks often have one length.
RealFft<double>& transform_of(std::size_t size) {
    static thread_local std::unique_ptr<RealFft<double>> kept;
    if (!kept || kept->size() != size) kept = std::make_unique<RealFft<double>>(size);
    return *kept;
}

}  // namespace

std::vector<std::complex<double>> spectrum_of(std::span<const double> samples, std::size_t size) {
    std::vector<double> padded(samples.begin(), samples.end());
    padded.resize(size);
    std::vector<std::complex<double>> half(size / 2 + 1);
    transform_of(size).forward(padded, half);
    return half;
}

std::vector<double> samples_of(std::span<const std::complex<double>> half) {
    std::vector<double> samples(2 * (half.size() - 1));
    transform_of(samples.size()).inverse(half, samples);
    return samples;
}

}  // namespace tactus::signal
