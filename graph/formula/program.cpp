// SPDX-License-Identifier: Apache-2.0
#include "graph/formula/program.hpp"

#include "graph/formula/operations.hpp"

#include <algorithm>
#include <utility>

namespace tactus::formula {

double apply(Operation operation, double a, double b, double c) noexcept {
    double result = 0.0;
    with_function(operation, [&](auto function) { result = function(a, b, c); });
    return result;
}

bool Program::uses(std::size_t variable) const noexcept { return result == variable || count_of(variable) > 0; }

std::size_t Program::count_of(std::size_t variable) const noexcept {
    std::size_t count = 0;
    for (const Instruction& i : instructions) {
        const std::uint8_t operands[] = {i.a, i.b, i.c};
        for (std::size_t k = 0; k < operands_of(i.operation); ++k) count += operands[k] == variable;
    }
    return count;
}

Machine::Machine(Program program) : program_(std::move(program)), registers_(program_.registers * block) {
    for (std::size_t k = 0; k < program_.constants.size(); ++k)
        std::fill_n(variable(program_.variables + k), block, program_.constants[k]);
    // A product or a sum takes a variable first: the bits are the same.
    for (Instruction& i : program_.instructions) {
        const bool swaps = i.operation == Operation::add || i.operation == Operation::multiply ||
                           i.operation == Operation::multiply_add || i.operation == Operation::multiply_subtract ||
                           i.operation == Operation::subtract_product || i.operation == Operation::multiply_multiply;
        if (swaps && i.a >= program_.variables && i.b < program_.variables) std::swap(i.a, i.b);
    }
    for (Instruction& i : program_.instructions) {
        i.reads_input = i.a < std::min<std::size_t>(program_.variables, 64) && program_.count_of(i.a) == 1;
        if (i.reads_input) program_.read_directly |= std::uint64_t{1} << i.a;
    }
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

}  // namespace tactus::formula
