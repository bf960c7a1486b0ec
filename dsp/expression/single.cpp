// SPDX-License-Identifier: Apache-2.0
#include "dsp/expression/single.hpp"

#include "dsp/expression/operations.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace tactus::expression {

namespace {

constexpr auto operations = static_cast<std::size_t>(Operation::subtract_product) + 1;
/// Any two of these, one after the other, have a step.
constexpr std::array common{
    Operation::negate,  Operation::add,          Operation::subtract,          Operation::multiply,
    Operation::divide,  Operation::less,         Operation::greater,           Operation::minimum,
    Operation::maximum, Operation::absolute,     Operation::square_root,       Operation::clip,
    Operation::choose,  Operation::multiply_add, Operation::multiply_subtract, Operation::subtract_product};

}  // namespace

struct Single::Steps {
    using Function = double (*)(double*, const Step&) noexcept;

    static double copy(double* registers, const Step& step) noexcept { return registers[step.a]; }
    template <Operation operation>
    static double one(double* r, const Step& s) noexcept {
        return r[s.to] = apply_known<operation>(r[s.a], r[s.b], r[s.c]);
    }
    template <Operation first, Operation second>
    static double two(double* r, const Step& s) noexcept {
        r[s.to] = apply_known<first>(r[s.a], r[s.b], r[s.c]);
        return r[s.to2] = apply_known<second>(r[s.a2], r[s.b2], r[s.c2]);
    }

    template <std::size_t... i>
    static constexpr std::array<Function, operations> all_ones(std::index_sequence<i...>) {
        return {one<static_cast<Operation>(i)>...};
    }
    template <std::size_t... i>
    static constexpr std::array<Function, common.size() * common.size()> all_twos(std::index_sequence<i...>) {
        return {two<common[i / common.size()], common[i % common.size()]>...};
    }
    static Step of(const Instruction& i) {
        static constexpr auto ones = all_ones(std::make_index_sequence<operations>());
        return {ones[static_cast<std::size_t>(i.operation)], i.to, i.a, i.b, i.c};
    }
    /// Without a function when the two have none.
    static Step of(const Instruction& i, const Instruction& j) {
        const auto first = std::ranges::find(common, i.operation), second = std::ranges::find(common, j.operation);
        if (first == common.end() || second == common.end()) return {};
        static constexpr auto twos = all_twos(std::make_index_sequence<common.size() * common.size()>());
        const auto at = static_cast<std::size_t>(first - common.begin()) * common.size() +
                        static_cast<std::size_t>(second - common.begin());
        return {twos[at], i.to, i.a, i.b, i.c, j.to, j.a, j.b, j.c};
    }
};

void Single::prepare(const Program& program) {
    std::vector<Step> steps;
    const std::vector<Instruction>& all = program.instructions;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Step both = i + 1 < all.size() ? Steps::of(all[i], all[i + 1]) : Step{};
        steps.push_back(both.run ? both : Steps::of(all[i]));
        if (both.run) ++i;
    }
    // The last instruction makes the result; without any, a variable or a constant is it.
    if (steps.empty()) steps.push_back({Steps::copy, 0, program.result});

    far_steps_.clear();
    far_registers_.clear();
    if (steps.size() <= most_near_steps && program.registers <= most_near_registers) {
        std::ranges::copy(steps, near_steps_);
        std::ranges::fill(near_registers_, 0.0);
        steps_ = near_steps_;
        registers_ = near_registers_;
    } else {
        far_steps_ = std::move(steps);
        far_registers_.assign(program.registers, 0.0);
        steps_ = far_steps_.data();
        registers_ = far_registers_.data();
    }
    past_ = steps_ + (far_steps_.empty() ? steps.size() : far_steps_.size());
    std::ranges::copy(program.constants, registers_ + program.variables);
}

}  // namespace tactus::expression
