// SPDX-License-Identifier: Apache-2.0
// The words of a formula.
#pragma once

#include "dsp/expression/measure.hpp"

#include <string>
#include <string_view>

namespace tactus::expression {

struct Token {
    enum Kind { number, name, symbol, end } kind = end;
    std::string_view text;
    std::size_t at = 0;  ///< offset in the formula
    double value = 0.0;  ///< of a number, SI
    Measure measure{};
};

/// Reads tokens one by one. A number takes the unit that follows it.
class Scanner {
public:
    explicit Scanner(std::string_view text) : text_(text) { next(); }

    const Token& now() const { return token_; }
    /// Throws Error for a letter that has no meaning, a number out of range or an unknown unit.
    void next();
    /// Throws Error at the present token.
    [[noreturn]] void fail(const std::string& message) const { fail_at(token_, message); }
    [[noreturn]] static void fail_at(const Token& token, const std::string& message);

private:
    void read_number();
    std::string_view unit_ahead() const;

    std::string_view text_;
    std::size_t at_ = 0;
    Token token_;
};

/// A letter that may begin a name; bytes beyond ASCII belong to Greek letters and the like.
bool begins_name(char letter);
/// The name that `text` begins with, or nothing.
std::string_view name_ahead(std::string_view text);

}  // namespace tactus::expression
