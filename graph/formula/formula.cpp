// SPDX-License-Identifier: Apache-2.0
#include "graph/formula/formula.hpp"

#include "dsp/core/error.hpp"
#include "graph/formula/emitter.hpp"
#include "graph/formula/scanner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

namespace tactus::formula {

namespace {

constexpr std::size_t longest_text = 2000;
constexpr int deepest = 64;

struct Function {
    std::string_view name;
    Operation operation;
    int arguments;
    enum class Rule { alike, bare, angle, to_angle, root, sign, choose } rule;
};

using Rule = Function::Rule;
constexpr Function functions[] = {
    {"min", Operation::minimum, -1, Rule::alike},
    {"max", Operation::maximum, -1, Rule::alike},
    {"abs", Operation::absolute, 1, Rule::alike},
    {"sqrt", Operation::square_root, 1, Rule::root},
    {"exp", Operation::exponential, 1, Rule::bare},
    {"log", Operation::logarithm, 1, Rule::bare},
    {"sin", Operation::sine, 1, Rule::angle},
    {"cos", Operation::cosine, 1, Rule::angle},
    {"tan", Operation::tangent, 1, Rule::angle},
    {"asin", Operation::arc_sine, 1, Rule::to_angle},
    {"acos", Operation::arc_cosine, 1, Rule::to_angle},
    {"atan", Operation::arc_tangent, 1, Rule::to_angle},
    {"atan2", Operation::arc_tangent_of_two, 2, Rule::to_angle},
    {"hypot", Operation::hypotenuse, 2, Rule::alike},
    {"floor", Operation::floor, 1, Rule::bare},
    {"ceil", Operation::ceiling, 1, Rule::bare},
    {"sign", Operation::sign, 1, Rule::sign},
    {"clip", Operation::clip, 3, Rule::alike},
    {"if", Operation::choose, 3, Rule::choose},
};

const Measure radian = measure_of(parse_unit("rad").dimension);

/// Recursive descent, one function per level of precedence.
class Compiler {
public:
    Compiler(std::string_view text, std::span<const Variable> variables, std::span<const Constant> constants)
        : scanner_(text,
                   [=](std::string_view name) {
                       return std::ranges::find(variables, name, &Variable::name) != variables.end() ||
                              std::ranges::find(constants, name, &Constant::name) != constants.end();
                   }),
          emitter_(variables.size()),
          variables_(variables),
          constants_(constants) {}

    Formula compile() {
        const Operand result = disjunction();
        if (scanner_.now().kind != Token::end) fail(fmt::format("'{}' is not expected here", scanner_.now().text));
        return {emitter_.finish(result), result.measure};
    }

private:
    [[noreturn]] void fail(const std::string& message) const { scanner_.fail(message); }

    bool eat(std::string_view symbol) {
        if (scanner_.now().kind == Token::number || scanner_.now().text != symbol) return false;
        scanner_.next();
        return true;
    }
    void expect(std::string_view symbol) {
        if (!eat(symbol))
            fail(scanner_.now().kind == Token::end
                     ? fmt::format("'{}' is missing at the end", symbol)
                     : fmt::format("'{}' is expected before '{}'", symbol, scanner_.now().text));
    }

    Operand emit(Operation operation, std::span<const Operand> operands, const Measure& measure) {
        try {
            return emitter_.emit(operation, operands, measure);
        } catch (const Error& error) {
            fail(error.message());
        }
    }
    Operand emit(Operation operation, const Operand& a, const Operand& b, const Measure& measure) {
        return emit(operation, std::array{a, b}, measure);
    }

    void need_alike(const Operand& a, const Operand& b, std::string_view what) const {
        if (a.measure == b.measure) return;
        fail(fmt::format("{} needs two quantities of one kind, not {} and {}", what, a.measure.text(),
                         b.measure.text()));
    }
    void need_bare(const Operand& a, std::string_view what) const {
        if (!a.measure.is_bare()) fail(fmt::format("{} needs a number without unit, not {}", what, a.measure.text()));
    }

    Operand disjunction() {
        Operand left = conjunction();
        while (eat("or")) left = logic(Operation::either, left, conjunction(), "or");
        return left;
    }
    Operand conjunction() {
        Operand left = negation();
        while (eat("and")) left = logic(Operation::both, left, negation(), "and");
        return left;
    }
    Operand logic(Operation operation, const Operand& a, const Operand& b, std::string_view name) {
        need_bare(a, fmt::format("'{}'", name));
        need_bare(b, fmt::format("'{}'", name));
        return emit(operation, a, b, {});
    }
    Operand negation() {
        const Depth depth(*this);
        if (!eat("not")) return comparison();
        const Operand a = negation();
        need_bare(a, "'not'");
        return emit(Operation::opposite, std::array{a}, {});
    }

    std::optional<Operation> comparing() {
        constexpr std::pair<std::string_view, Operation> symbols[] = {
            {"<=", Operation::less_equal}, {">=", Operation::greater_equal}, {"==", Operation::equal},
            {"!=", Operation::not_equal},  {"<", Operation::less},           {">", Operation::greater}};
        for (const auto& [symbol, operation] : symbols)
            if (eat(symbol)) return operation;
        return std::nullopt;
    }
    Operand comparison() {
        const Operand left = sum();
        const auto operation = comparing();
        if (!operation) return left;
        const Operand right = sum();
        need_alike(left, right, "a comparison");
        if (comparing()) fail("comparisons cannot be chained: write 'a < b and b < c'");
        return emit(*operation, left, right, {});
    }

    Operand sum() {
        Operand left = product();
        for (;;) {
            const bool adds = eat("+");
            if (!adds && !eat("-")) return left;
            const Operand right = product();
            need_alike(left, right, adds ? "'+'" : "'-'");
            left = emit(adds ? Operation::add : Operation::subtract, left, right, left.measure);
        }
    }
    Operand product() {
        Operand left = signed_value();
        for (;;) {
            if (eat("*")) {
                const Operand right = signed_value();
                left = emit(Operation::multiply, left, right, combine(left, right, 1));
            } else if (eat("/")) {
                const Operand right = signed_value();
                left = emit(Operation::divide, left, right, combine(left, right, -1));
            } else if (eat("%")) {
                const Operand right = signed_value();
                need_alike(left, right, "'%'");
                left = emit(Operation::modulo, left, right, left.measure);
            } else {
                return left;
            }
        }
    }
    Measure combine(const Operand& a, const Operand& b, int sign) const {
        try {
            return combined(a.measure, b.measure, sign);
        } catch (const Error& error) {
            fail(error.message());
        }
    }

    Operand signed_value() {
        const Depth depth(*this);
        if (eat("+")) return signed_value();
        if (!eat("-")) return power();
        const Operand a = signed_value();
        return emit(Operation::negate, std::array{a}, a.measure);
    }
    Operand power() {
        const Operand base = primary();
        if (!eat("^") && !eat("**")) return base;
        const Operand exponent = signed_value();
        need_bare(exponent, "an exponent");
        if (base.measure.is_bare()) return emit(Operation::power, base, exponent, {});
        if (!exponent.is_constant()) fail("the exponent of a quantity with a unit must be a constant");
        const auto measure = raised(base.measure, *exponent.constant);
        if (!measure)
            fail(fmt::format("{} cannot be raised to the power {:.6g}", base.measure.text(), *exponent.constant));
        return emit(Operation::power, base, exponent, *measure);
    }

    Operand primary() {
        const Token token = scanner_.now();
        if (token.kind == Token::number) {
            const Measure measure = token.measure;
            const double value = token.value;
            scanner_.next();
            return emitter_.constant(value, measure);
        }
        if (eat("(")) {
            const Operand inner = disjunction();
            expect(")");
            return inner;
        }
        if (token.kind != Token::name)
            fail(token.kind == Token::end ? "the formula ends too early"
                                          : fmt::format("'{}' is not expected here", token.text));
        scanner_.next();
        if (scanner_.now().text == "(" && scanner_.now().kind == Token::symbol) return call(token);
        return named(token);
    }

    Operand named(const Token& token) {
        for (std::size_t i = 0; i < variables_.size(); ++i)
            if (variables_[i].name == token.text) return emitter_.variable(i, variables_[i].measure);
        for (const Constant& constant : constants_)
            if (constant.name == token.text) return emitter_.constant(constant.value, constant.measure);
        if (token.text == "pi") return emitter_.constant(std::numbers::pi, {});
        std::vector<std::string> names{"pi"};
        for (const Variable& variable : variables_) names.push_back(variable.name);
        for (const Constant& constant : constants_) names.push_back(constant.name);
        for (const Function& function : functions) names.emplace_back(function.name);
        scanner_.fail_at(token, fmt::format("nothing is named '{}'{}", token.text, did_you_mean(token.text, names)));
    }

    Operand call(const Token& token) {
        const Depth depth(*this);
        const Function* function = nullptr;
        std::vector<std::string> names;
        for (const Function& known : functions) {
            names.emplace_back(known.name);
            if (known.name == token.text) function = &known;
        }
        if (!function)
            scanner_.fail_at(token,
                             fmt::format("there is no function '{}'{}", token.text, did_you_mean(token.text, names)));
        expect("(");
        std::vector<Operand> given{disjunction()};
        while (eat(",")) given.push_back(disjunction());
        expect(")");
        const auto count = static_cast<int>(given.size());
        if (function->arguments < 0 ? count < 2 : count != function->arguments)
            scanner_.fail_at(token,
                             fmt::format("'{}' takes {}, not {}", token.text,
                                         function->arguments < 0    ? "two values or more"
                                         : function->arguments == 1 ? "one value"
                                                                    : fmt::format("{} values", function->arguments),
                                         count));
        return result_of(*function, given);
    }

    Operand result_of(const Function& function, const std::vector<Operand>& given) {
        const std::string what = fmt::format("'{}'", function.name);
        Measure measure;
        switch (function.rule) {
            case Rule::alike:
                for (const Operand& operand : given) need_alike(given.front(), operand, what);
                measure = given.front().measure;
                break;
            case Rule::bare: need_bare(given.front(), what); break;
            case Rule::angle:
                if (given.front().measure != radian) need_bare(given.front(), what + " of what is no angle");
                break;
            case Rule::to_angle:
                for (const Operand& operand : given) need_alike(given.front(), operand, what);
                if (given.size() == 1) need_bare(given.front(), what);
                measure = radian;
                break;
            case Rule::root: {
                const auto root = raised(given.front().measure, 0.5);
                if (!root) fail(fmt::format("{} has no square root", given.front().measure.text()));
                measure = *root;
                break;
            }
            case Rule::sign: break;
            case Rule::choose:
                need_bare(given[0], "the condition of 'if'");
                need_alike(given[1], given[2], what);
                measure = given[1].measure;
                break;
        }
        // A chain of pairs, from the left.
        if (function.arguments < 0) {
            Operand chain = given.front();
            // The operands lie on a stack: the last two come first.
            std::vector<Operand> left(given.begin(), given.end());
            while (left.size() > 1) {
                const Operand b = left.back();
                left.pop_back();
                chain = emit(function.operation, left.back(), b, measure);
                left.back() = chain;
            }
            return chain;
        }
        return emit(function.operation, given, measure);
    }

    /// Limits the nesting depth, because each level uses the call stack.
    struct Depth {
        explicit Depth(Compiler& compiler) : compiler_(compiler) {
            if (++compiler_.depth_ > deepest) {
                --compiler_.depth_;
                compiler_.fail(fmt::format("the formula is nested more than {} deep", deepest));
            }
        }
        ~Depth() { --compiler_.depth_; }
        Depth(const Depth&) = delete;
        Depth& operator=(const Depth&) = delete;

        Compiler& compiler_;
    };

    Scanner scanner_;
    Emitter emitter_;
    std::span<const Variable> variables_;
    std::span<const Constant> constants_;
    int depth_ = 0;
};

}  // namespace

Formula compile_formula(std::string_view text, std::span<const Variable> variables,
                        std::span<const Constant> constants) {
    if (text.size() > longest_text) throw Error(fmt::format("a formula has at most {} letters", longest_text));
    return Compiler(text, variables, constants).compile();
}

}  // namespace tactus::formula
