// SPDX-License-Identifier: Apache-2.0
#include "dsp/spectrum/transform.hpp"

#include <kissfft/kissfft.hh>

#include <memory>

namespace tactus {

namespace {

/// The plan of the last size: records and blocks of one length come one after another.
const kissfft<double>& plan(std::size_t size, bool inverse) {
    struct Kept {
        std::size_t size = 0;
        std::unique_ptr<kissfft<double>> plan;
    };
    static thread_local Kept kept[2];
    Kept& mine = kept[inverse ? 1 : 0];
    if (mine.size != size) mine = {size, std::make_unique<kissfft<double>>(size, inverse)};
    return *mine.plan;
}

}  // namespace

std::vector<std::complex<double>> spectrum_of(std::span<const double> samples, std::size_t size) {
    std::vector<double> padded(samples.begin(), samples.end());
    padded.resize(size);
    std::vector<std::complex<double>> half(size / 2 + 1);
    plan(size / 2, false).transform_real(padded.data(), half.data());
    // KissFFT packs the value at half the rate into the imaginary part of the first.
    half[size / 2] = half[0].imag();
    half[0] = half[0].real();
    return half;
}

std::vector<double> samples_of(std::span<const std::complex<double>> half) {
    const std::size_t size = 2 * (half.size() - 1);
    std::vector<std::complex<double>> whole(size), out(size);
    for (std::size_t k = 0; k < half.size(); ++k) {
        whole[k] = half[k];
        if (k > 0 && k < half.size() - 1) whole[size - k] = std::conj(half[k]);
    }
    plan(size, true).transform(whole.data(), out.data());
    std::vector<double> samples(size);
    for (std::size_t i = 0; i < size; ++i) samples[i] = out[i].real() / static_cast<double>(size);
    return samples;
}

}  // namespace tactus
