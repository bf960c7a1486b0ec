// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/nodes_law.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::bench {

// As a user would write them: doubles within, samples at the border.
struct LawLine {
    static constexpr auto about = "a*x + b";
    In<Signal> x{"a signal"};
    Out<Signal> out{"the law"};
    Param a{"0.7", "-10", "10", "factor"}, b{"0.1", "-10", "10", "offset"};
    void process(const Tick& tick) noexcept {
        const double f = a, g = b;
        for (int i = 0; i < tick.frames; ++i) out[i] = static_cast<float>(f * static_cast<double>(x[i]) + g);
    }
};
TACTUS_NODE(LawLine, x, out, a, b)

struct LawClip {
    static constexpr auto about = "clip(k*x, lo, hi)";
    In<Signal> x{"a signal"};
    Out<Signal> out{"the law"};
    Param k{"3", "-10", "10", "factor"}, lo{"-1", "-10", "10", "least"}, hi{"1", "-10", "10", "most"};
    void process(const Tick& tick) noexcept {
        const double f = k, least = lo, most = hi;
        for (int i = 0; i < tick.frames; ++i)
            out[i] = static_cast<float>(std::min(std::max(f * static_cast<double>(x[i]), least), most));
    }
};
TACTUS_NODE(LawClip, x, out, k, lo, hi)

struct LawCube {
    static constexpr auto about = "x*x*x - y";
    In<Signal> x{"a signal"}, y{"a signal"};
    Out<Signal> out{"the law"};
    void process(const Tick& tick) noexcept {
        for (int i = 0; i < tick.frames; ++i) {
            const auto a = static_cast<double>(x[i]);
            out[i] = static_cast<float>(a * a * a - static_cast<double>(y[i]));
        }
    }
};
TACTUS_NODE(LawCube, x, y, out)

struct LawWall {
    static constexpr auto about = "(x > 0) * k * x - c*v";
    In<Signal> x{"a signal"}, y{"a signal"};
    Out<Signal> out{"the law"};
    Param k{"3", "-10", "10", "stiffness"}, c{"0.5", "-10", "10", "damping"};
    void process(const Tick& tick) noexcept {
        const double f = k, g = c;
        for (int i = 0; i < tick.frames; ++i) {
            const auto a = static_cast<double>(x[i]);
            out[i] = static_cast<float>((a > 0.0 ? 1.0 : 0.0) * f * a - g * static_cast<double>(y[i]));
        }
    }
};
TACTUS_NODE(LawWall, x, y, out, k, c)

struct LawLength {
    static constexpr auto about = "sqrt(x*x + y*y)";
    In<Signal> x{"a signal"}, y{"a signal"};
    Out<Signal> out{"the law"};
    void process(const Tick& tick) noexcept {
        for (int i = 0; i < tick.frames; ++i) {
            const auto a = static_cast<double>(x[i]), b = static_cast<double>(y[i]);
            out[i] = static_cast<float>(std::sqrt(a * a + b * b));
        }
    }
};
TACTUS_NODE(LawLength, x, y, out)

std::span<const Law> laws() {
    static constexpr Law all[] = {{"a*x + b", "a = 0.7, b = 0.1", "law_line", 1},
                                  {"clip(k*x, lo, hi)", "k = 3, lo = -1, hi = 1", "law_clip", 1},
                                  {"x*x*x - y", "", "law_cube", 2},
                                  {"(x > 0) * k * x - c*y", "k = 3, c = 0.5", "law_wall", 2},
                                  {"sqrt(x*x + y*y)", "", "law_length", 2}};
    return all;
}

std::span<const NodeType* const> law_nodes() {
    static const std::array all{&node_type_LawLine(), &node_type_LawClip(), &node_type_LawCube(), &node_type_LawWall(),
                                &node_type_LawLength()};
    return all;
}

}  // namespace tactus::bench
