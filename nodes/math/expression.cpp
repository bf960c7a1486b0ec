// SPDX-License-Identifier: Apache-2.0
#include "graph/formula/formula.hpp"
#include "graph/formula/single.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace tactus::nodes {

/// Parses a text; errors refer to its place in the patch.
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

    // What each call of one value uses lies side by side: the first input, the output, and how the formula runs.
    AnyIn in1{"the first name of 'inputs'", types};
    AnyOut out{"the value of the formula, in SI units"};

private:
    enum class Quick : std::uint8_t { none, one, two };
    Quick quick_ = Quick::none;  ///< a formula of signals that names only the first input, or the first two
    std::uint8_t uses_ = 0;      ///< a bit for each input that the formula names
    bool is_signal_ = false, has_ranges_ = false;
    formula::Single single_;

public:
    AnyIn in2{optional, "the second name", types}, in3{optional, "the third name", types};
    AnyIn in4{optional, "the fourth name", types}, in5{optional, "the fifth name", types};
    AnyIn in6{optional, "the sixth name", types};
    Text formula{"x", "what is computed, as in \"k * x - c * v\""};
    Text inputs{"x, y, z, u, v, w",
                "names of in1, in2, … with their units: \"x m, v m/s\"; a name without a unit is a bare number. \"x m "
                "from 0 mm to "
                "5 mm\" clamps an input to a range, for which check knows the slope of the formula"};
    Text constants{"", "names with their values: \"k = 0.8 N/mm, c = 2 N s/m\""};
    Text unit{"", "unit of the result, as \"N\"; empty for a bare number"};

    void prepare(const Setup& setup) {
        const std::vector<formula::Variable> names = read_text(setup, inputs, formula::parse_variables);
        count_ = names.size();
        if (count_ == 0 || count_ > max_inputs) setup.fail("an expression has one to six inputs; 'inputs' names them");
        const std::vector<formula::Constant> values = read_text(setup, constants, formula::parse_constants);
        for (const auto& value : values)
            if (std::ranges::find(names, value.name, &formula::Variable::name) != names.end())
                throw Error(constants.where, "'" + value.name + "' is an input already");
        formula::Formula compiled = read_text(
            setup, formula, [&](const std::string& text) { return formula::compile_formula(text, names, values); });
        const formula::Measure wanted =
            read_text(setup, unit, [](const std::string& text) { return formula::parse_measured_unit(text).measure; });
        if (!(compiled.measure == wanted))
            throw Error(unit.value.empty() ? formula.where : unit.where,
                        "the formula gives " + compiled.measure.text() + ", but 'unit' is " + wanted.text());
        check_wires(setup, names, compiled.program);
        has_ranges_ = false;
        for (std::size_t i = 0; i < count_; ++i) {
            ranges_[i] = names[i].range;
            sample_ranges_[i] = samples_in(names[i].range);
            has_ranges_ = has_ranges_ || has_range(i);
        }
        single_.prepare(compiled.program);
        machine_ = formula::Machine(std::move(compiled.program));
        is_signal_ = out.type == &value::signal;
        const bool is_quick = is_signal_ && !has_ranges_ && uses_ <= 3 && in1.connected;
        quick_ = !is_quick ? Quick::none : uses_ > 1 ? Quick::two : Quick::one;
    }

    void process(const Tick& tick) noexcept {
        if (tick.frames != 1 || quick_ == Quick::none) return process_any(tick);
        const double second = quick_ == Quick::two ? static_cast<double>(*in2.as<float>()) : 0.0;
        *out.as<float>() = formula::sample_of(single_.run(static_cast<double>(*in1.as<float>()), second));
    }

    /// The unit that `inputs` or `unit` gives a port; a name without one takes any.
    std::string unit_of(std::string_view port) const {
        if (port == "out") return unit.value;
        const std::vector<formula::Variable> names = formula::parse_variables(inputs.value);
        const auto at = static_cast<std::size_t>(port.back() - '1');
        return at < names.size() ? names[at].unit : "";
    }

    std::vector<PortSlope> slopes() const {
        const std::vector<formula::Variable> names = formula::parse_variables(inputs.value);
        const formula::Formula compiled =
            formula::compile_formula(formula.value, names, formula::parse_constants(constants.value));
        std::vector<formula::Interval> ranges;
        for (const formula::Variable& name : names) ranges.push_back(name.range);
        std::vector<PortSlope> slopes;
        for (const double bound : formula::slope_bounds(compiled.program, ranges)) {
            const std::string port = "in" + std::to_string(slopes.size() + 1);
            slopes.push_back({port, bound});
        }
        return slopes;
    }

private:
    static constexpr std::size_t max_inputs = 6;

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
    static SampleRange samples_in(const formula::Interval& range) noexcept {
        SampleRange out{static_cast<float>(range.low), static_cast<float>(range.high)};
        constexpr float most = std::numeric_limits<float>::infinity();
        if (static_cast<double>(out.low) < range.low) out.low = std::nextafter(out.low, most);
        if (static_cast<double>(out.high) > range.high) out.high = std::nextafter(out.high, -most);
        if (out.low > out.high) out.low = out.high = static_cast<float>(range.low);  // no sample lies within
        return out;
    }
    static constexpr ValueKinds types = kinds::number | kinds::signal;

    void check_wires(const Setup& setup, const std::vector<formula::Variable>& names, const formula::Program& program) {
        const AnyIn* const ports[] = {&in1, &in2, &in3, &in4, &in5, &in6};
        uses_ = 0;
        for (std::size_t i = 0; i < std::size(ports); ++i) {
            const std::string port = "in" + std::to_string(i + 1);
            if (i < count_ && !ports[i]->connected && program.uses(i))
                setup.fail("'" + names[i].name + "' needs a wire to '" + port + "'");
            if (i < count_ && program.uses(i)) uses_ = static_cast<std::uint8_t>(uses_ | 1u << i);
            if (i >= count_ && ports[i]->connected) setup.fail("'" + port + "' has a wire but no name in 'inputs'");
        }
    }

    [[gnu::noinline]] void process_any(const Tick& tick) noexcept {
        if (!is_signal_) {
            const double result = run_one<double>();
            *out.as<double>() = std::abs(result) <= std::numeric_limits<double>::max() ? result : 0.0;
        } else if (tick.frames == 1) {
            *out.as<float>() = formula::sample_of(run_one<float>());
        } else {
            process_samples(tick);
        }
    }

    /// The value of the formula for the first value of each input.
    template <class Value>
    double run_one() noexcept {
        if (uses_ > 3) {
            const AnyIn* const others[] = {&in3, &in4, &in5, &in6};
            for (std::size_t i = 2; i < max_inputs; ++i)
                if ((uses_ >> i & 1) != 0) single_.put(i, read<Value>(*others[i - 2], i));
        }
        return single_.run((uses_ & 1) != 0 ? read<Value>(in1, 0) : 0.0, (uses_ & 2) != 0 ? read<Value>(in2, 1) : 0.0);
    }
    template <class Value>
    double read(const AnyIn& port, std::size_t input) const noexcept {
        const Value x = *port.as<Value>();
        if (!has_ranges_) return static_cast<double>(x);
        if constexpr (std::is_same_v<Value, float>) return static_cast<double>(sample_within(x, input));
        else return within(x, ranges_[input].low, ranges_[input].high);
    }

    void process_samples(const Tick& tick) noexcept {
        const AnyIn* const ports[] = {&in1, &in2, &in3, &in4, &in5, &in6};
        const float* places[max_inputs];
        float clamped[max_inputs][formula::Machine::block];
        for (int from = 0; from < tick.frames; from += formula::Machine::block) {
            const int frames = std::min(tick.frames - from, formula::Machine::block);
            for (std::size_t i = 0; i < count_; ++i) {
                const bool is_used = (uses_ >> i & 1) != 0;
                places[i] = is_used ? ports[i]->as<float>() + from : nullptr;
                if (!is_used || !has_range(i)) continue;
                for (int k = 0; k < frames; ++k) clamped[i][k] = sample_within(places[i][k], i);
                places[i] = clamped[i];
            }
            machine_.run(places, out.as<float>() + from, frames);
        }
    }

    formula::Machine machine_;
    formula::Interval ranges_[max_inputs] = {};
    SampleRange sample_ranges_[max_inputs] = {};
    std::size_t count_ = 0;
};

TACTUS_NODE(Expression, in1, in2, in3, in4, in5, in6, out, formula, inputs, constants, unit)

}  // namespace tactus::nodes
