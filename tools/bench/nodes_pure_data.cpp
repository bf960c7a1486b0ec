// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/nodes_pure_data.hpp"
#include "dsp/core/processor_time.hpp"

#include <time.h>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace tactus::bench {

namespace {

constexpr int block = 64;
using Block = std::array<float, block>;

/// One object of a signal graph: its state, its places, and what it calls.
struct Object {
    const float *in1 = nullptr, *in2 = nullptr;
    float* out = nullptr;
    double phase = 0.0;
    float last = 0.0f, before = 0.0f, c1 = 0.0f, c2 = 0.0f, gain = 0.0f;
    std::uint32_t value = 1;
    void (*perform)(Object&) = nullptr;
};

void plus(Object& o) {
    for (int i = 0; i < block; ++i) o.out[i] = o.in1[i] + o.in2[i];
}
void times(Object& o) {
    for (int i = 0; i < block; ++i) o.out[i] = o.in1[i] * o.in2[i];
}

/// A cosine by linear interpolation in a table of 2048 points; the frequency is a signal.
void oscillator(Object& o) {
    constexpr int points = 2048;
    static const std::array<float, points + 1> table = [] {
        std::array<float, points + 1> made{};
        for (std::size_t i = 0; i <= points; ++i)
            made[i] = static_cast<float>(std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / points));
        return made;
    }();
    constexpr double per_hertz = points / 48000.0;
    double phase = o.phase;
    for (int i = 0; i < block; ++i) {
        const auto whole = static_cast<std::int64_t>(phase);
        const auto share = static_cast<float>(phase - static_cast<double>(whole));
        const float* const at = table.data() + (whole & (points - 1));
        o.out[i] = at[0] + share * (at[1] - at[0]);
        phase += static_cast<double>(o.in1[i]) * per_hertz;
    }
    o.phase = phase >= 1e9 ? std::fmod(phase, points) : phase;
}

/// Two poles and a gain: y = x + c1 y' + c2 y''.
void bandpass(Object& o) {
    float last = o.last, before = o.before;
    for (int i = 0; i < block; ++i) {
        const float y = o.in1[i] + o.c1 * last + o.c2 * before;
        o.out[i] = o.gain * y;
        before = last;
        last = y;
    }
    o.last = last;
    o.before = before;
}

/// A linear congruential generator of 32 bits, uniform in [-1, 1).
void noise(Object& o) {
    std::uint32_t value = o.value;
    for (int i = 0; i < block; ++i) {
        value = value * 435898247u + 382842987u;
        o.out[i] = static_cast<float>(static_cast<std::int32_t>(value & 0x7fffffffu) - 0x40000000) * 0x1.0p-30f;
    }
    o.value = value;
}

double ns_of(void (*perform)(Object&), bool is_oscillator, int count) {
    const auto n = static_cast<std::size_t>(count);
    std::vector<Block> places(n + 2);
    for (std::size_t i = 0; i < block; ++i) {
        places[n][i] = is_oscillator ? 440.0f : static_cast<float>(std::sin(0.05 * static_cast<double>(i)));
        places[n + 1][i] = static_cast<float>(std::cos(0.03 * static_cast<double>(i)));
    }
    std::vector<Object> objects(n);
    // 250 Hz with q 1: radius by the width of the band, gain 1 at the centre.
    const double w = 2.0 * std::numbers::pi * 250.0 / 48000.0, r = 1.0 - w;
    for (std::size_t k = 0; k < n; ++k) {
        Object& o = objects[k];
        o.in1 = places[n].data();
        o.in2 = places[n + 1].data();
        o.out = places[k].data();
        o.c1 = static_cast<float>(2.0 * std::cos(w) * r);
        o.c2 = static_cast<float>(-r * r);
        o.gain = static_cast<float>(2.0 * (1.0 - r) * (1.0 - r + r * w));
        o.value = static_cast<std::uint32_t>(k);
        o.perform = perform;
    }
    constexpr int calls = 3000;
    const double begin = process_seconds();
    for (int i = 0; i < calls; ++i)
        for (Object& o : objects) o.perform(o);
    return (process_seconds() - begin) * 1e9 / (static_cast<double>(calls) * count);
}

}  // namespace

std::vector<PureDataTwin> pure_data_twins() {
    const auto timed = [](void (*perform)(Object&), bool is_oscillator = false) {
        return [=](int count) { return ns_of(perform, is_oscillator, count); };
    };
    return {{"+~", "add", {"a", "b"}, "", timed(plus)},
            {"*~", "multiply", {"a", "b"}, "", timed(times)},
            {"osc~", "oscillator", {}, "shape = \"sine\"\nfrequency = \"440 Hz\"\n", timed(oscillator, true)},
            {"bp~", "filter", {"in"}, "kind = \"bandpass\"\nfrequency = \"250 Hz\"\nq = 1\n", timed(bandpass)},
            {"noise~", "noise", {}, "", timed(noise)}};
}

}  // namespace tactus::bench
