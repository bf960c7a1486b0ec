// SPDX-License-Identifier: Apache-2.0
// The result of an analysis as a tree of named values, from which every format is printed.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/render/labelled_picture.hpp"
#include "tools/report/figures/figure_style.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace tactus::report {

/// How a number is shown. JSON and CSV have all digits, in the unit of the value, which the key names (`delay_s`, `gain_db`).
struct NumberFormat {
    enum class Notation {
        fixed,  ///< `digits` decimals
        significant,  ///< `digits` significant digits, without trailing zeros
        prefixed,  ///< the same, with a prefix of the unit: "350 µm"
    };
    Notation notation = Notation::significant;
    int digits = 4;
    std::string unit{};  ///< shown after the number; empty: none, or that of the value
    std::string of{};  ///< unit of the value; empty: the shown one
    double scale = 1.0;  ///< shown number per value
    double per_si = 1.0;  ///< value per number that a field reads
    bool is_signed = false;  ///< "+1.2"

    /// Positive numbers have a sign: gains and differences.
    NumberFormat with_sign() const;
};

/// `digits` decimals. `unit` is shown; `of` is the unit of the value where it is another one: fixed(1, "ms", "s"),
/// fixed(0, "%", "1"). Throws Error for units of different dimensions.
NumberFormat fixed(int digits, std::string unit = "", std::string of = "");
/// `digits` significant digits.
NumberFormat significant(int digits, std::string unit = "", std::string of = "");
/// `digits` decimals in `unit` of a field that is in SI: JSON has the shown unit, too, as in `length_mm`.
NumberFormat from_si(int digits, std::string unit);
/// `digits` significant digits, and a prefix of the unit.
NumberFormat prefixed(int digits, std::string unit = "");

/// A quantity, or none: JSON then has null and a table a dash.
struct Number {
    Number() = default;
    Number(double value_, std::string unit_ = {}) : value(value_), unit(std::move(unit_)) {}
    Number(const std::optional<double>& value_) : value(value_) {}

    std::optional<double> value;
    std::string unit{};  ///< where it differs from one result to the next; otherwise that of the format
    std::optional<double> uncertainty{};  ///< one standard deviation, in the unit of the value
};

/// What a value means for the reader; it selects the order (warnings first) and the colour.
enum class Severity {
    none,
    pass,
    fail,
    warning,
};

/// The printed formats in which a value appears.
enum class Where {
    everywhere,
    pages,  ///< HTML and PDF
    nowhere,
};

struct Result;

/// A value of the tree. JSON contains those with a key, the printed formats those with a name.
struct ResultEntry {
    struct Quantity {
        Number number;
        NumberFormat format;
    };
    /// A band, a place, a pose: numbers of one unit on one line.
    struct Numbers {
        std::optional<std::vector<std::optional<double>>> values;
        NumberFormat format;
        std::string between = " ";
    };
    struct Integer {
        std::optional<long long> value;
    };
    struct Integers {
        std::vector<long long> values;
    };
    struct Text {
        std::optional<std::string> text;
    };
    struct Flag {
        std::optional<bool> value;
    };
    struct Texts {
        std::vector<std::string> texts;
        bool is_apart = false;  ///< a line for each; otherwise one line with commas
    };
    /// A line of names for each group.
    struct Groups {
        std::vector<std::vector<std::string>> groups;
    };
    /// A paragraph of pages that explains a section; not a value.
    struct Remark {
        std::string text;
    };
    /// A view of values that live as long as what was analysed; JSON contains all of them, no printed format does.
    struct Series {
        std::size_t size = 0;
        std::function<double(std::size_t)> at{};
        std::size_t columns = 0;  ///< of points or a matrix, whose rows are lists; 0: one list
    };
    /// Drawn when a format shows it.
    struct Picture {
        std::function<display::Figure(const FigureStyle&)> draw;
    };
    /// Rendered pictures, made when a page shows them.
    struct Pictures {
        std::function<std::vector<render::LabelledPicture>()> make;
    };
    struct Rows {
        std::vector<Result> rows;
        std::vector<std::pair<std::string, std::string>> columns{};  ///< key and heading of the printed ones
    };
    /// Sections of a page, each with its title.
    struct Children {
        std::vector<Result> results;
        bool is_list;  ///< in JSON; otherwise there is one at most
    };

    std::string key, name;
    bool is_omitted = false;  ///< in JSON a value that is missing is left out, not null
    Severity severity = Severity::none;
    std::variant<Quantity, Numbers, Integer, Integers, Text, Flag, Texts, Groups, Remark, Series, Picture, Pictures,
                 Rows, Children>
        value;
    Where where = Where::everywhere;
    std::string remark{};  ///< of a table: a paragraph of pages that explains it
};

struct Result {
    std::string title;
    std::vector<ResultEntry> entries;
    std::string page_title{};  ///< in place of `title` on pages
    std::optional<Vec3> mark{};  ///< sRGB of a square before it, as a row of a page

    const ResultEntry* find(std::string_view key) const;
};

/// Coordinates of points in a unit (given in SI), a list for each point. The points must live as long as the series.
ResultEntry::Series series_of(const std::vector<Vec3>& points, double unit);

/// Draws the pictures now in this style, or drops them: what was analysed need not live any longer, if it has no series.
void settle_pictures(Result& result, bool keeps_pictures, const FigureStyle& style = screen_style);

/// The digits of a value, the same in all printed formats: "3.1 ms ± 0.1 ms", "pass", "–" without a value. Empty for rows,
/// children, series and pictures.
std::string shown(const ResultEntry& entry);

/// Unit of the value in JSON and CSV; empty: none, or not a number.
std::string_view unit_of_value(const ResultEntry& entry);

/// Whether the value is missing: no number, no text, no rows.
bool is_missing(const ResultEntry& entry);

}  // namespace tactus::report
