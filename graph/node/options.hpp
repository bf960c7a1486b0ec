// SPDX-License-Identifier: Apache-2.0
// Named option values as a patch writes them, for example the table [devices.hand]. The reader of the options states
// default and range where it asks for a value, so what exists is exactly what was asked for.
#pragma once

#include "dsp/core/error.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus {

/// One option as written. Numbers and booleans of the file are given as their text: "3", "true".
struct OptionText {
    std::string name;
    std::string text;
    SourceLocation where;
    std::string scope = {};  ///< in front of an asset's name: where in a flattened patch the option was written
};

/// The options of one thing. Ask for each value once, then call `finish`.
class Options {
public:
    /// `owner` names the thing in messages: "device 'hand'".
    explicit Options(std::string owner, std::vector<OptionText> given = {}, SourceLocation where = {});

    /// Value in SI of `name`, or `standard` when it is not given. All three carry units and share a dimension; an empty
    /// `min` or `max` leaves that side open. Throws Error when the text is no quantity of that dimension or out of range.
    double quantity(std::string_view name, std::string_view standard, std::string_view min = {},
                    std::string_view max = {});

    std::string text(std::string_view name, std::string_view standard);

    /// "true" or "false". Throws Error on other text.
    bool flag(std::string_view name, bool standard);

    /// One of `choices`; returns its index. Throws Error listing them. `standard` must be one of them.
    std::size_t choice(std::string_view name, std::span<const std::string> choices, std::string_view standard);

    /// True when the patch gives `name`. Does not count as asking.
    bool has(std::string_view name) const;

    /// Where `name` is written, or where the owner is when it is not given; for errors found later.
    const SourceLocation& where(std::string_view name) const;
    const SourceLocation& where() const { return where_; }

    /// Throws Error at the first given name that was never asked for.
    void finish() const;

    const std::string& owner() const { return owner_; }

private:
    const OptionText* find(std::string_view name) const;
    const OptionText* ask(std::string_view name);
    [[noreturn]] void fail(const OptionText& option, const std::string& message) const;

    std::string owner_;
    std::vector<OptionText> given_;
    SourceLocation where_;
    std::vector<std::string> known_;
};

}  // namespace tactus
