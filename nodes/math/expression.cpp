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
                "names of in1, in2, … with their units: \"x m, v m/s\"; a name without a unit is a bare number. \"x m "
                "from 0 mm to "
                "5 mm\" clamps an input to a range, for which check knows the slope of the formula"};
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
        for (std::size_t i = 0; i < count_; ++i) {
            ranges_[i] = names[i].range;
            sample_ranges_[i] = samples_in(names[i].range);
        }
        machine_ = expression::Machine(std::move(compiled.program));
        is_signal_ = out.type == &value::signal;
    }

    void process(const Tick& tick) noexcept {
        if (is_signal_) return process_signal(tick);
        for (std::size_t i = 0; i < count_; ++i)
            if (used_[i]) machine_.single(i) = within(*used_[i]->as<double>(), ranges_[i].low, ranges_[i].high);
        const double result = machine_.run_one();
        *out.as<double>() = std::abs(result) <= std::numeric_limits<double>::max() ? result : 0.0;
    }

    /// The unit that `inputs` or `unit` gives a port; a name without one takes any.
    std::string unit_of(std::string_view port) const {
        if (port == "out") return unit.value;
        const std::vector<expression::Variable> names = expression::parse_variables(inputs.value);
        const auto at = static_cast<std::size_t>(port.back() - '1');
        return at < names.size() ? names[at].unit : "";
    }

    std::vector<PortSlope> slopes() const {
        const std::vector<expression::Variable> names = expression::parse_variables(inputs.value);
        const expression::Formula compiled =
            expression::compile_formula(formula.value, names, expression::parse_constants(constants.value));
        std::vector<expression::Interval> ranges;
        for (const expression::Variable& name : names) ranges.push_back(name.range);
        std::vector<PortSlope> slopes;
        for (const double bound : expression::slope_bounds(compiled.program, ranges)) {
            const std::string port = "in" + std::to_string(slopes.size() + 1);
            slopes.push_back({port, bound});
        }
        return slopes;
    }

private:
    static constexpr std::size_t most_inputs = 6;

    /// NaN stays NaN.
    template <class Value>
    static Value within(Value x, Value low, Value high) noexcept {
        return x < low ? low : x > high ? high : x;
    }
    bool has_range(std::size_t input) const noexcept {
        return std::isfinite(ranges_[input].low) || std::isfinite(ranges_[input].high);
    }
    float sample_within(float x, std::size_t input) const noexcept {
        return within(x, sample_ranges_[input].low, sample_ranges_[input].high);
    }
    struct SampleRange {
        float low = -std::numeric_limits<float>::infinity(), high = std::numeric_limits<float>::infinity();
    };
    /// The widest range of samples within the stated one.
    static SampleRange samples_in(const expression::Interval& range) noexcept {
        SampleRange out{static_cast<float>(range.low), static_cast<float>(range.high)};
        constexpr float infinity = std::numeric_limits<float>::infinity();
        if (static_cast<double>(out.low) < range.low) out.low = std::nextafter(out.low, infinity);
        if (static_cast<double>(out.high) > range.high) out.high = std::nextafter(out.high, -infinity);
        if (out.low > out.high) out.low = out.high = static_cast<float>(range.low);  // no sample lies within
        return out;
    }
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
                if (used_[i]) machine_.single(i) = static_cast<double>(sample_within(*used_[i]->as<float>(), i));
            *out.as<float>() = expression::sample_of(machine_.run_one());
            return;
        }
        const float* places[most_inputs];
        float clamped[most_inputs][expression::Machine::block];
        for (int from = 0; from < tick.frames; from += expression::Machine::block) {
            const int frames = std::min(tick.frames - from, expression::Machine::block);
            for (std::size_t i = 0; i < count_; ++i) {
                places[i] = used_[i] ? used_[i]->as<float>() + from : nullptr;
                if (!used_[i] || !has_range(i)) continue;
                for (int k = 0; k < frames; ++k) clamped[i][k] = sample_within(places[i][k], i);
                places[i] = clamped[i];
            }
            machine_.run(places, out.as<float>() + from, frames);
        }
    }

    expression::Machine machine_;
    expression::Interval ranges_[most_inputs] = {};
    SampleRange sample_ranges_[most_inputs] = {};
    std::size_t count_ = 0;
    const AnyIn* used_[most_inputs] = {};  ///< the port of each name that the formula has
    bool is_signal_ = false;
};

TACTUS_NODE(Expression, in1, in2, in3, in4, in5, in6, out, formula, inputs, constants, unit)

}  // namespace tactus::nodes
