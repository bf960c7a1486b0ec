// SPDX-License-Identifier: Apache-2.0
// Arithmetic on each component of a number, vector, twist or wrench, and on each sample of a signal.
#pragma once

#include "dsp/signal/filter/sample.hpp"
#include "graph/node/port.hpp"
#include "graph/node/setup.hpp"

#include <cstddef>
#include <type_traits>

namespace tactus::nodes {

// The components are contiguous.
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Twist) == 6 * sizeof(double) &&
              sizeof(Wrench) == 6 * sizeof(double));

/// out = f(a) in each component.
template <class F>
void for_each_component(const AnyIn& a, AnyOut& out, const Tick& tick, F f) noexcept {
    if (out.type == &value::signal) {
        for (int i = 0; i < tick.frames; ++i)
            out.as<float>()[i] = signal::to_sample(f(static_cast<double>(a.as<float>()[i])));
        return;
    }
    const std::size_t count = out.type->columns.size();
    for (std::size_t k = 0; k < count; ++k) out.as<double>()[k] = f(a.as<double>()[k]);
}

/// out = f(a, b) in each component. An `f` that accepts floats receives samples without conversion: a sum, difference
/// or product of floats has the same bits as that of doubles rounded to float (Figueroa 1995). As `gain` and `mix`, it
/// may overflow.
template <class F>
void for_each_component(const AnyIn& a, const AnyIn& b, AnyOut& out, const Tick& tick, F f) noexcept {
    if (out.type == &value::signal) {
        if constexpr (std::is_same_v<decltype(f(0.0f, 0.0f)), float>) {
            const float *const x = a.as<float>(), *const y = b.as<float>();
            float* const z = out.as<float>();
            // The output may coincide with an input, sample by sample, but never overlaps it otherwise.
#if defined(__clang__)
#pragma clang loop vectorize(assume_safety)
#else
#pragma GCC ivdep
#endif
            for (int i = 0; i < tick.frames; ++i) z[i] = f(x[i], y[i]);
            return;
        }
        for (int i = 0; i < tick.frames; ++i)
            out.as<float>()[i] =
                signal::to_sample(f(static_cast<double>(a.as<float>()[i]), static_cast<double>(b.as<float>()[i])));
        return;
    }
    const std::size_t count = out.type->columns.size();
    for (std::size_t k = 0; k < count; ++k) out.as<double>()[k] = f(a.as<double>()[k], b.as<double>()[k]);
}

}  // namespace tactus::nodes
