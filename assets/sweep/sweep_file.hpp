// SPDX-License-Identifier: Apache-2.0
// A sweep: one template of commands, run for every combination of the levels of its axes. TOML;
// docs/reference/sweep-file.md describes the format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::sweep {

inline constexpr int sweep_format = 1;
/// Points of one sweep: a task list stays below 1 GB.
inline constexpr std::size_t max_points = 20'000'000;

/// One value of an axis. Small: an axis may have millions.
struct Level {
    std::string text;  ///< replaces {AXIS} in the template, with the unit; of files: relative to the sweep
    double number = std::numeric_limits<double>::quiet_NaN();  ///< in the unit of the axis; NaN: a text
};

struct Axis {
    /// grid: every level with every level of the other axes. design: sample k of all such axes together is one point of
    /// a random or Sobol design.
    enum class Kind : std::uint8_t { grid, design } kind = Kind::grid;
    std::string name, unit;
    std::vector<Level> levels;
    std::vector<std::string> columns;  ///< of a table
    std::vector<std::vector<std::string>> rows;  ///< of a table: per level and column
    std::vector<std::filesystem::path> files;  ///< of an axis of files: per level, absolute
    bool is_log = false;  ///< spaced, or drawn, by the logarithm
    bool has_numbers = false;  ///< all levels are numbers
};

/// A number or text of a step's JSON that becomes a column of the results.
struct KeptValue {
    std::string name;
    std::string pointer;  ///< JSON pointer (RFC 6901)
};

struct Step {
    bool is_own = true;  ///< a verb of Tactus; otherwise a program
    std::vector<std::string> words;
    std::string from;  ///< JSON file in {out} that `values` are read from; empty: standard output
    std::vector<KeptValue> values;
    std::vector<std::string> files;  ///< kept, relative to {out}
    std::vector<int> accepted{0};  ///< exit codes of success
};

struct Limits {
    double seconds = 0.0;  ///< of one attempt; 0: none
    std::uint64_t bytes = 0;  ///< resident memory of an attempt; 0: none
    int retries = 1;  ///< attempts after the first failure
};

struct Seeds {
    std::size_t count = 1;
    std::uint64_t first = 1;
    /// false: the same seeds at every combination of levels, so that differences between levels are paired. true: a
    /// seed of its own for every point.
    bool is_independent = false;
};

/// A figure over the results. All axes that it does not name are averaged over.
struct FigureChoice {
    enum class Kind : std::uint8_t { heat, lines } kind = Kind::lines;
    std::string name, title, unit;
    std::vector<std::string> values;  ///< columns; of several, each is a line
    std::vector<std::string>
        minus;  ///< columns of the same row that are subtracted, one for each value: paired differences
    std::string x, y;  ///< axes; y: heat only
    std::string series, panel;  ///< axes: a line, and a panel, for each level
    std::string unless;  ///< column: rows where it is not 0 or false are left out
    /// fraction: of rows with a value that is not 0
    enum class Statistic : std::uint8_t { mean, median, fraction } statistic = Statistic::mean;
    bool is_log = false;  ///< of the values
};

/// "mean", "median", "fraction".
std::string_view name_of(FigureChoice::Statistic statistic);
/// Those three, for an option's choices.
std::vector<std::string> statistic_names();
/// Throws Error for other names.
FigureChoice::Statistic statistic_of(std::string_view name);

struct Sweep {
    std::filesystem::path file;
    std::string title, about;
    std::map<std::string, std::filesystem::path> inputs;  ///< name → absolute path
    std::vector<Axis> axes;
    std::size_t samples = 0;  ///< of the design; 0: no axis belongs to it
    Seeds seeds;
    std::vector<Step> steps;
    Limits limits;
    std::vector<FigureChoice> figures;

    std::size_t point_count() const;
    const Axis* find_axis(std::string_view name) const;
    /// Columns of values, over all steps.
    std::vector<std::string> value_names() const;
};

/// Error text if the figure does not fit the sweep (missing columns or axes, keys that exclude each other); empty if it does.
std::string figure_problem(const Sweep& sweep, const FigureChoice& figure);

/// Reads and checks. `folder`: relative names are below it (empty: the folder of the file). `library`: replaces
/// "library:" at the begin of the name of an input. Axes of files are listed, but their contents are not read. Throws
/// Error with file:line:column.
Sweep load_sweep(const std::filesystem::path& path, const std::filesystem::path& folder,
                 const std::filesystem::path& library);

}  // namespace tactus::sweep
