// SPDX-License-Identifier: Apache-2.0
// From operands to instructions and registers.
#pragma once

#include "graph/formula/measure.hpp"
#include "graph/formula/program.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::formula {

/// A value within a formula.
struct Operand {
    Measure measure{};
    std::optional<double> constant{};  ///< known while compiling
    std::optional<std::size_t> variable{};
    std::size_t between = 0;  ///< register of what was computed, when it is neither

    bool is_constant() const { return constant.has_value(); }
};

/// Emits instructions. Constant subexpressions are folded. Registers of results form a stack: operands must be used in
/// the order in which they were made, the last ones first.
class Emitter {
public:
    explicit Emitter(std::size_t variables) : variables_(variables) {}

    static Operand constant(double value, const Measure& measure) { return {measure, value, {}, 0}; }
    static Operand variable(std::size_t index, const Measure& measure) { return {measure, {}, index, 0}; }
    /// Throws Error when a formula needs too many registers or a constant is not finite.
    Operand emit(Operation operation, std::span<const Operand> operands, const Measure& measure);
    Program finish(const Operand& result);

private:
    struct Pending {
        Operation operation;
        std::size_t to = 0;
        Operand operands[3];
        std::size_t count = 0;
    };

    /// Makes one instruction of a product and the sum, difference or product that takes it.
    void join_products();
    std::size_t constant_index(double value);
    std::uint8_t register_of(const Operand& operand);

    std::size_t variables_, height_ = 0, highest_ = 0;
    std::vector<double> constants_;
    std::vector<Pending> pending_;
};

}  // namespace tactus::formula
