// SPDX-License-Identifier: Apache-2.0
#include "graph/formula/emitter.hpp"

#include "dsp/core/error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace tactus::formula {

Operand Emitter::emit(Operation operation, std::span<const Operand> operands, const Measure& measure) {
    const auto known = [&](std::size_t i) { return i < operands.size() ? operands[i].constant.value_or(0.0) : 0.0; };
    if (std::ranges::all_of(operands, &Operand::is_constant)) {
        const double value = apply(operation, known(0), known(1), known(2));
        if (!std::isfinite(value)) throw Error("a part of the formula without variables has no finite value");
        return constant(value, measure);
    }
    // A square is a product: cheaper, and rounded once.
    if (operation == Operation::power && operands[1].constant == 2.0) {
        const Operand square[] = {operands[0], operands[0]};
        return emit(Operation::multiply, square, measure);
    }
    std::size_t lowest = height_;
    for (const Operand& operand : operands)
        if (!operand.constant && !operand.variable) lowest = std::min(lowest, operand.between);
    Pending instruction{operation, lowest, {}, operands.size()};
    std::ranges::copy(operands, instruction.operands);
    pending_.push_back(instruction);
    height_ = lowest + 1;
    highest_ = std::max(highest_, height_);
    if (variables_ + highest_ > Program::max_registers / 2) throw Error("the formula is too long");
    return {measure, {}, {}, lowest};
}

std::size_t Emitter::constant_index(double value) {
    // By bits: 0 and -0 differ.
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const auto same = [bits](double other) { return std::bit_cast<std::uint64_t>(other) == bits; };
    const auto found = std::ranges::find_if(constants_, same);
    if (found != constants_.end()) return static_cast<std::size_t>(found - constants_.begin());
    if (constants_.size() >= Program::max_registers / 2) throw Error("the formula has too many constants");
    constants_.push_back(value);
    return constants_.size() - 1;
}

std::uint8_t Emitter::register_of(const Operand& operand) {
    if (operand.variable) return static_cast<std::uint8_t>(*operand.variable);
    if (operand.constant) return static_cast<std::uint8_t>(variables_ + constant_index(*operand.constant));
    return static_cast<std::uint8_t>(variables_ + constants_.size() + operand.between);
}

void Emitter::join_products() {
    // One operand; a square takes the same one twice.
    const auto takes = [](const Pending& p, std::size_t place) {
        return 1 == std::count_if(p.operands, p.operands + p.count, [place](const Operand& o) {
                   return !o.constant && !o.variable && o.between == place;
               });
    };
    const auto is_sum = [](const Pending& p) {
        return p.operation == Operation::add || p.operation == Operation::subtract;
    };
    std::vector<Pending> joined;
    for (std::size_t n = 0; n < pending_.size(); ++n) {
        const Pending& p = pending_[n];
        // A result between is used once: by the instruction that finds it in the place where it was just put.
        const bool follows =
            !joined.empty() && joined.back().operation == Operation::multiply && takes(p, joined.back().to);
        // A product of three only where the second one does not join a sum.
        const bool is_product = p.operation == Operation::multiply &&
                                !(n + 1 < pending_.size() && is_sum(pending_[n + 1]) && takes(pending_[n + 1], p.to));
        if (!follows || !(is_sum(p) || is_product)) {
            joined.push_back(p);
            continue;
        }
        Pending& product = joined.back();
        const Operand& left = p.operands[0];
        const bool is_left = !left.constant && !left.variable && left.between == product.to;
        product.operation = is_product                      ? Operation::multiply_multiply
                            : p.operation == Operation::add ? Operation::multiply_add
                            : is_left                       ? Operation::multiply_subtract
                                                            : Operation::subtract_product;
        product.operands[2] = p.operands[is_left ? 1 : 0];
        product.count = 3;
        product.to = p.to;
    }
    pending_ = std::move(joined);
}

Program Emitter::finish(const Operand& result) {
    join_products();
    // Constants come first; the registers of results follow them.
    for (const Pending& p : pending_)
        for (std::size_t i = 0; i < p.count; ++i)
            if (p.operands[i].constant) constant_index(*p.operands[i].constant);
    if (result.constant) constant_index(*result.constant);
    Program program;
    program.variables = variables_;
    for (const Pending& p : pending_) {
        std::uint8_t places[3] = {};
        for (std::size_t i = 0; i < 3; ++i) places[i] = register_of(p.operands[i < p.count ? i : 0]);
        program.instructions.push_back({p.operation, static_cast<std::uint8_t>(variables_ + constants_.size() + p.to),
                                        places[0], places[1], places[2]});
    }
    program.result = register_of(result);
    program.registers = variables_ + constants_.size() + highest_;
    program.constants = std::move(constants_);
    return program;
}

}  // namespace tactus::formula
