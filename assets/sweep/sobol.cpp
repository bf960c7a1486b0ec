// SPDX-License-Identifier: Apache-2.0
#include "assets/sweep/sobol.hpp"

#include "dsp/core/random.hpp"

#include <array>

namespace tactus::sweep {

namespace {

struct Polynomial {
    unsigned degree, coefficients;
    std::array<std::uint32_t, 6> first;  // initial direction numbers
};

/// Of the dimensions from the second on; the first has 1, 1, 1, …
constexpr std::array<Polynomial, max_sobol_dimensions - 1> polynomials{{{1, 0, {1}},
                                                                        {2, 1, {1, 3}},
                                                                        {3, 1, {1, 3, 1}},
                                                                        {3, 2, {1, 1, 1}},
                                                                        {4, 1, {1, 1, 3, 3}},
                                                                        {4, 4, {1, 3, 5, 13}},
                                                                        {5, 2, {1, 1, 5, 5, 17}},
                                                                        {5, 4, {1, 1, 5, 5, 5}},
                                                                        {5, 7, {1, 1, 7, 11, 19}},
                                                                        {5, 11, {1, 1, 5, 1, 1}},
                                                                        {5, 13, {1, 1, 1, 3, 11}},
                                                                        {5, 14, {1, 3, 5, 5, 31}},
                                                                        {6, 1, {1, 3, 3, 9, 7, 49}},
                                                                        {6, 13, {1, 1, 1, 15, 21, 21}},
                                                                        {6, 16, {1, 3, 1, 13, 27, 49}}}};

constexpr int bits = 32;
using Directions = std::array<std::uint32_t, bits>;

constexpr Directions directions_of(std::size_t dimension) {
    Directions v{};
    if (dimension == 0) {
        for (int k = 0; k < bits; ++k) v[static_cast<std::size_t>(k)] = 1u << (bits - 1 - k);
        return v;
    }
    const Polynomial& p = polynomials[dimension - 1];
    for (std::size_t k = 0; k < bits; ++k) {
        if (k < p.degree) {
            v[k] = p.first[k] << (bits - 1 - k);
            continue;
        }
        v[k] = v[k - p.degree] ^ (v[k - p.degree] >> p.degree);
        for (std::size_t j = 1; j < p.degree; ++j)
            if ((p.coefficients >> (p.degree - 1 - j)) & 1u) v[k] ^= v[k - j];
    }
    return v;
}

constexpr auto all_directions = [] {
    std::array<Directions, max_sobol_dimensions> all{};
    for (std::size_t d = 0; d < max_sobol_dimensions; ++d) all[d] = directions_of(d);
    return all;
}();

}  // namespace

std::uint32_t sobol(std::uint64_t index, std::size_t dimension) {
    const Directions& v = all_directions[dimension];
    std::uint64_t gray = index ^ (index >> 1);
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < bits && gray; ++k, gray >>= 1)
        if (gray & 1u) value ^= v[k];
    return value;
}

double shifted_sobol(std::uint64_t index, std::size_t dimension, std::uint64_t seed) {
    const auto shift = static_cast<std::uint32_t>(Random{seed}.bits(dimension) >> 32);
    return (static_cast<double>(sobol(index, dimension) ^ shift) + 0.5) * 0x1.0p-32;
}

}  // namespace tactus::sweep
