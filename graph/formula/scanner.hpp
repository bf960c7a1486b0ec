// SPDX-License-Identifier: Apache-2.0
// The words of a formula.
#pragma once

#include "graph/formula/measure.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace tactus::formula {

struct Token {
    enum Kind { number, name, symbol, end } kind = end;
    std::string_view text;
    std::size_t at = 0;  ///< offset in the formula
    double value = 0.0;  ///< of a number, SI
    Measure measure{};
};

/// Reads tokens one by one. A number takes the unit that follows it. Behind '*' and '/' a declared name is a factor of
/// the formula, not a unit: "2 N/mm*x"; one that is both, as in "2 m/s" with an input s, is refused.
class Scanner {
public:
    /// `is_declared`: whether the formula has an input or a constant of that name.
    explicit Scanner(std::string_view text, std::function<bool(std::string_view)> is_declared = {})
        : text_(text), is_declared_(std::move(is_declared)) {
        next();
    }

    const Token& now() const { return token_; }
    /// Throws Error for a letter that has no meaning, a number out of range or an unknown unit.
    void next();
    /// Throws Error at the present token.
    [[noreturn]] void fail(const std::string& message) const { fail_at(token_, message); }
    [[noreturn]] static void fail_at(const Token& token, const std::string& message);

private:
    void read_number();
    std::string_view unit_ahead() const;
    /// Whether the name at `at`, behind '*' or '/', belongs to the formula. Throws Error when it may be either.
    bool is_factor(std::size_t at) const;

    std::string_view text_;
    std::function<bool(std::string_view)> is_declared_;
    std::size_t at_ = 0;
    Token token_;
};

/// A letter that may begin a name; bytes beyond ASCII belong to Greek letters and the like.
bool begins_name(char letter);
/// The name that `text` begins with, or nothing.
std::string_view name_ahead(std::string_view text);

}  // namespace tactus::formula
