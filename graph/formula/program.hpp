// SPDX-License-Identifier: Apache-2.0
// A formula as a list of instructions.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tactus::formula {

enum class Operation : std::uint8_t {
    negate,
    add,
    subtract,
    multiply,
    divide,
    power,
    modulo,
    less,
    less_equal,
    greater,
    greater_equal,
    equal,
    not_equal,
    both,
    either,
    opposite,
    minimum,
    maximum,
    absolute,
    square_root,
    exponential,
    logarithm,
    sine,
    cosine,
    tangent,
    arc_sine,
    arc_cosine,
    arc_tangent,
    arc_tangent_of_two,
    hypotenuse,
    floor,
    ceiling,
    sign,
    clip,
    choose,
    multiply_add,       ///< a·b + c, rounded twice as the formula says
    multiply_subtract,  ///< a·b − c
    subtract_product,   ///< c − a·b
    multiply_multiply,  ///< (a·b)·c
};

/// registers[to] = operation(registers[a], registers[b], registers[c]).
struct Instruction {
    Operation operation;
    std::uint8_t to = 0, a = 0, b = 0, c = 0;
    /// `a` is a variable that nothing else reads: a loop over samples takes it from where it comes. Set by Machine.
    bool reads_input = false;
};

/// Runs one instruction on `count` values. Of `samples.cpp`, for what has no loop of its own there.
void run_instruction(Operation operation, double* to, const double* a, const double* b, const double* c,
                     int count) noexcept;
/// The loops of samples: for this processor.
using SampleLoop = void (*)(const struct Program&, double*, const float* const*, float*, int) noexcept;
SampleLoop sample_loop() noexcept;

/// The value of one operation. IEEE 754; comparisons give 1 or 0, and 0 counts as false.
double apply(Operation operation, double a, double b, double c) noexcept;

/// Instructions over registers: first the variables, then the constants, then what lies between.
struct Program {
    static constexpr std::size_t max_registers = 256;

    std::size_t variables = 0;
    std::vector<double> constants;
    std::size_t registers = 0;  ///< of all kinds
    std::vector<Instruction> instructions;
    std::uint8_t result = 0;  ///< register
    std::uint64_t read_directly = 0;  ///< a bit for each variable below 64 that an instruction takes from its input

    /// The formula names this variable.
    bool uses(std::size_t variable) const noexcept;
    /// How many operands it is.
    std::size_t count_of(std::size_t variable) const noexcept;
};

/// A result as a sample: 0 when it is not finite, the end of the range when it is beyond that of a float.
inline float sample_of(double value) noexcept {
    constexpr double largest = std::numeric_limits<float>::max();
    if (std::abs(value) <= largest) return static_cast<float>(value);
    return std::isfinite(value) ? static_cast<float>(value < 0.0 ? -largest : largest) : 0.0f;
}

/// A program with its registers, for many values at a time. The constructor allocates; the rest is real-time safe.
class Machine {
public:
    static constexpr int block = 64;

    Machine() = default;
    explicit Machine(Program program);

    /// Where the values of a variable are put before a run: one, or up to `block` of them.
    double* variable(std::size_t index) noexcept { return registers_.data() + index * block; }
    /// The values for the first `count` ≤ block values of each variable.
    std::span<const double> run(int count) noexcept;
    /// Samples in, samples out: `inputs` has a place for each variable, null for one that the formula does not name. A
    /// result that is not finite becomes 0, one beyond the range of a float its end. The same bits as `run`.
    void run(const float* const* inputs, float* out, int count) noexcept;

private:
    Program program_;
    std::vector<double> registers_;  ///< `block` values each
    SampleLoop loop_ = sample_loop();
};

}  // namespace tactus::formula
