// SPDX-License-Identifier: Apache-2.0
// How the numbers of a log are written, as far as they show it: 1,234 may be 1234 or 1.234.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tactus::table {

class DecimalSign {
public:
    explicit DecimalSign(char separator) : separator_(separator) {}

    /// Notes how `field` is written. Returns why it has no meaning: thousands separators. Between commas a field
    /// with a comma was quoted.
    std::optional<std::string> note(std::string_view field, int line);

    /// At the end: why a number may have two meanings, and its line (0: the whole file).
    struct Doubt {
        std::string why;
        int line = 0;
    };
    std::optional<Doubt> doubt() const;

    /// ',' or '.', or '\0' when no number has either.
    char sign() const;

    /// The finite number of a field that shows nothing new: a whole number, or one with a point after another such. None for
    /// others, which `note` and `parse` read.
    std::optional<double> parse_known(std::string_view field) const;

    /// The number with the decimal sign replaced; none when it is no number. Infinity and NaN are numbers.
    std::optional<double> parse(std::string_view field) const;

private:
    char separator_;
    bool commas_ = false, points_ = false, maybe_points_ = false;
    std::string grouped_;  // the first number that may have thousands separators
    int grouped_line_ = 0;
};

}  // namespace tactus::table
