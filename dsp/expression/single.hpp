// SPDX-License-Identifier: Apache-2.0
// A program that runs for one value of each variable.
#pragma once

#include "dsp/expression/program.hpp"

#include <cstdint>
#include <vector>

namespace tactus::expression {

/// Runs a program one value at a time, with the bits of `Machine`. Two common operations in sequence are one step, and a
/// small formula lies in the object itself: at one value per call, finding the code and the memory costs more than the
/// arithmetic.
class Single {
public:
    Single() = default;
    // It points into itself.
    Single(const Single&) = delete;
    Single& operator=(const Single&) = delete;

    /// Allocates; the rest is real-time safe, once this was called.
    void prepare(const Program& program);
    /// Where the value of a variable is put before `run`; all are 0 at first.
    double& variable(std::size_t index) noexcept { return registers_[index]; }
    double run() noexcept {
        const Step* step = steps_;
        double value = step->run(registers_, *step);
        while (++step != past_) value = step->run(registers_, *step);
        return value;
    }

private:
    /// One instruction or two. It gives the value of the last.
    struct Step {
        double (*run)(double* registers, const Step& step) noexcept = nullptr;
        std::uint8_t to = 0, a = 0, b = 0, c = 0;
        std::uint8_t to2 = 0, a2 = 0, b2 = 0, c2 = 0;
    };
    struct Steps;  ///< the functions of all steps
    static constexpr std::size_t most_near_steps = 2, most_near_registers = 9;  ///< two cache lines with the pointers

    const Step *steps_ = nullptr, *past_ = nullptr;
    double* registers_ = near_registers_;
    Step near_steps_[most_near_steps];
    double near_registers_[most_near_registers] = {};
    std::vector<Step> far_steps_;
    std::vector<double> far_registers_;
};

}  // namespace tactus::expression
