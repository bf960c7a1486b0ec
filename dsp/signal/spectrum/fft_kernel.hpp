// SPDX-License-Identifier: Apache-2.0
// Inner loops of Fourier transforms, compiled once per instruction set: radix-4 transforms of powers of two, with the
// order of operations, and so the bits, of KissFFT, which takes three times as long with lanes.
#pragma once

#include "dsp/signal/spectrum/lanes.hpp"

#include <cstddef>

namespace tactus::signal::detail {

/// `V` is T, or Lanes<T>. `Isa` is a type of an unnamed namespace: the functions of each instruction set are their own,
/// and the linker cannot merge them. The results do not depend on it.
template <class Isa, class T, class V>
struct FftKernel {
    struct Complex {
        V re, im;
    };

    static Complex times(const Complex& a, const T* turn) noexcept {
        return {a.re * turn[0] - a.im * turn[1], a.re * turn[1] + a.im * turn[0]};
    }

    static void combine(const Complex& a, const Complex& b, const Complex& c, const Complex& d, Complex* out,
                        std::size_t m) noexcept {
        const Complex even{a.re + c.re, a.im + c.im}, odd{a.re - c.re, a.im - c.im};
        const Complex sum{b.re + d.re, b.im + d.im}, turned{b.im - d.im, d.re - b.re};
        out[0] = {even.re + sum.re, even.im + sum.im};
        out[m] = {odd.re + turned.re, odd.im + turned.im};
        out[2 * m] = {even.re - sum.re, even.im - sum.im};
        out[3 * m] = {odd.re - turned.re, odd.im - turned.im};
    }

    /// Combines four transforms of length m. `turns`: three complex numbers for each k < m.
    static void butterflies(Complex* out, std::size_t m, const T* turns) noexcept {
        for (std::size_t k = 0; k < m; ++k, turns += 6)
            combine(out[k], times(out[k + m], turns), times(out[k + 2 * m], turns + 2),
                    times(out[k + 3 * m], turns + 4), out + k, m);
    }

    /// Complex transform of length n, a power of two of at least 4, from interleaved parts; the arrays do not overlap.
    /// `turns`: see fft_turns(). Depth first: the parts of a long transform stay in the cache.
    static void transform(const V* from, V* to, std::size_t n, const T* turns) noexcept {
        const auto* in = reinterpret_cast<const Complex*>(from);
        auto* out = reinterpret_cast<Complex*>(to);
        const std::size_t leaf = first_length(n), leaves = n / leaf;
        std::size_t place = 0;  // of the leaf's first sample: its number with the order of its base-4 digits reversed
        for (std::size_t done = 1; done <= leaves; ++done) {
            const Complex* x = in + place;
            Complex* const y = out + leaf * (done - 1);
            const T* turn = turns;
            if (leaf == 4) {
                combine(x[0], x[leaves], x[2 * leaves], x[3 * leaves], y, 1);
            } else {
                for (std::size_t i = 0; i < 4; ++i) {
                    const Complex a = x[i * leaves], b = x[(i + 4) * leaves];
                    y[2 * i] = {a.re + b.re, a.im + b.im};
                    y[2 * i + 1] = {a.re - b.re, a.im - b.im};
                }
                butterflies(y, 2, turn);
                turn += 12;
            }
            std::size_t m = leaf;
            for (std::size_t whole = done; whole % 4 == 0; whole /= 4, turn += 6 * m, m *= 4)
                butterflies(out + leaf * done - 4 * m, m, turn);
            for (std::size_t weight = leaves / 4; weight > 0; weight /= 4) {
                const bool is_carried = (place & 3 * weight) == 3 * weight;
                place = is_carried ? place - 3 * weight : place + weight;
                if (!is_carried) break;
            }
        }
    }

    /// Length of the first transforms that a transform of a power of two is combined from.
    static std::size_t first_length(std::size_t n) noexcept { return __builtin_ctzll(n) % 2 == 0 ? 4 : 8; }

    /// Even and odd samples formed one complex series of half the length n/2 = `last`: separates their transforms.
    static void separate(V* z, std::size_t last, const T* turns) noexcept {
        const T half = T{0.5};
        const V first_re = z[0], first_im = z[1];
        z[0] = first_re + first_im;
        z[1] = V{};
        z[2 * last] = first_re - first_im;
        z[2 * last + 1] = V{};
        for (std::size_t k = 1; 2 * k <= last; ++k) {
            V *low = z + 2 * k, *high = z + 2 * (last - k);
            const V even_re = (low[0] + high[0]) * half, even_im = (low[1] - high[1]) * half;
            const V odd_re = (low[1] + high[1]) * half, odd_im = (high[0] - low[0]) * half;
            const T c = turns[2 * k], s = turns[2 * k + 1];
            const V turned_re = odd_re * c - odd_im * s, turned_im = odd_re * s + odd_im * c;
            high[0] = even_re - turned_re;
            high[1] = turned_im - even_im;
            low[0] = even_re + turned_re;
            low[1] = even_im + turned_im;
        }
    }

    /// Samples less their mean, by a window, one lane per segment.
    static void window(const T* const* segments, const T* mean, const T* w, V* in, std::size_t n) noexcept {
        constexpr std::size_t lanes = sizeof(V) / sizeof(T);
        const T* x[lanes];
        V shift{};
        for (std::size_t lane = 0; lane < lanes; ++lane) x[lane] = segments[lane], shift[lane] = mean[lane];
        for (std::size_t i = 0; i < n; ++i) {
            V v;
            for (std::size_t lane = 0; lane < lanes; ++lane) v[lane] = x[lane][i];
            in[i] = (v - shift) * w[i];
        }
    }

    /// Adds the powers of all lanes, in groups of 16 bytes.
    static void add_powers(const V* spectrum, double* into, std::size_t bins) noexcept {
        constexpr std::size_t lanes = sizeof(V) / sizeof(T), group = 16 / sizeof(T);
        for (std::size_t k = 0; k < bins; ++k) {
            const V re = spectrum[2 * k], im = spectrum[2 * k + 1], power = re * re + im * im;
            double total = into[k];
            for (std::size_t lane = 0; lane < lanes; lane += group) {
                double sum = static_cast<double>(power[lane]);
                for (std::size_t i = 1; i < group; ++i) sum += static_cast<double>(power[lane + i]);
                total += sum;
            }
            into[k] = total;
        }
    }
};

/// The loops over lanes for the instructions of this machine.
template <class T>
struct LaneKernels {
    void (*transform)(const Lanes<T>* in, Lanes<T>* out, std::size_t n, const T* turns) noexcept;
    void (*separate)(Lanes<T>* z, std::size_t last, const T* turns) noexcept;
    void (*window)(const T* const* segments, const T* mean, const T* w, Lanes<T>* in, std::size_t n) noexcept;
    void (*add_powers)(const Lanes<T>* spectrum, double* into, std::size_t bins) noexcept;

    template <class Isa>
    static constexpr LaneKernels of() {
        using Kernel = FftKernel<Isa, T, Lanes<T>>;
        return {Kernel::transform, Kernel::separate, Kernel::window, Kernel::add_powers};
    }
};

template <class T>
const LaneKernels<T>& lane_kernels() noexcept;

#if defined(__x86_64__)
template <class T>
const LaneKernels<T>& lane_kernels_of_avx2() noexcept;
#endif

}  // namespace tactus::signal::detail
