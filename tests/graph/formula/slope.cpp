// SPDX-License-Identifier: Apache-2.0
#include "graph/formula/slope.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "graph/formula/formula.hpp"
#include "graph/formula/single.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::formula;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<double> bounds(const std::string& formula, const std::string& names, const std::string& constants = "") {
    const auto variables = parse_variables(names);
    std::vector<Interval> ranges;
    for (const Variable& v : variables) ranges.push_back(v.range);
    return slope_bounds(compile_formula(formula, variables, parse_constants(constants)).program, ranges);
}

double bound(const std::string& formula, const std::string& names, const std::string& constants = "") {
    return bounds(formula, names, constants)[0];
}

}  // namespace

TEST_CASE("the slope of a wall is its stiffness, without any range") {
    CHECK(bound("k * max(0 m, depth)", "depth m", "k = 0.8 N/mm") == 800.0);
    CHECK(bound("clip(-k * x, -2 N, 2 N)", "x m", "k = 3 N/mm") == 3000.0);
    CHECK(bounds("k * x - c * v", "x m, v m/s", "k = 1 N/m, c = 2 N s/m") == std::vector<double>{1.0, 2.0});
    CHECK(bound("abs(x)", "x") == 1.0);
    CHECK(bound("3", "x") == 0.0);
    CHECK(bound("hypot(x, 1) + sin(2 * x)", "x") == 3.0);
}

TEST_CASE("a range bounds a slope that is unlimited without it") {
    CHECK(bound("k * max(0 m, d)^1.5", "d m", "k = 4 N/m^1.5") == infinite);
    CHECK(bound("k * max(0 m, d)^1.5", "d m from -1 m to 0.25 m", "k = 4 N/m^1.5") == Approx(4.0 * 1.5 * 0.5));
    CHECK(bound("x^2", "x from -3 to 2") == Approx(6.0));
    CHECK(bound("x^3", "x from -3 to 2") == Approx(27.0));
    CHECK(bound("1 / x", "x from 0.5 to 2") == Approx(4.0));
    CHECK(bound("exp(x)", "x from 0 to 1") == Approx(std::exp(1.0)));
    CHECK(bound("sqrt(x)", "x from 0.25 to 9") == Approx(1.0));
    CHECK(bound("tan(x)", "x from -0.5 to 1") == Approx(1.0 / std::pow(std::cos(1.0), 2)));
}

TEST_CASE("a jump has no slope, unless it cannot happen") {
    for (const char* formula : {"x > 0", "if(x > 0, 1, 2)", "floor(x)", "sign(x)", "x % 2", "sqrt(x)", "log(x)",
                                "1 / x", "(x > 0) * x", "not x", "atan2(x, 1)", "2^x", "acos(x)"}) {
        INFO(formula);
        CHECK(bound(formula, "x") == infinite);
    }
    CHECK(bound("if(x > 0, 3 * x, 100 * x)", "x from 1 to 2") == 3.0);
    CHECK(bound("if(y > 0, 3 * x, 7 * x)", "x, y") == 7.0);
    CHECK(bounds("if(y > 0, 3 * x, 7 * x)", "x, y")[1] == infinite);
}

TEST_CASE("no slope between two points of any formula is above its bound", "[long]") {
    const Random random{99};
    std::uint64_t draws = 0;
    const auto pick = [&](int n) { return static_cast<int>(random.uniform(draws++) * n); };
    const std::function<std::string(int)> formula = [&](int deep) -> std::string {
        if (deep == 0) return pick(3) == 0 ? std::to_string(pick(5) - 2) : std::string(1, "xyz"[pick(3)]);
        const std::string a = formula(deep - 1);
        const auto with = [&](const char* name) {
            return std::string(name) + "(" + a + ", " + formula(deep - 1) + ")";
        };
        const auto of = [&](const char* name) { return std::string(name) + "(" + a + ")"; };
        switch (pick(16)) {
            case 0: return "(" + a + " + " + formula(deep - 1) + ")";
            case 1: return "(" + a + " - " + formula(deep - 1) + ")";
            case 2:
            case 3: return "(" + a + " * " + formula(deep - 1) + ")";
            case 4: return "(" + a + " / (" + formula(deep - 1) + "))";
            case 5: return with("min");
            case 6: return with("max");
            case 7: return of("abs");
            case 8: return of("sin");
            case 9: return of("atan");
            case 10: return "(" + a + ")^" + std::to_string(pick(4));
            case 11: return of("exp");
            case 12: return of("sqrt");
            case 13: return with("hypot");
            case 14: return "if(" + a + " > 0, " + formula(deep - 1) + ", " + formula(deep - 1) + ")";
            default: return "clip(" + a + ", -1, " + formula(deep - 1) + ")";
        }
    };
    const std::string names = "x from -1 to 2, y from 0.5 to 3, z from -4 to -1";
    const auto variables = parse_variables(names);
    int finite = 0;
    for (int i = 0; i < 4000; ++i) {
        const std::string text = formula(1 + pick(4));
        Formula compiled;
        try {
            compiled = compile_formula(text, variables, {});
        } catch (const Error&) {
            continue;
        }
        const auto most = bounds(text, names);
        Single single;
        single.prepare(compiled.program);
        const auto value = [&](const std::array<double, 3>& at) {
            single.put(2, at[2]);
            const double v = single.run(at[0], at[1]);
            return std::isfinite(v) ? v : 0.0;  // as the node does
        };
        for (std::size_t over = 0; over < 3; ++over) {
            if (!(most[over] < 1e6)) continue;
            ++finite;
            for (int n = 0; n < 20; ++n) {
                std::array<double, 3> at{};
                for (std::size_t k = 0; k < 3; ++k) {
                    const Interval& range = variables[k].range;
                    at[k] = range.low + (range.high - range.low) * random.uniform(draws++);
                }
                std::array<double, 3> other = at;
                const Interval& range = variables[over].range;
                other[over] = range.low + (range.high - range.low) * random.uniform(draws++);
                const double moved = std::abs(other[over] - at[over]);
                const double u = value(at), v = value(other);
                INFO(text << " over " << "xyz"[over] << ", bound " << most[over]);
                REQUIRE(std::abs(u - v) <=
                        most[over] * moved * (1.0 + 1e-9) + 1e-9 * (1.0 + std::abs(u) + std::abs(v)));
            }
        }
    }
    CHECK(finite > 4000);
}

TEST_CASE("a range is given in the unit of its variable") {
    const auto variables = parse_variables("x m from -1 mm to 2 cm, n from 0 to 1, v m/s");
    CHECK(variables[0].range == Interval{-1e-3, 0.02});
    CHECK(variables[0].unit == "m");
    CHECK(variables[1].range == Interval{0.0, 1.0});
    CHECK(variables[1].unit.empty());
    CHECK(variables[2].range == Interval{});
    for (const char* bad : {"x m from 0 to 1", "x m from 1 mm", "x m from 2 mm to 1 mm", "x from 0 to",
                            "x m from 0 N to 1 N", "x from 0 to inf", "x m from a to b"}) {
        INFO(bad);
        CHECK_THROWS_WITH(parse_variables(bad),
                          ContainsSubstring("needs a range in its own unit") || ContainsSubstring("unknown unit"));
    }
}
