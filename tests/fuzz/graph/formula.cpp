// SPDX-License-Identifier: Apache-2.0
// compile_formula: any text is a program that stays within its registers, or a tactus::Error.
#include "graph/formula/formula.hpp"
#include "dsp/core/error.hpp"
#include "graph/formula/single.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tactus::formula;
    static const auto variables = parse_variables("x m, v m/s, n");
    static const auto constants = parse_constants("k = 3 N/m^1.5, c = 2 N s/m");
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        Formula formula = compile_formula(text, variables, constants);
        for (const Instruction& i : formula.program.instructions)
            for (const std::uint8_t place : {i.to, i.a, i.b, i.c})
                if (place >= formula.program.registers) std::abort();
        if (formula.program.result >= formula.program.registers) std::abort();
        Machine machine(formula.program);
        for (std::size_t i = 0; i < variables.size(); ++i) *machine.variable(i) = 0.5;
        Single single;
        single.prepare(formula.program);
        single.put(2, 0.5);
        single.run(0.5, 0.5);
        machine.run(Machine::block);
    } catch (const tactus::Error&) {
        // Refusing is right for most texts.
    }
    try {
        static_cast<void>(parse_variables(text));
        static_cast<void>(parse_constants(text));
    } catch (const tactus::Error&) {
        // Refusing is right for most texts.
    }
    return 0;
}
