// SPDX-License-Identifier: Apache-2.0
// Named options of a table in a patch, for example [devices.hand]. The code that reads an option states its default and
// range. An option that no code reads is an error.
#pragma once

#include "dsp/core/error.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus {

/// One option as written. Numbers and booleans are their text in the file: "3", "true".
struct OptionText {
    std::string name;
    std::string text;
    SourceLocation where;
    std::string scope = {};  ///< prefix of asset names for an option from a sub-patch: "voice:"
};

/// The options of one owner. Read each one once, then call `finish`.
class Options {
public:
    /// `owner` is the name in messages: "device 'hand'".
    explicit Options(std::string owner, std::vector<OptionText> given = {}, SourceLocation where = {});

    /// Returns the SI value of `name`, or of `standard` if it is not given. `standard`, `min` and `max` have units of
    /// one dimension; an empty limit means none. Throws Error for text of another dimension or a value out of range.
    double quantity(std::string_view name, std::string_view standard, std::string_view min = {},
                    std::string_view max = {});

    /// Returns the text of `name`, or `standard` if it is not given.
    std::string text(std::string_view name, std::string_view standard);

    /// Accepts "true" or "false". Throws Error for other text.
    bool flag(std::string_view name, bool standard);

    /// Returns the index of the given word in `choices`. `standard` must be one of them. For another word throws Error
    /// with the list of choices.
    std::size_t choice(std::string_view name, std::span<const std::string> choices, std::string_view standard);

    /// True when the patch gives `name`. This does not count as reading it.
    bool has(std::string_view name) const;

    /// Location of `name` in the file, or of the owner if it is not given. For errors that are found later.
    const SourceLocation& where(std::string_view name) const;
    const SourceLocation& where() const { return where_; }

    /// Throws Error at the first given option that was never read.
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
