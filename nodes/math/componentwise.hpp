// SPDX-License-Identifier: Apache-2.0
// Arithmetic on each component of a number, vector, twist or wrench, and on each sample of a signal.
#pragma once

#include "dsp/signal/filter/sample.hpp"
#include "graph/node/port.hpp"
#include "graph/node/setup.hpp"

#include <cstddef>

namespace tactus::nodes {

// The components lie side by side.
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

/// out = f(a, b) in each component.
template <class F>
void for_each_component(const AnyIn& a, const AnyIn& b, AnyOut& out, const Tick& tick, F f) noexcept {
    if (out.type == &value::signal) {
        for (int i = 0; i < tick.frames; ++i)
            out.as<float>()[i] =
                signal::to_sample(f(static_cast<double>(a.as<float>()[i]), static_cast<double>(b.as<float>()[i])));
        return;
    }
    const std::size_t count = out.type->columns.size();
    for (std::size_t k = 0; k < count; ++k) out.as<double>()[k] = f(a.as<double>()[k], b.as<double>()[k]);
}

}  // namespace tactus::nodes
