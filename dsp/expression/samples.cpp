// SPDX-License-Identifier: Apache-2.0
// Formulas of signals: loops over samples, for processors with and without AVX2. Both give the same bits: no operation is
// fused or reordered.
#include "dsp/expression/program.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tactus::expression {

namespace {

#if defined(__clang__)
#define TACTUS_EACH_SAMPLE _Pragma("clang loop vectorize(assume_safety)") for (int k = 0; k < count; ++k)
#else
#define TACTUS_EACH_SAMPLE _Pragma("GCC ivdep") for (int k = 0; k < count; ++k)
#endif

[[gnu::always_inline]] inline void run_samples(const Program& program, double* registers, const float* const* inputs,
                                               float* out, int count) noexcept {
    constexpr std::size_t block = Machine::block, most_near = 16;
    // What a small formula computes lies on the stack, which is in the cache; its constants stay where they are.
    alignas(64) double near[most_near * block];
    const std::size_t variables = program.variables, constants = variables + program.constants.size();
    const bool is_small = program.registers - program.constants.size() <= most_near;
    const auto place = [&](std::size_t index) -> double* {
        if (!is_small || (index >= variables && index < constants)) return registers + index * block;
        return near + (index < variables ? index : index - program.constants.size()) * block;
    };
    for (std::size_t i = 0; i < variables; ++i) {
        if (!inputs[i]) continue;
        const float* const in = inputs[i];
        double* const to = place(i);
        TACTUS_EACH_SAMPLE to[k] = static_cast<double>(in[k]);
    }
    for (const Instruction& i : program.instructions) {
        double* const to = place(i.to);
        const double *const a = place(i.a), *const b = place(i.b), *const c = place(i.c);
        switch (i.operation) {
            case Operation::negate: TACTUS_EACH_SAMPLE to[k] = -a[k]; break;
            case Operation::add: TACTUS_EACH_SAMPLE to[k] = a[k] + b[k]; break;
            case Operation::subtract: TACTUS_EACH_SAMPLE to[k] = a[k] - b[k]; break;
            case Operation::multiply: TACTUS_EACH_SAMPLE to[k] = a[k] * b[k]; break;
            case Operation::divide: TACTUS_EACH_SAMPLE to[k] = a[k] / b[k]; break;
            case Operation::multiply_add: TACTUS_EACH_SAMPLE to[k] = a[k] * b[k] + c[k]; break;
            case Operation::multiply_subtract: TACTUS_EACH_SAMPLE to[k] = a[k] * b[k] - c[k]; break;
            case Operation::subtract_product: TACTUS_EACH_SAMPLE to[k] = c[k] - a[k] * b[k]; break;
            case Operation::less: TACTUS_EACH_SAMPLE to[k] = a[k] < b[k] ? 1.0 : 0.0; break;
            case Operation::greater: TACTUS_EACH_SAMPLE to[k] = a[k] > b[k] ? 1.0 : 0.0; break;
            case Operation::minimum:
                TACTUS_EACH_SAMPLE {
                    const double x = a[k], y = b[k];
                    to[k] = y < x ? y : x;
                }
                break;
            case Operation::maximum:
                TACTUS_EACH_SAMPLE {
                    const double x = a[k], y = b[k];
                    to[k] = x < y ? y : x;
                }
                break;
            case Operation::absolute: TACTUS_EACH_SAMPLE to[k] = std::abs(a[k]); break;
            case Operation::square_root: TACTUS_EACH_SAMPLE to[k] = std::sqrt(a[k]); break;
            case Operation::choose:
                TACTUS_EACH_SAMPLE {
                    const double yes = b[k], no = c[k];
                    to[k] = a[k] != 0.0 ? yes : no;
                }
                break;
            case Operation::clip:
                TACTUS_EACH_SAMPLE {
                    const double x = a[k], least = b[k], greatest = c[k], low = x > least ? x : least;
                    to[k] = greatest < low ? greatest : low;
                }
                break;
            default: run_instruction(i.operation, to, a, b, c, count);
        }
    }
    const double* const result = place(program.result);
    // The top bit of the sum is set where the size, as an integer, is above that of the largest float. Rarely.
    constexpr double largest = std::numeric_limits<float>::max();
    constexpr std::uint64_t sign = std::uint64_t{1} << 63, room = sign - std::bit_cast<std::uint64_t>(largest) - 1;
    std::uint64_t beyond = 0;
    TACTUS_EACH_SAMPLE {
        out[k] = static_cast<float>(result[k]);
        beyond |= (std::bit_cast<std::uint64_t>(result[k]) & ~sign) + room;
    }
    if ((beyond & sign) != 0)
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

}  // namespace tactus::expression
