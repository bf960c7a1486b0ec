// SPDX-License-Identifier: Apache-2.0
// Formulas of signals: loops over samples, for processors with and without AVX2. Both give the same bits: no operation is
// fused or reordered.
#include "graph/formula/program.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tactus::formula {

namespace {

#if defined(__clang__)
#define TACTUS_EACH_SAMPLE _Pragma("clang loop vectorize(assume_safety)") for (int k = 0; k < count; ++k)
#else
#define TACTUS_EACH_SAMPLE _Pragma("GCC ivdep") for (int k = 0; k < count; ++k)
#endif

/// Calls put(k, value) for each of `count` values of an operation. False: it has no loop here, and `put` was not called.
template <class A, class Put>
[[gnu::always_inline]] inline bool run_loop(Operation operation, const A* given, const double* b, const double* c,
                                            int count, Put put) noexcept {
    struct {
        const A* given;
        double operator[](int k) const noexcept { return static_cast<double>(given[k]); }
    } const a{given};
    switch (operation) {
        case Operation::negate: TACTUS_EACH_SAMPLE put(k, -a[k]); return true;
        case Operation::add: TACTUS_EACH_SAMPLE put(k, a[k] + b[k]); return true;
        case Operation::subtract: TACTUS_EACH_SAMPLE put(k, a[k] - b[k]); return true;
        case Operation::multiply: TACTUS_EACH_SAMPLE put(k, a[k] * b[k]); return true;
        case Operation::divide: TACTUS_EACH_SAMPLE put(k, a[k] / b[k]); return true;
        case Operation::multiply_add: TACTUS_EACH_SAMPLE put(k, a[k] * b[k] + c[k]); return true;
        case Operation::multiply_subtract: TACTUS_EACH_SAMPLE put(k, a[k] * b[k] - c[k]); return true;
        case Operation::subtract_product: TACTUS_EACH_SAMPLE put(k, c[k] - a[k] * b[k]); return true;
        case Operation::multiply_multiply: TACTUS_EACH_SAMPLE put(k, a[k] * b[k] * c[k]); return true;
        case Operation::less: TACTUS_EACH_SAMPLE put(k, a[k] < b[k] ? 1.0 : 0.0); return true;
        case Operation::greater: TACTUS_EACH_SAMPLE put(k, a[k] > b[k] ? 1.0 : 0.0); return true;
        case Operation::minimum:
            TACTUS_EACH_SAMPLE {
                const double x = a[k], y = b[k];
                put(k, y < x ? y : x);
            }
            return true;
        case Operation::maximum:
            TACTUS_EACH_SAMPLE {
                const double x = a[k], y = b[k];
                put(k, x < y ? y : x);
            }
            return true;
        case Operation::absolute: TACTUS_EACH_SAMPLE put(k, std::abs(a[k])); return true;
        case Operation::square_root: TACTUS_EACH_SAMPLE put(k, std::sqrt(a[k])); return true;
        case Operation::choose:
            TACTUS_EACH_SAMPLE {
                const double yes = b[k], no = c[k];
                put(k, a[k] != 0.0 ? yes : no);
            }
            return true;
        case Operation::clip:
            TACTUS_EACH_SAMPLE {
                const double x = a[k], least = b[k], greatest = c[k], low = x > least ? x : least;
                put(k, greatest < low ? greatest : low);
            }
            return true;
        default: return false;
    }
}

constexpr std::uint64_t sign_bit = std::uint64_t{1} << 63;
/// Its top bit is set where the size, as an integer, is above that of the largest float.
[[gnu::always_inline]] inline std::uint64_t beyond_float(double value) noexcept {
    constexpr double largest = std::numeric_limits<float>::max();
    constexpr std::uint64_t room = sign_bit - std::bit_cast<std::uint64_t>(largest) - 1;
    return (std::bit_cast<std::uint64_t>(value) & ~sign_bit) + room;
}

[[gnu::always_inline]] inline void run_samples(const Program& program, double* registers, const float* const* inputs,
                                               float* out, int count) noexcept {
    constexpr std::size_t block = Machine::block, max_near = 16;
    // What a small formula computes lies on the stack, which is in the cache; its constants stay where they are.
    alignas(64) double near[max_near * block];
    const std::size_t variables = program.variables, constants = variables + program.constants.size();
    const bool is_small = program.registers - program.constants.size() <= max_near;
    const auto place = [&](std::size_t index) -> double* {
        if (!is_small || (index >= variables && index < constants)) return registers + index * block;
        return near + (index < variables ? index : index - program.constants.size()) * block;
    };
    const auto widen = [&](std::size_t variable) {
        const float* const in = inputs[variable];
        double* const to = place(variable);
        TACTUS_EACH_SAMPLE to[k] = static_cast<double>(in[k]);
    };
    for (std::size_t i = 0; i < variables; ++i)
        if (inputs[i] && (i >= 64 || (program.read_directly >> i & 1) == 0)) widen(i);
    // The last operation makes samples at once; what a float does not hold is rare, and mended afterwards.
    std::uint64_t beyond = 0;
    const auto put_sample = [out, &beyond](int k, double value) __attribute__((always_inline)) {
        out[k] = static_cast<float>(value);
        beyond |= beyond_float(value);
    };
    const std::size_t many = program.instructions.size();
    for (std::size_t n = 0; n < many; ++n) {
        const Instruction& i = program.instructions[n];
        double* const to = place(i.to);
        const double *const a = place(i.a), *const b = place(i.b), *const c = place(i.c);
        const float* const in = i.reads_input ? inputs[i.a] : nullptr;
        if (n + 1 == many && (in ? run_loop(i.operation, in, b, c, count, put_sample)
                                 : run_loop(i.operation, a, b, c, count, put_sample))) {
            if ((beyond & sign_bit) == 0) return;
            if (in) widen(i.a);
            for (int k = 0; k < count; ++k) out[k] = sample_of(apply(i.operation, a[k], b[k], c[k]));
            return;
        }
        const auto put = [to](int k, double value) __attribute__((always_inline)) { to[k] = value; };
        if (in ? run_loop(i.operation, in, b, c, count, put) : run_loop(i.operation, a, b, c, count, put)) continue;
        if (in) widen(i.a);
        run_instruction(i.operation, to, a, b, c, count);
    }
    const double* const result = place(program.result);
    TACTUS_EACH_SAMPLE put_sample(k, result[k]);
    if ((beyond & sign_bit) != 0)
        for (int k = 0; k < count; ++k) out[k] = sample_of(result[k]);
}

void run_anywhere(const Program& program, double* registers, const float* const* inputs, float* out,
                  int count) noexcept {
    run_samples(program, registers, inputs, out, count);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void run_on_avx2(const Program& program, double* registers, const float* const* inputs,
                                         float* out, int count) noexcept {
    run_samples(program, registers, inputs, out, count);
}
#endif

}  // namespace

SampleLoop sample_loop() noexcept {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return run_on_avx2;
#endif
    return run_anywhere;
}

}  // namespace tactus::formula
