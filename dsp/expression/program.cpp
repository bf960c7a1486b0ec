// SPDX-License-Identifier: Apache-2.0
#include "dsp/expression/program.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::expression {

namespace {

/// Calls `run` with the function of the operation, so that each caller's loop is compiled for each operation.
template <class Run>
void with_function(Operation operation, Run&& run) noexcept {
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
    }
}

}  // namespace

double apply(Operation operation, double a, double b, double c) noexcept {
    double result = 0.0;
    with_function(operation, [&](auto function) { result = function(a, b, c); });
    return result;
}

bool Program::uses(std::size_t variable) const noexcept {
    const auto reads = [variable](const Instruction& i) {
        return i.a == variable || i.b == variable || i.c == variable;
    };
    return result == variable || std::ranges::any_of(instructions, reads);
}

Machine::Machine(Program program)
    : program_(std::move(program)), registers_(program_.registers * block), singles_(program_.registers) {
    for (std::size_t k = 0; k < program_.constants.size(); ++k) {
        std::fill_n(variable(program_.variables + k), block, program_.constants[k]);
        single(program_.variables + k) = program_.constants[k];
    }
}

double Machine::run() noexcept {
    for (std::size_t i = 0; i < program_.variables; ++i) single(i) = *variable(i);
    return run_one();
}

double Machine::run_one() noexcept {
    double* const at = singles_.data();
    double value = at[program_.result];
    // The last instruction makes the result: it need not be read again.
    for (const Instruction& i : program_.instructions) {
        with_function(i.operation, [&](auto function) { value = function(at[i.a], at[i.b], at[i.c]); });
        at[i.to] = value;
    }
    return value;
}

void run_instruction(Operation operation, double* to, const double* a, const double* b, const double* c,
                     int count) noexcept {
    // A result may take the place of an operand, value by value, but never overlaps it otherwise: the loops need not look
    // for that before they take several values at once.
    with_function(operation, [&](auto function) {
#if defined(__clang__)
#pragma clang loop vectorize(assume_safety)
#else
#pragma GCC ivdep
#endif
        for (int k = 0; k < count; ++k) to[k] = function(a[k], b[k], c[k]);
    });
}

std::span<const double> Machine::run(int count) noexcept {
    for (const Instruction& i : program_.instructions)
        run_instruction(i.operation, variable(i.to), variable(i.a), variable(i.b), variable(i.c), count);
    return {variable(program_.result), static_cast<std::size_t>(count)};
}

void Machine::run(const float* const* inputs, float* out, int count) noexcept {
    loop_(program_, registers_.data(), inputs, out, count);
}

}  // namespace tactus::expression
