// SPDX-License-Identifier: Apache-2.0
#include "graph/formula/formula.hpp"
#include "graph/formula/single.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::formula;
using Catch::Matchers::ContainsSubstring;

namespace {

/// The value of a formula over x m, v m/s and the bare n.
double value_of(std::string_view text, double x = 0.0, double v = 0.0, double n = 0.0,
                std::string_view constants = "") {
    const auto names = parse_variables("x m, v m/s, n");
    const Program program = compile_formula(text, names, parse_constants(constants)).program;
    Machine machine(program);
    Single single;
    single.prepare(program);
    const double given[] = {x, v, n};
    single.put(2, n);
    const double one = single.run(x, v);
    // A block gives the same, for each of its values.
    for (std::size_t i = 0; i < 3; ++i)
        for (int k = 0; k < 5; ++k) machine.variable(i)[k] = given[i];
    for (const double other : machine.run(5)) CHECK((other == one || (std::isnan(other) && std::isnan(one))));
    return one;
}

std::string unit_of(std::string_view text, std::string_view constants = "") {
    return compile_formula(text, parse_variables("x m, v m/s, n"), parse_constants(constants)).measure.text();
}

std::string refusal(std::string_view text, std::string_view constants = "") {
    try {
        unit_of(text, constants);
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

}  // namespace

TEST_CASE("operators bind as in mathematics") {
    for (const auto& [text, value] : std::map<std::string, double>{{"1 + 2*3", 7.0},
                                                                   {"(1 + 2)*3", 9.0},
                                                                   {"2 - 3 - 4", -5.0},
                                                                   {"24/4/2", 3.0},
                                                                   {"-2^2", -4.0},
                                                                   {"(-2)^2", 4.0},
                                                                   {"2^3^2", 512.0},
                                                                   {"2^-1", 0.5},
                                                                   {"2**3", 8.0},
                                                                   {"-2*-3", 6.0},
                                                                   {"--2", 2.0},
                                                                   {"7 % 3", 1.0},
                                                                   {"-7 % 3", 2.0},
                                                                   {"7 % -3", -2.0},
                                                                   {"1 < 2", 1.0},
                                                                   {"1 + 1 >= 3", 0.0},
                                                                   {"not 0 and 1", 1.0},
                                                                   {"not (1 or 0)", 0.0},
                                                                   {"1 == 1 and 2 != 2 or 1", 1.0},
                                                                   {"1e3 + .5", 1000.5},
                                                                   {"min(3, 1, 2)", 1.0},
                                                                   {"max(3, 1, 2)", 3.0},
                                                                   {"max(1, 2 + 3, 2*2)", 5.0},
                                                                   {"clip(7, -1, 3)", 3.0},
                                                                   {"clip(-7, -1, 3)", -1.0},
                                                                   {"if(2 > 1, 10, 20)", 10.0},
                                                                   {"hypot(3, 4)", 5.0},
                                                                   {"floor(-1.5) + ceil(1.2)", 0.0},
                                                                   {"sign(-3) + sign(0) + sign(5)", 0.0},
                                                                   {"sin(90 deg)", 1.0},
                                                                   {"2*pi", 2.0 * std::numbers::pi},
                                                                   {"atan2(1, 1)/(1 rad)", std::numbers::pi / 4.0},
                                                                   {"log(exp(2))", 2.0},
                                                                   {"sqrt(2)", std::sqrt(2.0)}}) {
        INFO(text);
        CHECK(value_of(text) == Approx(value));
    }
}

TEST_CASE("a formula of variables has the value of the C++ expression, to the bit") {
    const double x = 0.0123, v = -0.4, n = 1.7;
    CHECK(value_of("k * max(0 m, x)^1.5 - c*v", x, v, n, "k = 3 N/m^1.5, c = 2 N s/m") ==
          3.0 * std::pow(x, 1.5) - 2.0 * v);
    CHECK(value_of("(x > 0 m) * k * x - c * v", x, v, n, "k = 0.8 N/mm, c = 2 N s/m") == 800.0 * x - 2.0 * v);
    CHECK(value_of("n*n*n - n", x, v, n) == n * n * n - n);
    CHECK(value_of("n^2 + n^3", x, v, n) == n * n + std::pow(n, 3.0));
    // Products in a row, and a product that is taken twice.
    CHECK(value_of("n * n * 3 * n", x, v, n) == n * n * 3.0 * n);
    CHECK(value_of("n * (n * 3) * n", x, v, n) == n * (n * 3.0) * n);
    CHECK(value_of("(n * 3)^2", x, v, n) == (n * 3.0) * (n * 3.0));
    CHECK(value_of("(n * 3 * n)^2 - n", x, v, n) == (n * 3.0 * n) * (n * 3.0 * n) - n);
    CHECK(value_of("n * 3 * n - n * n * 5", x, v, n) == n * 3.0 * n - n * n * 5.0);
    CHECK(value_of("sqrt(x*x + x*x)/x", x, v, n) == std::sqrt(x * x + x * x) / x);
    CHECK(value_of("min(n, max(2, 3*n) - n, 5)", x, v, n) == std::min(n, std::max(2.0, 3.0 * n) - n));
    CHECK(value_of("x", x) == x);
    CHECK(value_of("3 mm") == 3.0 * 1e-3);
}

TEST_CASE("units follow the formula, with fractions of exponents") {
    CHECK(unit_of("x/v") == "s");
    CHECK(unit_of("k*x", "k = 0.8 N/mm") == "N");
    CHECK(unit_of("k*x^1.5", "k = 3 N/m^1.5") == "N");
    CHECK(unit_of("x^0.5") == "m^0.5");
    CHECK(unit_of("sqrt(x*x)") == "m");
    CHECK(unit_of("x > 0 m") == "a number");
    CHECK(unit_of("1/(2 s)") == "Hz");
    CHECK(unit_of("2*pi*n * 1 rad/s") == "rad/s");
    CHECK(unit_of("if(n, x, 2 mm)") == "m");
    CHECK(unit_of("x * 1 N") == "N m");
    CHECK(unit_of("5 N m/rad") == "N m/rad");
    CHECK(unit_of("hypot(x, 3 mm)") == "m");
}

TEST_CASE("quantities of different kinds are not mixed, and the message names both") {
    CHECK_THAT(refusal("x + v"), ContainsSubstring("m and m/s"));
    CHECK_THAT(refusal("max(0, x)"), ContainsSubstring("a number and m"));
    CHECK_THAT(refusal("x < 1"), ContainsSubstring("comparison"));
    CHECK_THAT(refusal("sin(x)"), ContainsSubstring("not m"));
    CHECK_THAT(refusal("x^n"), ContainsSubstring("constant"));
    CHECK_THAT(refusal("x^0.3"), ContainsSubstring("0.3"));
    CHECK_THAT(refusal("2^x"), ContainsSubstring("exponent"));
    CHECK_THAT(refusal("1 Hz + 1 rad/s"), ContainsSubstring("Hz and rad/s"));
    CHECK_THAT(refusal("exp(x)"), ContainsSubstring("without unit"));
    CHECK_THAT(refusal("if(x, 1, 2)"), ContainsSubstring("condition"));
}

TEST_CASE("what is no formula is refused with its column") {
    CHECK_THAT(refusal("x + "), ContainsSubstring("ends too early"));
    CHECK_THAT(refusal("(x"), ContainsSubstring("')' is missing"));
    CHECK_THAT(refusal("x x"), ContainsSubstring("column 3"));
    CHECK_THAT(refusal("2 x"), ContainsSubstring("needs a '*'"));
    CHECK_THAT(refusal("1 $ 2"), ContainsSubstring("'$' has no meaning"));
    CHECK_THAT(refusal("y"), ContainsSubstring("nothing is named 'y'"));
    CHECK_THAT(refusal("sqr(n)"), ContainsSubstring("did you mean 'sqrt'"));
    CHECK_THAT(refusal("sin(1, 2)"), ContainsSubstring("takes one value, not 2"));
    CHECK_THAT(refusal("max(n)"), ContainsSubstring("two values or more"));
    CHECK_THAT(refusal("1 < n < 2"), ContainsSubstring("chained"));
    CHECK_THAT(refusal("1/0"), ContainsSubstring("no finite value"));
    CHECK_THAT(refusal("1e999"), ContainsSubstring("out of range"));
    CHECK_THAT(refusal(""), ContainsSubstring("ends too early"));
    CHECK_THAT(refusal(std::string(100, '(') + "1" + std::string(100, ')')), ContainsSubstring("nested"));
    CHECK_THAT(refusal(std::string(500, '-') + "1"), ContainsSubstring("nested"));
    CHECK_THAT(refusal(std::string(3000, '1')), ContainsSubstring("letters"));
}

TEST_CASE("lists of names are read, and slips in them are told") {
    CHECK(parse_variables("").empty());
    CHECK(parse_variables("x m, v m/s,n").size() == 3);
    CHECK(parse_constants("k = 0.8 N/mm").front().value == 800.0);
    CHECK_THROWS_WITH(parse_variables("x m, x"), ContainsSubstring("twice"));
    CHECK_THROWS_WITH(parse_variables("1x"), ContainsSubstring("name"));
    CHECK_THROWS_WITH(parse_variables("x m,, v"), ContainsSubstring("commas"));
    CHECK_THROWS_WITH(parse_variables("and"), ContainsSubstring("word"));
    CHECK_THROWS_WITH(parse_variables("x parsecs"), ContainsSubstring("unknown unit"));
    CHECK_THROWS_WITH(parse_constants("k 0.8 N/mm"), ContainsSubstring("needs a value"));
    CHECK_THROWS_WITH(parse_constants("k = N"), ContainsSubstring("needs a value"));
}

TEST_CASE("a long formula with many parts keeps them apart") {
    // A sum of products, each of which stays while the next is computed.
    std::string text = "0";
    double sum = 0.0;
    for (int i = 1; i <= 20; ++i) {
        text += " + (n + " + std::to_string(i) + ")*(n - " + std::to_string(i) + ")";
        sum += (1.5 + i) * (1.5 - i);
    }
    CHECK(value_of(text, 0.0, 0.0, 1.5) == Approx(sum));
    std::string nested = "n";
    double value = 0.5;
    for (int i = 0; i < 12; ++i) {
        nested = "(n - (" + nested + ")*(n + 1))";
        value = 0.5 - value * 1.5;
    }
    CHECK(value_of(nested, 0.0, 0.0, 0.5) == Approx(value));
}

TEST_CASE("a declared name behind a number's unit is a factor, and a name that is a unit too is refused") {
    const auto with = [](std::string_view inputs, std::string_view text) {
        const auto names = parse_variables(inputs);
        Single single;
        single.prepare(compile_formula(text, names, {}).program);
        return single.run(3.0, 0.0);
    };
    CHECK(with("x m", "2 N/mm*x") == 6000.0);
    CHECK(with("x m", "6 N/x") == 2.0);
    CHECK(with("x m", "6 N/m*x/x") == 6.0);
    CHECK(with("s s", "6 m / s") == 2.0);
    CHECK(with("x m", "6 m/s") == 6.0);
    CHECK_THROWS_WITH(with("s s", "6 m/s"), ContainsSubstring("'s' is a unit and a name"));
    CHECK_THROWS_WITH(with("m m", "6 N*m"), ContainsSubstring("around the '*'"));
}

TEST_CASE("a remainder of zero has the sign of the divisor, as in Python") {
    CHECK_FALSE(std::signbit(value_of("n % 3", 0.0, 0.0, -6.0)));
    CHECK(std::signbit(value_of("n % -3", 0.0, 0.0, 6.0)));
    CHECK(value_of("n % 3", 0.0, 0.0, -7.0) == 2.0);
}

TEST_CASE("loops over samples give the bits of single values, whatever the samples are") {
    const float infinite = std::numeric_limits<float>::infinity();
    const std::vector<float> odd{0.0f, -0.0f, 1.5f, -2.25f, 3e38f, -3e38f, 1e-42f, infinite, -infinite, std::nanf("")};
    for (const char* text :
         {"n + y",
          "n - y",
          "n*y",
          "n/y",
          "-n",
          "n*y + n",
          "n*y - 3",
          "2 - n*y",
          "n*y - y*n",
          "min(n, y)",
          "max(n, y)",
          "abs(n) + 1",
          "sqrt(n)",
          "clip(n, -1, y)",
          "if(n, y, 2)",
          "n < y",
          "n > y",
          "n <= y",
          "n == y",
          "n % y",
          "sin(n)*y",
          "n^3 + y^2",
          "hypot(n, y)",
          "n*1e30*y*1e30",
          "y",
          "7",
          "(n+1)*((y+2)*((n+3)*((y+4)*((n+5)*((y+6)*((n+7)*((y+8)*((n+9)*((y+10)*((n+11)*((y+12)*((n+13)*((y+14)*"
          "((n+15)*((y+16)*((n+17)*(y+18)))))))))))))))))"}) {
        INFO(text);
        const Program program = compile_formula(text, parse_variables("n, y, unused"), {}).program;
        Machine machine(program);
        Single single;
        single.prepare(program);
        std::vector<float> n, y, out(Machine::block);
        for (std::size_t k = 0; k < Machine::block; ++k) {
            n.push_back(k < 30 ? odd[k % odd.size()] : 0.1f * static_cast<float>(k) - 3.0f);
            y.push_back(k < 30 ? odd[(k / 3) % odd.size()] : 2.0f - 0.3f * static_cast<float>(k % 17));
        }
        for (const int count : {Machine::block, 37, 2}) {
            const float* const places[] = {n.data(), y.data(), nullptr};
            machine.run(places, out.data(), count);
            for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
                const float one = sample_of(single.run(static_cast<double>(n[k]), static_cast<double>(y[k])));
                CAPTURE(k, n[k], y[k], out[k], one);
                CHECK(std::isfinite(out[k]));
                CHECK(out[k] == one);
            }
        }
    }
}
