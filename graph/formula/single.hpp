// SPDX-License-Identifier: Apache-2.0
// A program that runs for one value of each variable.
#pragma once

#include "graph/formula/program.hpp"

#include <cstddef>
#include <vector>

namespace tactus::formula {

/// Runs a program one value at a time, with the bits of `Machine`: threaded code, in which each operation calls the next
/// as its last act. The result of an operation stays in a register of the processor for the next one, as do the first
/// two variables; the code of each operation knows from where it takes its operands. At one value per call, finding code
/// and operands costs more than the arithmetic.
class Single {
public:
    Single() = default;
    // It points into itself.
    Single(const Single&) = delete;
    Single& operator=(const Single&) = delete;

    /// Allocates; the rest is real-time safe, once this was called.
    void prepare(const Program& program);
    /// The value of a variable from the third one on; it stays until it is put again.
    void put(std::size_t variable, double value) noexcept {
        for (const Use& use : uses_)
            if (use.variable == variable) *use.place = value;
    }
    /// For these values of the first two variables.
    double run(double first, double second) noexcept { return code_->run(code_, 0.0, first, second); }

private:
    /// Code: the function of an operation, then its operands that are in no register, or the place for a result.
    union Word {
        double (*run)(const Word* at, double result, double first, double second) noexcept;
        double value;
        double* place;
    };
    struct Use {
        std::size_t variable;
        double* place;
    };
    struct Steps;  ///< the functions of all operations
    struct Writer;  ///< from instructions to words
    static constexpr std::size_t max_near = 10;

    Word* code_ = near_;
    Word near_[max_near] = {};  ///< a small formula lies in the object itself
    std::vector<Word> far_;
    std::vector<Use> uses_;
};

}  // namespace tactus::formula
