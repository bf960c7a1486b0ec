// SPDX-License-Identifier: Apache-2.0
// KissFFT on lanes beside KissFFT on numbers: the same bits, in each lane.
#include "dsp/signal/spectrum/lane_scalar.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <kissfft/kissfft.hh>

#include <cmath>
#include <complex>
#include <cstddef>
#include <cstring>
#include <vector>

using namespace tactus;

namespace {

template <class T>
bool same_bits(const std::complex<T>& a, signal::LaneScalar<T> re, signal::LaneScalar<T> im, std::size_t lane) {
    const T got[2] = {re.lanes[lane], im.lanes[lane]}, wanted[2] = {a.real(), a.imag()};
    return std::memcmp(got, wanted, sizeof(got)) == 0;
}

template <class T>
void check_length(std::size_t n, bool inverse) {
    CAPTURE(n, inverse, sizeof(T));
    using Together = std::complex<signal::LaneScalar<T>>;
    constexpr std::size_t lanes = signal::lane_count<T>;
    const Random random{5};
    std::vector<std::vector<std::complex<T>>> alone(lanes, std::vector<std::complex<T>>(n));
    std::vector<Together> together(n);
    for (std::size_t i = 0; i < n; ++i) {
        signal::Lanes<T> re{}, im{};
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            re[lane] = static_cast<T>(random.normal(2 * (lanes * i + lane)));
            im[lane] = static_cast<T>(random.normal(2 * (lanes * i + lane) + 1));
            alone[lane][i] = {re[lane], im[lane]};
        }
        together[i] = {re, im};
    }
    const kissfft<T> of_numbers(n, inverse);
    const kissfft<signal::LaneScalar<T>> of_lanes(n, inverse);
    std::vector<Together> spectra(n);
    std::vector<std::complex<T>> spectrum(n);
    of_lanes.transform(together.data(), spectra.data());
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        bool equal = true;
        of_numbers.transform(alone[lane].data(), spectrum.data());
        for (std::size_t k = 0; k < n; ++k)
            equal = equal && same_bits<T>(spectrum[k], spectra[k].real(), spectra[k].imag(), lane);
        CHECK(equal);
    }
}

}  // namespace

TEST_CASE("each lane of a transform has the bits of KissFFT on its numbers alone") {
    // Each butterfly: 2, 3, 4, 5, the general one; and the lengths that analyses use.
    for (const std::size_t n : {1u,  2u,  3u,  4u,  5u,   6u,   7u,    8u,    9u,    11u,   16u,
                                25u, 31u, 49u, 60u, 105u, 210u, 2048u, 2205u, 4096u, 4410u, 11025u})
        for (const bool inverse : {false, true}) {
            check_length<double>(n, inverse);
            check_length<float>(n, inverse);
        }
}

TEST_CASE("a lane scalar is made from one number, keeps its zero's sign, and computes lane by lane") {
    const signal::LaneScalar<double> zero(-0.0), a(signal::Lanes<double>{1.5, -2.0, 1.5, -2.0}),
        b(signal::Lanes<double>{4.0, 0.5, 4.0, 0.5});
    CHECK(std::signbit(zero.lanes[0]));
    CHECK(std::signbit(zero.lanes[1]));
    const signal::LaneScalar<double> sum = a + b, difference = a - b, product = a * b, ratio = a / b, twice = 2 * a,
                                     half = a / 2, negative = -a;
    const double wanted[7][2] = {{5.5, -1.5}, {-2.5, -2.5}, {6.0, -1.0}, {0.375, -4.0},
                                 {3.0, -4.0}, {0.75, -1.0}, {-1.5, 2.0}};
    std::size_t row = 0;
    for (const signal::LaneScalar<double>& got : {sum, difference, product, ratio, twice, half, negative}) {
        CHECK(got.lanes[0] == wanted[row][0]);
        CHECK(got.lanes[1] == wanted[row][1]);
        ++row;
    }
}
