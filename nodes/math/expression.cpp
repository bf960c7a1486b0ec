// SPDX-License-Identifier: Apache-2.0
#include "dsp/expression/formula.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace tactus::nodes {

/// What `parse` makes of a text; its errors stand where the text stands.
template <class Parse>
static auto read_text(const Setup& setup, const Text& text, Parse&& parse) {
    try {
        return parse(text.value);
    } catch (const Error& error) {
        throw Error(text.where.line > 0 ? text.where : setup.where, error.message());
    }
}

struct Expression {
    static constexpr auto about =
        "A formula over numbers or signals, with its units checked. Operators + - * / % ^, comparisons (1 or 0), and "
        "or not; "
        "functions min max abs sqrt exp log sin cos tan asin acos atan atan2 hypot floor ceil sign clip(x, low, high) "
        "if(condition, then, else); pi. A number may carry a unit: \"k * max(0 m, depth)^1.5\". A result that is not "
        "finite "
        "gives 0.";
    static constexpr bool shapes_values = true;

    AnyIn in1{"the first name of 'inputs'", types};
    AnyIn in2{optional, "the second name", types}, in3{optional, "the third name", types};
    AnyIn in4{optional, "the fourth name", types}, in5{optional, "the fifth name", types};
    AnyIn in6{optional, "the sixth name", types};
    AnyOut out{"the value of the formula, in SI units"};
    Text formula{"x", "what is computed, as in \"k * x - c * v\""};
    Text inputs{"x, y, z, u, v, w",
                "names of in1, in2, … with their units: \"x m, v m/s\"; a name without a unit is a bare number"};
    Text constants{"", "names with their values: \"k = 0.8 N/mm, c = 2 N s/m\""};
    Text unit{"", "unit of the result, as \"N\"; empty for a bare number"};

    void prepare(const Setup& setup) {
        const std::vector<expression::Variable> names = read_text(setup, inputs, expression::parse_variables);
        count_ = names.size();
        if (count_ == 0 || count_ > most_inputs) setup.fail("an expression has one to six inputs; 'inputs' names them");
        const std::vector<expression::Constant> values = read_text(setup, constants, expression::parse_constants);
        for (const auto& value : values)
            if (std::ranges::find(names, value.name, &expression::Variable::name) != names.end())
                throw Error(constants.where, "'" + value.name + "' is an input already");
        expression::Formula compiled = read_text(
            setup, formula, [&](const std::string& text) { return expression::compile_formula(text, names, values); });
        const expression::Measure wanted = read_text(
            setup, unit, [](const std::string& text) { return expression::parse_measured_unit(text).measure; });
        if (!(compiled.measure == wanted))
            throw Error(unit.value.empty() ? formula.where : unit.where,
                        "the formula gives " + compiled.measure.text() + ", but 'unit' says " + wanted.text());
        check_wires(setup, names, compiled.program);
        machine_ = expression::Machine(std::move(compiled.program));
        is_signal_ = out.type == &value::signal;
    }

    void process(const Tick& tick) noexcept {
        if (is_signal_) return process_signal(tick);
        for (std::size_t i = 0; i < count_; ++i)
            if (used_[i]) machine_.single(i) = *used_[i]->as<double>();
        const double result = machine_.run_one();
        *out.as<double>() = std::abs(result) <= std::numeric_limits<double>::max() ? result : 0.0;
    }

private:
    static constexpr std::size_t most_inputs = 6;
    static constexpr ValueKinds types = kinds::number | kinds::signal;

    void check_wires(const Setup& setup, const std::vector<expression::Variable>& names,
                     const expression::Program& program) {
        const AnyIn* const ports[] = {&in1, &in2, &in3, &in4, &in5, &in6};
        for (std::size_t i = 0; i < std::size(ports); ++i) {
            const std::string port = "in" + std::to_string(i + 1);
            if (i < count_ && !ports[i]->connected && program.uses(i))
                setup.fail("'" + names[i].name + "' needs a wire to '" + port + "'");
            used_[i] = i < count_ && program.uses(i) ? ports[i] : nullptr;
            if (i >= count_ && ports[i]->connected) setup.fail("'" + port + "' has a wire but no name in 'inputs'");
        }
    }

    void process_signal(const Tick& tick) noexcept {
        if (tick.frames == 1) {
            for (std::size_t i = 0; i < count_; ++i)
                if (used_[i]) machine_.single(i) = static_cast<double>(*used_[i]->as<float>());
            *out.as<float>() = expression::sample_of(machine_.run_one());
            return;
        }
        const float* places[most_inputs];
        for (int from = 0; from < tick.frames; from += expression::Machine::block) {
            const int frames = std::min(tick.frames - from, expression::Machine::block);
            for (std::size_t i = 0; i < count_; ++i) places[i] = used_[i] ? used_[i]->as<float>() + from : nullptr;
            machine_.run(places, out.as<float>() + from, frames);
        }
    }

    expression::Machine machine_;
    std::size_t count_ = 0;
    const AnyIn* used_[most_inputs] = {};  ///< the port of each name that the formula has
    bool is_signal_ = false;
};

TACTUS_NODE(Expression, in1, in2, in3, in4, in5, in6, out, formula, inputs, constants, unit)

}  // namespace tactus::nodes
