// SPDX-License-Identifier: Apache-2.0
// What each operation computes.
#pragma once

#include "graph/formula/program.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tactus::formula {

/// How many of a, b and c an operation takes.
constexpr std::size_t operands_of(Operation operation) {
    switch (operation) {
        case Operation::negate:
        case Operation::opposite:
        case Operation::absolute:
        case Operation::square_root:
        case Operation::exponential:
        case Operation::logarithm:
        case Operation::sine:
        case Operation::cosine:
        case Operation::tangent:
        case Operation::arc_sine:
        case Operation::arc_cosine:
        case Operation::arc_tangent:
        case Operation::floor:
        case Operation::ceiling:
        case Operation::sign: return 1;
        case Operation::clip:
        case Operation::choose:
        case Operation::multiply_add:
        case Operation::multiply_subtract:
        case Operation::subtract_product:
        case Operation::multiply_multiply: return 3;
        default: return 2;
    }
}

/// Calls `run` with the function of the operation, so that each caller's loop is compiled for each operation.
template <class Run>
[[gnu::always_inline]] inline void with_function(Operation operation, Run&& run) noexcept {
    const auto truth = [](bool is_true) { return is_true ? 1.0 : 0.0; };
    switch (operation) {
        case Operation::negate: return run([](double a, double, double) { return -a; });
        case Operation::add: return run([](double a, double b, double) { return a + b; });
        case Operation::subtract: return run([](double a, double b, double) { return a - b; });
        case Operation::multiply: return run([](double a, double b, double) { return a * b; });
        case Operation::divide: return run([](double a, double b, double) { return a / b; });
        case Operation::power: return run([](double a, double b, double) { return std::pow(a, b); });
        case Operation::modulo:
            return run([](double a, double b, double) {
                // The sign of the divisor, as in mathematics.
                const double rest = std::fmod(a, b);
                if (rest == 0.0) return std::copysign(0.0, b);
                return (rest < 0.0) != (b < 0.0) ? rest + b : rest;
            });
        case Operation::less: return run([=](double a, double b, double) { return truth(a < b); });
        case Operation::less_equal: return run([=](double a, double b, double) { return truth(a <= b); });
        case Operation::greater: return run([=](double a, double b, double) { return truth(a > b); });
        case Operation::greater_equal: return run([=](double a, double b, double) { return truth(a >= b); });
        case Operation::equal: return run([=](double a, double b, double) { return truth(a == b); });
        case Operation::not_equal: return run([=](double a, double b, double) { return truth(a != b); });
        case Operation::both: return run([=](double a, double b, double) { return truth(a != 0.0 && b != 0.0); });
        case Operation::either: return run([=](double a, double b, double) { return truth(a != 0.0 || b != 0.0); });
        case Operation::opposite: return run([=](double a, double, double) { return truth(a == 0.0); });
        case Operation::minimum: return run([](double a, double b, double) { return b < a ? b : a; });
        case Operation::maximum: return run([](double a, double b, double) { return a < b ? b : a; });
        case Operation::absolute: return run([](double a, double, double) { return std::abs(a); });
        case Operation::square_root: return run([](double a, double, double) { return std::sqrt(a); });
        case Operation::exponential: return run([](double a, double, double) { return std::exp(a); });
        case Operation::logarithm: return run([](double a, double, double) { return std::log(a); });
        case Operation::sine: return run([](double a, double, double) { return std::sin(a); });
        case Operation::cosine: return run([](double a, double, double) { return std::cos(a); });
        case Operation::tangent: return run([](double a, double, double) { return std::tan(a); });
        case Operation::arc_sine: return run([](double a, double, double) { return std::asin(a); });
        case Operation::arc_cosine: return run([](double a, double, double) { return std::acos(a); });
        case Operation::arc_tangent: return run([](double a, double, double) { return std::atan(a); });
        case Operation::arc_tangent_of_two: return run([](double a, double b, double) { return std::atan2(a, b); });
        case Operation::hypotenuse: return run([](double a, double b, double) { return std::hypot(a, b); });
        case Operation::floor: return run([](double a, double, double) { return std::floor(a); });
        case Operation::ceiling: return run([](double a, double, double) { return std::ceil(a); });
        case Operation::sign: return run([](double a, double, double) { return a > 0.0 ? 1.0 : a < 0.0 ? -1.0 : 0.0; });
        case Operation::clip: return run([](double a, double b, double c) { return std::min(a > b ? a : b, c); });
        case Operation::choose: return run([](double a, double b, double c) { return a != 0.0 ? b : c; });
        case Operation::multiply_add: return run([](double a, double b, double c) { return a * b + c; });
        case Operation::multiply_subtract: return run([](double a, double b, double c) { return a * b - c; });
        case Operation::subtract_product: return run([](double a, double b, double c) { return c - a * b; });
        case Operation::multiply_multiply: return run([](double a, double b, double c) { return a * b * c; });
    }
}

/// `apply` of an operation that is known while compiling.
template <Operation operation>
double apply_known(double a, double b, double c) noexcept {
    double result = 0.0;
    with_function(operation, [&](auto function) { result = function(a, b, c); });
    return result;
}

}  // namespace tactus::formula
