// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/fft.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tactus;

namespace {

template <class T>
std::vector<std::complex<T>> noise(std::size_t n) {
    const Random random{7};
    std::vector<std::complex<T>> x(n);
    for (std::size_t i = 0; i < n; ++i)
        x[i] = {static_cast<T>(random.uniform(2 * i) - 0.5), static_cast<T>(random.uniform(2 * i + 1) - 0.5)};
    return x;
}

template <class T>
std::vector<std::complex<long double>> by_definition(const std::vector<std::complex<T>>& x) {
    const std::size_t n = x.size();
    std::vector<std::complex<long double>> out(n);
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t i = 0; i < n; ++i) {
            const long double angle = -2.0L * std::numbers::pi_v<long double> * static_cast<long double>(i * k % n) /
                                      static_cast<long double>(n);
            out[k] += std::complex<long double>(x[i].real(), x[i].imag()) * std::polar(1.0L, angle);
        }
    return out;
}

template <class T>
void check_length(std::size_t n, double tolerance) {
    CAPTURE(n);
    const auto x = noise<T>(n);
    const auto wanted = by_definition(x);
    std::vector<std::complex<T>> spectrum(n), back(n);
    signal::Fft<T> fft(n);
    fft.forward(x, spectrum);
    fft.inverse(spectrum, back);
    double error = 0.0, loudest = 0.0, lost = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
        error = std::max(error, static_cast<double>(std::abs(std::complex<long double>(spectrum[k]) - wanted[k])));
        loudest = std::max(loudest, static_cast<double>(std::abs(wanted[k])));
        lost = std::max(lost, static_cast<double>(std::abs(back[k] - x[k])));
    }
    CHECK(error <= tolerance * loudest);
    CHECK(lost <= tolerance);

    std::vector<T> real(n), real_back(n);
    for (std::size_t i = 0; i < n; ++i) real[i] = x[i].real();
    std::vector<std::complex<T>> copy(n), half(n / 2 + 1);
    for (std::size_t i = 0; i < n; ++i) copy[i] = real[i];
    fft.forward(copy, spectrum);
    signal::RealFft<T> real_fft(n);
    REQUIRE(real_fft.bins() == n / 2 + 1);
    real_fft.forward(real, half);
    real_fft.inverse(half, real_back);
    double apart = 0.0, real_lost = 0.0;
    for (std::size_t k = 0; k < half.size(); ++k)
        apart = std::max(apart, static_cast<double>(std::abs(half[k] - spectrum[k])));
    for (std::size_t i = 0; i < n; ++i)
        real_lost = std::max(real_lost, static_cast<double>(std::abs(real_back[i] - real[i])));
    CHECK(apart <= tolerance * loudest);
    CHECK(real_lost <= tolerance);
}

}  // namespace

TEST_CASE("a transform of any length is the sum that defines it, and its inverse gives the record back", "[slow]") {
    // Powers of two, mixed factors, odd, large primes, and a prime times a small factor.
    for (const std::size_t n :
         {1u,  2u,  3u,  4u,  5u,   6u,   7u,   8u,   9u,   12u,  15u,  16u,  17u,  31u,  32u,
          37u, 48u, 74u, 97u, 100u, 105u, 128u, 243u, 251u, 256u, 480u, 509u, 512u, 750u, 1018u}) {
        check_length<double>(n, 2e-15 * std::sqrt(1.0 + std::log2(n)) + 1e-15);
        check_length<float>(n, 1e-6);
    }
}

TEST_CASE("a transform of one tone is one line at 0 Hz, between, and at half the rate") {
    constexpr std::size_t n = 64;
    signal::RealFft<double> fft(n);
    std::vector<double> x(n);
    std::vector<std::complex<double>> spectrum(n / 2 + 1);
    for (const std::size_t line : {0u, 5u, 32u}) {
        for (std::size_t i = 0; i < n; ++i)
            x[i] = std::cos(2.0 * std::numbers::pi * static_cast<double>(line * i % n) / n);
        fft.forward(x, spectrum);
        for (std::size_t k = 0; k < spectrum.size(); ++k) {
            const double wanted = k != line ? 0.0 : line % 32 == 0 ? n : n / 2.0;
            CHECK(std::abs(spectrum[k] - wanted) < 1e-13);
        }
    }
}

TEMPLATE_TEST_CASE("segments side by side get the bits that each gets alone", "", float, double) {
    constexpr std::size_t lanes = signal::lane_count<TestType>;
    // KissFFT, the kernel of even and odd powers of two, and the chirp.
    for (const std::size_t n : {300u, 512u, 1024u, 4096u, 74u}) {
        CAPTURE(n);
        signal::detail::RealFftPlan<TestType, signal::Lanes<TestType>> together(n);
        signal::detail::RealFftPlan<TestType, TestType> alone(n);
        const auto x = noise<TestType>(lanes * n);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t lane = 0; lane < lanes; ++lane) together.input()[i][lane] = x[lane * n + i].real();
        const signal::Lanes<TestType>* all = together.forward();
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            for (std::size_t i = 0; i < n; ++i) alone.input()[i] = x[lane * n + i].real();
            const TestType* one = alone.forward();
            bool equal = true;
            for (std::size_t i = 0; i < n + 2; ++i) equal = equal && one[i] == all[i][lane];
            CHECK(equal);
        }
    }
}
