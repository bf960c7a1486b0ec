// SPDX-License-Identifier: Apache-2.0
// Discrete Fourier transforms of any length, in float or double, by KissFFT. Several transforms of one power of two at
// once (Welch's segments) have a kernel with the same bits (fft_kernel.hpp), which is three times as fast with AVX2.
// Lengths with a prime factor above 31 use the chirp transform (Bluestein 1970) through a power of two, so none is slow.
#pragma once

#include "dsp/signal/spectrum/lanes.hpp"

#include <complex>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace tactus::signal {

namespace detail {

/// The complex transform on interleaved parts (re, im, re, im, …). `V` is T, or Lanes<T> for several at once. Allocates
/// when made or copied, not when used; not thread-safe, as KissFFT keeps a scratch buffer.
template <class T, class V>
class FftPlan {
public:
    explicit FftPlan(std::size_t n);
    ~FftPlan();
    FftPlan(const FftPlan& other);
    FftPlan(FftPlan&&) noexcept;
    FftPlan& operator=(const FftPlan& other);
    FftPlan& operator=(FftPlan&&) noexcept;

    /// Transforms `a`, with `b` as work memory (2n values each, not overlapping, of LineVectors); returns the one with the
    /// result.
    V* operator()(V* a, V* b) noexcept;

private:
    struct Kiss;
    struct Chirp;

    V* through_chirp(V* a) noexcept;

    std::size_t n_;
    std::vector<T> turns_;  // lanes of a power of two: for each stage and k, exp(−2πi·jk/n) with j = 1, 2, 3
    std::unique_ptr<Kiss> kiss_;
    std::unique_ptr<Chirp> chirp_;
};

/// The transform of real input; see RealFft.
template <class T, class V>
class RealFftPlan {
public:
    explicit RealFftPlan(std::size_t n);

    std::size_t size() const noexcept { return n_; }
    /// Input array of n real values; the transforms overwrite it.
    V* input() noexcept { return a_.data(); }
    /// n/2 + 1 complex values, interleaved: the transform of input(); valid until the next call.
    const V* forward() noexcept;
    /// Inverse, from n/2 + 1 interleaved complex values to n real ones, scaled by n (n/2 for even n).
    const V* inverse(const V* spectrum) noexcept;

private:
    std::size_t n_;
    FftPlan<T, V> plan_;
    std::vector<T> turns_;  // exp(−2πik/n) for k ≤ n/4, even n
    LineVector<V> a_, b_;
};

}  // namespace detail

/// Complex transform of length n ≥ 1. Allocates when made, not when used; not thread-safe.
template <class T>
class Fft {
public:
    explicit Fft(std::size_t n) : n_(n), plan_(n), a_(2 * n), b_(2 * n) {}

    std::size_t size() const noexcept { return n_; }
    /// X[k] = Σ x[i] exp(−2πi·ik/n). Both spans hold n values and may be identical.
    void forward(std::span<const std::complex<T>> x, std::span<std::complex<T>> spectrum) noexcept;
    /// The inverse of forward: x[i] = 1/n Σ X[k] exp(+2πi·ik/n).
    void inverse(std::span<const std::complex<T>> spectrum, std::span<std::complex<T>> x) noexcept;

private:
    std::size_t n_;
    detail::FftPlan<T, T> plan_;
    std::vector<T> a_, b_;
};

/// Real transform of length n ≥ 1. Allocates when made, not when used; not thread-safe.
template <class T>
class RealFft {
public:
    explicit RealFft(std::size_t n) : plan_(n) {}

    std::size_t size() const noexcept { return plan_.size(); }
    /// Number of complex values from 0 Hz to half the rate: n/2 + 1.
    std::size_t bins() const noexcept { return plan_.size() / 2 + 1; }
    /// `x`: n values; `spectrum`: bins() values.
    void forward(std::span<const T> x, std::span<std::complex<T>> spectrum) noexcept;
    /// The inverse of forward. Ignores imaginary parts at 0 Hz and (even n) at half the rate.
    void inverse(std::span<const std::complex<T>> spectrum, std::span<T> x) noexcept;

private:
    detail::RealFftPlan<T, T> plan_;
};

}  // namespace tactus::signal
