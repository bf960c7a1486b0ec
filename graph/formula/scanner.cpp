// SPDX-License-Identifier: Apache-2.0
#include "graph/formula/scanner.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace tactus::formula {

namespace {

bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }
bool is_blank(char letter) { return letter == ' ' || letter == '\t' || letter == '\n'; }
bool is_word(std::string_view name) { return name == "and" || name == "or" || name == "not"; }

constexpr std::string_view symbols[] = {"**", "<=", ">=", "==", "!=", "+", "-", "*",
                                        "/",  "%",  "^",  "(",  ")",  ",", "<", ">"};

}  // namespace

bool begins_name(char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || letter == '_' ||
           static_cast<unsigned char>(letter) >= 0x80;
}

std::string_view name_ahead(std::string_view text) {
    if (text.empty() || !begins_name(text.front())) return {};
    std::size_t length = 1;
    while (length < text.size() && (begins_name(text[length]) || is_digit(text[length]))) ++length;
    return text.substr(0, length);
}

void Scanner::fail_at(const Token& token, const std::string& message) {
    throw Error(fmt::format("column {} of the formula: {}", token.at + 1, message));
}

void Scanner::next() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    token_ = {};
    token_.at = at_;
    if (at_ == text_.size()) return;
    const std::string_view rest = text_.substr(at_);
    if (is_digit(rest[0]) || (rest[0] == '.' && rest.size() > 1 && is_digit(rest[1]))) return read_number();
    if (const std::string_view name = name_ahead(rest); !name.empty()) {
        token_.kind = Token::name;
        token_.text = name;
        at_ += name.size();
        return;
    }
    for (const std::string_view symbol : symbols)
        if (rest.starts_with(symbol)) {
            token_.kind = Token::symbol;
            token_.text = symbol;
            at_ += symbol.size();
            return;
        }
    fail(fmt::format("'{}' has no meaning in a formula", rest[0]));
}

void Scanner::read_number() {
    token_.kind = Token::number;
    const char* const begin = text_.data() + at_;
    const auto [end, failure] = std::from_chars(begin, text_.data() + text_.size(), token_.value);
    if (failure != std::errc{} || !std::isfinite(token_.value)) fail("the number is out of range");
    at_ += static_cast<std::size_t>(end - begin);
    const std::string_view unit = unit_ahead();
    token_.text = {begin, static_cast<std::size_t>(end - begin)};
    if (unit.empty()) return;
    try {
        const MeasuredUnit known = parse_measured_unit(unit);
        token_.value *= known.factor;
        token_.measure = known.measure;
    } catch (const Error& error) {
        fail(fmt::format("'{} {}': {}; a product needs a '*'", token_.text, unit, error.message()));
    }
    if (!std::isfinite(token_.value)) fail("the number is out of range");
    at_ += static_cast<std::size_t>(unit.data() + unit.size() - (text_.data() + at_));
}

bool Scanner::is_factor(std::size_t at) const {
    const std::string_view name = name_ahead(text_.substr(at));
    if (!is_declared_ || !is_declared_(name)) return false;
    try {
        parse_measured_unit(name);
    } catch (const Error&) {
        return true;
    }
    fail(fmt::format(
        "'{0}' is a unit and a name of this formula; put blanks around the '{1}' for the name, or rename it", name,
        text_[at - 1]));
}

std::string_view Scanner::unit_ahead() const {
    // Names after names, by blanks, '·' or '*', '/' and '^' without blanks: "N s/m", "m/s^2", "N/m^1.5".
    std::size_t at = at_;
    const auto blanks = [&](std::size_t from) {
        while (from < text_.size() && is_blank(text_[from])) ++from;
        return from;
    };
    std::size_t begin = blanks(at), end = begin;
    for (at = begin;;) {
        const std::string_view name = name_ahead(text_.substr(at));
        if (name.empty() || is_word(name)) break;
        at += name.size();
        if (at < text_.size() && text_[at] == '^') {
            double exponent = 0.0;
            const auto [stop, failure] = std::from_chars(text_.data() + at + 1, text_.data() + text_.size(), exponent);
            if (failure == std::errc{}) at = static_cast<std::size_t>(stop - text_.data());
        }
        end = at;
        if (at < text_.size() && (text_[at] == '/' || text_[at] == '*') && at + 1 < text_.size() &&
            begins_name(text_[at + 1]) && !is_factor(at + 1))
            ++at;
        else if (const std::size_t further = blanks(at); further > at) at = further;
        else break;
    }
    return text_.substr(begin, end - begin);
}

}  // namespace tactus::formula
