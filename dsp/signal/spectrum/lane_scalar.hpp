// SPDX-License-Identifier: Apache-2.0
// Lanes as the scalar type of a template library: std::complex and KissFFT use it like T, lane by lane.
#pragma once

#include "dsp/signal/spectrum/lanes.hpp"

#include <type_traits>

namespace tactus::signal {

/// Lanes<T> that can be made from one number (all lanes equal) and read as one (the first lane): constants that a
/// library computes with std::acos, std::exp or std::cos are computed in T. Values that differ by lane must not be read
/// as one.
template <class T>
struct LaneScalar {
    Lanes<T> lanes;

    LaneScalar() = default;
    LaneScalar(Lanes<T> values) : lanes(values) {}
    template <class Number>
        requires std::is_arithmetic_v<Number>
    LaneScalar(Number value) : lanes(static_cast<T>(value) - Lanes<T>{}) {}

    operator T() const { return lanes[0]; }

    LaneScalar operator-() const { return -lanes; }
    LaneScalar& operator+=(LaneScalar b) { return *this = lanes + b.lanes; }
    LaneScalar& operator-=(LaneScalar b) { return *this = lanes - b.lanes; }
    LaneScalar& operator*=(LaneScalar b) { return *this = lanes * b.lanes; }
    LaneScalar& operator/=(LaneScalar b) { return *this = lanes / b.lanes; }

    friend LaneScalar operator+(LaneScalar a, LaneScalar b) { return a += b; }
    friend LaneScalar operator-(LaneScalar a, LaneScalar b) { return a -= b; }
    friend LaneScalar operator*(LaneScalar a, LaneScalar b) { return a *= b; }
    friend LaneScalar operator/(LaneScalar a, LaneScalar b) { return a /= b; }
};

// For operations with a plain number: otherwise the operator above and the built-in one are ambiguous.
template <class T, class Number>
    requires std::is_arithmetic_v<Number>
LaneScalar<T> operator*(Number a, LaneScalar<T> b) {
    return LaneScalar<T>(a) * b;
}
template <class T, class Number>
    requires std::is_arithmetic_v<Number>
LaneScalar<T> operator*(LaneScalar<T> a, Number b) {
    return a * LaneScalar<T>(b);
}
template <class T, class Number>
    requires std::is_arithmetic_v<Number>
LaneScalar<T> operator/(LaneScalar<T> a, Number b) {
    return a / LaneScalar<T>(b);
}
}  // namespace tactus::signal
