// SPDX-License-Identifier: Apache-2.0
// Lanes as the number type of a template library: std::complex and KissFFT compute with it as with T, lane by lane.
#pragma once

#include "dsp/signal/spectrum/lanes.hpp"

#include <type_traits>

namespace tactus::signal {

/// Lanes<T> that are made from one number (all lanes equal) and read as one (the first lane): so the constants that a
/// library takes from std::acos, std::exp or std::cos are computed in T. Values that differ by lane must stay in it.
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

// Beside a plain number: without these the operator above and the built-in one, on the first lane, fit equally well.
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
