// SPDX-License-Identifier: Apache-2.0
#include "graph/formula/slope.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <numbers>

namespace tactus::formula {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr Interval everything{}, nothing{0.0, 0.0}, truth{0.0, 1.0}, unit{-1.0, 1.0};

/// An end of a sum or product that is not a number has no bound.
Interval made(double low, double high) {
    return {std::isnan(low) ? -infinite : low, std::isnan(high) ? infinite : high};
}

Interval hull(const Interval& a, const Interval& b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }
Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
Interval operator+(const Interval& a, const Interval& b) { return made(a.low + b.low, a.high + b.high); }

/// Zero times anything is zero: what has no bound is finite all the same.
double times(double a, double b) { return a == 0.0 || b == 0.0 ? 0.0 : a * b; }

Interval operator*(const Interval& a, const Interval& b) {
    const auto [low, high] =
        std::minmax({times(a.low, b.low), times(a.low, b.high), times(a.high, b.low), times(a.high, b.high)});
    return made(low, high);
}

/// Of an interval without 0; else everything.
Interval reciprocal(const Interval& a) {
    return a.low > 0.0 || a.high < 0.0 ? Interval{1.0 / a.high, 1.0 / a.low} : everything;
}

/// a^p for a constant p.
Interval power(const Interval& a, double p) {
    if (p == 0.0) return {1.0, 1.0};
    const bool is_whole = p == std::floor(p);
    if (p < 0.0) return a.low > 0.0 || (is_whole && a.high < 0.0) ? reciprocal(power(a, -p)) : everything;
    const double low = std::pow(a.low, p), high = std::pow(a.high, p);
    if (a.low >= 0.0) return {low, high};
    if (!is_whole) return everything;  // a negative number has no such power
    const bool is_odd = std::fmod(p, 2.0) != 0.0;
    if (is_odd) return {low, high};
    return {a.high < 0.0 ? high : 0.0, std::max(low, high)};
}

template <class F>
Interval rising(const Interval& a, F f) {
    return {f(a.low), f(a.high)};
}

/// A value and its slopes over the variables.
struct Jet {
    Interval value;
    std::vector<Interval> slopes;

    bool is_fixed() const {
        return std::ranges::all_of(slopes, [](const Interval& slope) { return slope == nothing; });
    }
};

class Evaluator {
public:
    explicit Evaluator(std::size_t variables) : may_fail(variables, false), variables_(variables) {}

    /// Variables at some value of which a part of the formula is not finite. The result is undefined there: NaN
    /// passes through sums, is dropped by comparisons, and gives 0 in the end.
    std::vector<bool> may_fail;

    Jet constant(const Interval& value) const { return {value, std::vector<Interval>(variables_, nothing)}; }

    Jet apply(Operation operation, const Jet& a, const Jet& b, const Jet& c) {
        switch (operation) {
            case Operation::negate: return chain(-a.value, a, {-1.0, -1.0});
            case Operation::add: return sum(a, b, a.value + b.value, {1.0, 1.0}, {1.0, 1.0});
            case Operation::subtract: return sum(a, b, a.value + -b.value, {1.0, 1.0}, {-1.0, -1.0});
            case Operation::multiply: return sum(a, b, a.value * b.value, b.value, a.value);
            case Operation::multiply_add: return apply(Operation::add, apply(Operation::multiply, a, b, c), c, c);
            case Operation::multiply_subtract:
                return apply(Operation::subtract, apply(Operation::multiply, a, b, c), c, c);
            case Operation::subtract_product:
                return apply(Operation::subtract, c, apply(Operation::multiply, a, b, c), c);
            case Operation::multiply_multiply:
                return apply(Operation::multiply, apply(Operation::multiply, a, b, c), c, c);
            case Operation::divide: {
                if (b.value.low <= 0.0 && b.value.high >= 0.0) fail_with(a), fail_with(b);
                const Interval per = reciprocal(b.value);
                return sum(a, b, a.value * per, per, -(a.value * per * per));
            }
            case Operation::power: return raised(a, b);
            case Operation::minimum:
            case Operation::maximum: return extreme(a, b, operation == Operation::maximum);
            case Operation::clip: return extreme(extreme(a, b, true), c, false);
            case Operation::absolute:
                if (a.value.low >= 0.0) return a;
                if (a.value.high <= 0.0) return chain(-a.value, a, {-1.0, -1.0});
                return chain({0.0, std::max(-a.value.low, a.value.high)}, a, unit);
            case Operation::square_root:
                if (a.value.low < 0.0) return failed(a);
                return chain(power(a.value, 0.5), a, Interval{0.5, 0.5} * power(a.value, -0.5));
            case Operation::exponential: {
                const Interval value = rising(a.value, [](double x) { return std::exp(x); });
                return chain(value, a, value);
            }
            case Operation::logarithm:
                if (!(a.value.low > 0.0)) return failed(a);
                return chain(rising(a.value, [](double x) { return std::log(x); }), a, reciprocal(a.value));
            case Operation::sine:
            case Operation::cosine: return chain(unit, a, unit);
            case Operation::tangent: {
                constexpr double quarter = 0.5 * std::numbers::pi;
                if (!(a.value.low > -quarter && a.value.high < quarter)) return jump(a, everything);
                const Interval value = rising(a.value, [](double x) { return std::tan(x); });
                return chain(value, a, power(value, 2.0) + Interval{1.0, 1.0});
            }
            case Operation::arc_sine:
            case Operation::arc_cosine: {
                if (!(a.value.low >= -1.0 && a.value.high <= 1.0)) return failed(a);
                const Interval slope = power(Interval{1.0, 1.0} + -power(a.value, 2.0), -0.5);
                if (operation == Operation::arc_sine)
                    return chain(rising(a.value, [](double x) { return std::asin(x); }), a, slope);
                return chain({std::acos(a.value.high), std::acos(a.value.low)}, a, -slope);
            }
            case Operation::arc_tangent:
                return chain(rising(a.value, [](double x) { return std::atan(x); }), a,
                             reciprocal(power(a.value, 2.0) + Interval{1.0, 1.0}));
            case Operation::hypotenuse:
                return sum(a, b, {0.0, std::hypot(furthest(a.value), furthest(b.value))}, unit, unit);
            case Operation::choose: return choice(a, b, c);
            case Operation::less:
            case Operation::less_equal:
            case Operation::greater:
            case Operation::greater_equal:
            case Operation::equal:
            case Operation::not_equal: return compared(operation, a, b);
            case Operation::both:
            case Operation::either: return jump_of(a, b, truth);
            case Operation::opposite: return jump(a, truth);
            case Operation::sign: return jump(a, unit);
            case Operation::floor: return jump(a, rising(a.value, [](double x) { return std::floor(x); }));
            case Operation::ceiling: return jump(a, rising(a.value, [](double x) { return std::ceil(x); }));
            case Operation::modulo: fail_with(a), fail_with(b); return jump_of(a, b, everything);
            case Operation::arc_tangent_of_two: return jump_of(a, b, everything);
        }
        return jump_of(a, b, everything);
    }

private:
    static double furthest(const Interval& a) { return std::max(std::abs(a.low), std::abs(a.high)); }

    /// f(a), of which `value` and `slope` are given.
    static Jet chain(const Interval& value, const Jet& a, const Interval& slope) {
        Jet result{value, a.slopes};
        for (Interval& over : result.slopes) over = over * slope;
        return result;
    }
    /// f(a, b) with its slopes over a and over b.
    static Jet sum(const Jet& a, const Jet& b, const Interval& value, const Interval& over_a, const Interval& over_b) {
        Jet result{value, a.slopes};
        for (std::size_t i = 0; i < result.slopes.size(); ++i)
            result.slopes[i] = a.slopes[i] * over_a + b.slopes[i] * over_b;
        return result;
    }
    /// A function that may jump wherever a changes.
    static Jet jump(const Jet& a, const Interval& value) {
        Jet result{value, a.slopes};
        for (Interval& slope : result.slopes)
            if (!(slope == nothing)) slope = everything;
        return result;
    }
    static Jet jump_of(const Jet& a, const Jet& b, const Interval& value) {
        Jet result = jump(a, value);
        for (std::size_t i = 0; i < result.slopes.size(); ++i)
            if (!(b.slopes[i] == nothing)) result.slopes[i] = everything;
        return result;
    }
    static Jet either_of(const Jet& a, const Jet& b, const Interval& value) {
        Jet result{value, a.slopes};
        for (std::size_t i = 0; i < result.slopes.size(); ++i) result.slopes[i] = hull(a.slopes[i], b.slopes[i]);
        return result;
    }
    static Jet extreme(const Jet& a, const Jet& b, bool largest) {
        const Jet &low = largest ? b : a, &high = largest ? a : b;
        if (low.value.high <= high.value.low) return a;
        if (high.value.high <= low.value.low) return b;
        const Interval &u = a.value, &v = b.value;
        return either_of(a, b,
                         largest ? Interval{std::max(u.low, v.low), std::max(u.high, v.high)}
                                 : Interval{std::min(u.low, v.low), std::min(u.high, v.high)});
    }
    void fail_with(const Jet& a) {
        for (std::size_t i = 0; i < a.slopes.size(); ++i)
            if (!(a.slopes[i] == nothing)) may_fail[i] = true;
    }
    Jet failed(const Jet& a) {
        fail_with(a);
        return jump(a, everything);
    }
    Jet raised(const Jet& a, const Jet& b) {
        if (!b.value.is_point() || !b.is_fixed()) {
            fail_with(a);
            fail_with(b);
            return jump_of(a, b, everything);
        }
        const double p = b.value.low;
        if (a.value.low < 0.0 && p != std::floor(p)) return failed(a);
        if (a.value.low <= 0.0 && a.value.high >= 0.0 && p < 0.0) return failed(a);
        return chain(power(a.value, p), a, Interval{p, p} * power(a.value, p - 1.0));
    }
    Jet choice(const Jet& condition, const Jet& a, const Jet& b) const {
        const Interval& is = condition.value;
        if (is == nothing) return b;
        if (is.low > 0.0 || is.high < 0.0) return a;
        Jet result = either_of(a, b, hull(a.value, b.value));
        for (std::size_t i = 0; i < result.slopes.size(); ++i)
            if (!(condition.slopes[i] == nothing)) result.slopes[i] = everything;
        return result;
    }
    Jet compared(Operation operation, const Jet& a, const Jet& b) const {
        const auto decided = [this](bool is) { return constant(is ? Interval{1.0, 1.0} : nothing); };
        const Interval &u = a.value, &v = b.value;
        if (operation == Operation::less || operation == Operation::less_equal) {
            if (u.high < v.low) return decided(true);
            if (u.low > v.high) return decided(false);
        } else if (operation == Operation::greater || operation == Operation::greater_equal) {
            if (u.low > v.high) return decided(true);
            if (u.high < v.low) return decided(false);
        } else if (u.high < v.low || u.low > v.high) return decided(operation == Operation::not_equal);
        return jump_of(a, b, truth);
    }

    std::size_t variables_;
};

}  // namespace

std::vector<double> slope_bounds(const Program& program, std::span<const Interval> ranges) {
    Evaluator evaluator(program.variables);
    std::vector<Jet> registers(std::max<std::size_t>(program.registers, 1), evaluator.constant(nothing));
    for (std::size_t i = 0; i < program.variables; ++i) {
        registers[i].value = i < ranges.size() ? ranges[i] : Interval{};
        registers[i].slopes[i] = {1.0, 1.0};
    }
    for (std::size_t k = 0; k < program.constants.size(); ++k)
        registers[program.variables + k].value = {program.constants[k], program.constants[k]};
    for (const Instruction& i : program.instructions)
        registers[i.to] = evaluator.apply(i.operation, registers[i.a], registers[i.b], registers[i.c]);
    std::vector<double> bounds;
    for (const Interval& slope : registers[program.result].slopes) {
        const double most = std::max(std::abs(slope.low), std::abs(slope.high));
        bounds.push_back(std::isnan(most) || evaluator.may_fail[bounds.size()] ? infinite : most);
    }
    return bounds;
}

}  // namespace tactus::formula
