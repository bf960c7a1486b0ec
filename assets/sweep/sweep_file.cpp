// SPDX-License-Identifier: Apache-2.0
#include "assets/sweep/sweep_file.hpp"

#include "assets/experiment/toml_values.hpp"
#include "assets/file/room.hpp"
#include "assets/sweep/sobol.hpp"
#include "assets/sweep/template_word.hpp"
#include "assets/table/number_table.hpp"
#include "dsp/core/lower.hpp"
#include "dsp/core/random.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>
#include <unordered_set>

namespace tactus::sweep {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view library_prefix = "library:";
constexpr std::size_t max_levels = 5'000'000, max_listed_files = 1'000'000;

/// Columns of the results that every sweep has.
const std::vector<std::string> reserved{"point",   "index",   "seed",   "state",   "reason",   "output",  "seconds",
                                        "peak_mb", "attempt", "build",  "program", "version",  "libc",    "vector",
                                        "cpu",     "machine", "runner", "worker",  "finished", "features"};

bool is_plain(const std::string& name) {
    return !name.empty() && name.size() <= 40 && std::isdigit(static_cast<unsigned char>(name[0])) == 0 &&
           std::ranges::all_of(name, [](char c) {
               return c == '_' || (static_cast<unsigned char>(c) < 128 && std::isalnum(static_cast<unsigned char>(c)));
           });
}

class Reader {
public:
    Reader(const fs::path& path, fs::path folder, const fs::path& library)
        : toml_(path, "a sweep"),
          folder_(folder.empty() ? fs::absolute(path).parent_path() : std::move(folder)),
          library_(library) {}

    Sweep read(const fs::path& path) {
        const toml::table& root = toml_.root();
        toml_.check_format(sweep_format);
        toml_.know(root,
                   {"format", "title", "about", "inputs", "axes", "samples", "seeds", "step", "limits", "figure"});
        sweep_.file = path;
        sweep_.title = toml_.line(toml_.need(root, "title", "title = \"Stiffness and rate\""));
        if (const auto* node = root.get("about")) sweep_.about = toml_.word(*node);
        if (const auto* node = root.get("inputs")) read_inputs(toml_.as_table(*node));
        if (const auto* node = root.get("seeds")) read_seeds(toml_.as_table(*node));
        if (const auto* node = root.get("samples"))
            sweep_.samples = static_cast<std::size_t>(toml_.whole(*node, 1, static_cast<int>(max_levels)));
        if (const auto* node = root.get("axes")) read_axes(toml_.as_table(*node));
        if (const auto* node = root.get("limits")) read_limits(toml_.as_table(*node));
        if (const auto* node = root.get("step"))
            for (const toml::node& one : toml_.list(*node, 1, 32)) read_step(toml_.as_table(one));
        if (const auto* node = root.get("figure"))
            for (const toml::node& one : toml_.list(*node, 0, 64)) read_figure(toml_.as_table(one));
        if (sweep_.point_count() > max_points)
            throw Error(SourceLocation{toml_.file(), 1, 1},
                        fmt::format("the sweep has more than {} points; use fewer levels", max_points));
        return std::move(sweep_);
    }

private:
    void take_name(const toml::node& node, const std::string& name) {
        if (!is_plain(name))
            toml_.fail(node, fmt::format("'{}' is no name: 1 to 40 letters, digits and '_', not beginning with a digit",
                                         name));
        // Names of columns in SQLite do not distinguish capitals.
        if (std::ranges::find(reserved, lower(name)) != reserved.end())
            toml_.fail(node, fmt::format("'{}' is a column that every sweep has; choose another name", name));
        if (!names_.insert(lower(name)).second)
            toml_.fail(
                node,
                fmt::format("'{}' is used twice; columns of the results need different names, also without capitals",
                            name));
    }

    fs::path path_of(const std::string& name) const {
        if (name.starts_with(library_prefix)) return library_ / name.substr(library_prefix.size());
        return (folder_ / name).lexically_normal();
    }

    std::string file_name(const toml::node& node) const {
        std::string name = toml_.word(node);
        if (name.empty() || name.size() > 4096 || name.find('\0') != std::string::npos)
            toml_.fail(node, "a file name is expected here");
        return name;
    }

    void read_inputs(const toml::table& table) {
        for (const auto& [key, node] : table) {
            const std::string name(key.str());
            if (!is_plain(name)) toml_.fail(node, fmt::format("'{}' is no name of an input", name));
            const fs::path path = path_of(file_name(node));
            std::error_code ignored;
            if (!fs::is_regular_file(path, ignored))
                toml_.fail(node, fmt::format("there is no file {}", path.string()));
            sweep_.inputs[name] = path;
        }
    }

    void read_seeds(const toml::table& table) {
        toml_.know(table, {"count", "first", "independent"});
        if (const auto* node = table.get("count"))
            sweep_.seeds.count = static_cast<std::size_t>(toml_.whole(*node, 1, static_cast<int>(max_levels)));
        if (const auto* node = table.get("first"))
            sweep_.seeds.first = static_cast<std::uint64_t>(toml_.whole(*node, 0, 1'000'000'000));
        if (const auto* node = table.get("independent")) sweep_.seeds.is_independent = toml_.flag(*node);
    }

    /// The parser sorts its tables by name; columns of the results have the order of the file.
    static std::vector<const toml::key*> in_file_order(const toml::table& table) {
        std::vector<const toml::key*> order;
        for (const auto& [key, node] : table) order.push_back(&key);
        std::ranges::sort(order, {}, [](const toml::key* key) {
            const toml::source_position at = key->source().begin;
            return std::pair(at.line, at.column);
        });
        return order;
    }

    void read_axes(const toml::table& table) {
        const std::vector<const toml::key*> order = in_file_order(table);
        if (order.size() > 32) toml_.fail(table, "a sweep has at most 32 axes");
        for (const toml::key* key : order) read_axis(std::string(key->str()), toml_.as_table(*table.get(key->str())));
    }

    void read_axis(const std::string& name, const toml::table& table) {
        take_name(table, name);
        toml_.know(table, {"unit", "values", "range", "log_range", "random", "log_random", "sobol", "log_sobol",
                           "count", "files", "csv", "columns"});
        Axis axis;
        axis.name = name;
        if (const auto* node = table.get("unit")) axis.unit = toml_.line(*node);
        std::vector<std::string> kinds;
        for (const char* kind :
             {"values", "range", "log_range", "random", "log_random", "sobol", "log_sobol", "files", "csv"})
            if (table.contains(kind)) kinds.emplace_back(kind);
        if (kinds.size() != 1)
            toml_.fail(table, fmt::format("the axis '{}' needs exactly one of values, range, log_range, random, "
                                          "log_random, sobol, log_sobol, files and csv",
                                          name));
        const std::string kind = kinds.front();
        const toml::node& node = *table.get(kind);
        const bool is_range = kind == "range" || kind == "log_range";
        if (!is_range && table.contains("count")) toml_.fail(*table.get("count"), "'count' belongs to a range");
        if (kind != "csv" && table.contains("columns"))
            toml_.fail(*table.get("columns"), "'columns' belongs to an axis of a CSV file");
        axis.is_log = kind.starts_with("log_");
        if (kind == "values") read_values(axis, node);
        else if (is_range) read_range(axis, table, node);
        else if (kind == "files") read_files(axis, node);
        else if (kind == "csv") read_table(axis, table, node);
        else read_design(axis, node, kind.ends_with("sobol"));
        axis.has_numbers = axis.columns.empty() &&
                           std::ranges::all_of(axis.levels, [](const Level& l) { return !std::isnan(l.number); });
        all_levels_ += axis.levels.size();
        if (all_levels_ > max_levels) toml_.fail(node, "the axes have over five million levels; use fewer");
        std::unordered_set<std::string_view> seen;
        for (const Level& level : axis.levels)
            if (axis.kind == Axis::Kind::grid && !seen.insert(level.text).second)
                toml_.fail(node, fmt::format("the axis '{}' has the level '{}' twice", name, level.text));
        sweep_.axes.push_back(std::move(axis));
    }

    void add_number(Axis& axis, double value) const {
        // The shortest text that reads back as the same number.
        axis.levels.push_back(
            {axis.unit.empty() ? fmt::format("{}", value) : fmt::format("{} {}", value, axis.unit), value});
    }

    void read_values(Axis& axis, const toml::node& node) const {
        for (const toml::node& one : toml_.list(node, 1, max_levels)) {
            if (one.is_number()) add_number(axis, toml_.number(one, -1e300, 1e300));
            else if (const auto flag = one.value_exact<bool>())
                axis.levels.push_back({*flag ? "true" : "false", *flag ? 1.0 : 0.0});
            else {
                const std::string text = toml_.word(one);
                if (text.find('\0') != std::string::npos || text.size() > 4096)
                    toml_.fail(one, "a value of an axis has at most 4096 bytes and no zero byte");
                if (!axis.unit.empty())
                    toml_.fail(one, fmt::format("write numbers: '{}' appends its unit, '{}'", axis.name, axis.unit));
                axis.levels.push_back({text});
            }
        }
    }

    std::pair<double, double> bounds(const Axis& axis, const toml::node& node) const {
        const toml::array& ends = toml_.list(node, 2, 2);
        const double low = toml_.number(ends[0], axis.is_log ? 1e-300 : -1e300, 1e300),
                     high = toml_.number(ends[1], axis.is_log ? 1e-300 : -1e300, 1e300);
        if (!(low < high)) toml_.fail(node, "the first bound must be below the second");
        return {low, high};
    }

    static double between(const Axis& axis, double low, double high, double share) {
        if (!axis.is_log) return low + (high - low) * share;
        return std::exp(std::log(low) + (std::log(high) - std::log(low)) * share);
    }

    /// To 12 digits: 0.1 + 2 × 0.1 is written 0.3, and libraries whose logarithm differs in the last bit agree.
    static double rounded(double value) {
        const std::string text = fmt::format("{:.12g}", value);
        std::from_chars(text.data(), text.data() + text.size(), value);
        return value;
    }

    void read_range(Axis& axis, const toml::table& table, const toml::node& node) const {
        const auto [low, high] = bounds(axis, node);
        const int count = toml_.whole(toml_.need(table, "count", "count = 8"), 2, static_cast<int>(max_levels));
        for (int i = 0; i < count; ++i) {
            const double exact = i == 0           ? low
                                 : i == count - 1 ? high
                                                  : between(axis, low, high, static_cast<double>(i) / (count - 1));
            add_number(axis, rounded(exact));
        }
    }

    void read_design(Axis& axis, const toml::node& node, bool is_sobol) {
        const auto [low, high] = bounds(axis, node);
        if (sweep_.samples == 0)
            toml_.fail(node, "random and Sobol axes need a number of samples: samples = 256, above [axes]");
        axis.kind = Axis::Kind::design;
        if (is_sobol && sobol_axes_ == max_sobol_dimensions)
            toml_.fail(node, fmt::format("a Sobol design has at most {} axes", max_sobol_dimensions));
        // By the name, so that another axis changes nothing.
        std::uint64_t name = 0;
        for (const char c : axis.name) name = mix(name ^ static_cast<unsigned char>(c));
        const Random random{mix(sweep_.seeds.first) ^ name};
        for (std::size_t k = 0; k < sweep_.samples; ++k) {
            const double share = is_sobol ? shifted_sobol(k, sobol_axes_, sweep_.seeds.first) : random.uniform(k);
            add_number(axis, rounded(between(axis, low, high, share)));
        }
        if (is_sobol) ++sobol_axes_;
    }

    void read_files(Axis& axis, const toml::node& node) const {
        const fs::path pattern = path_of(file_name(node));
        std::vector<fs::path> found{pattern.root_path()};
        for (const fs::path& part : pattern.relative_path()) {
            std::vector<fs::path> next;
            const std::string word = part.string();
            const bool is_pattern = word.find_first_of("*?[") != std::string::npos;
            for (const fs::path& folder : found) {
                std::error_code failure;
                if (!is_pattern) {
                    if (fs::exists(folder / part, failure)) next.push_back(folder / part);
                    continue;
                }
                for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
                     entry.increment(failure)) {
                    if (::fnmatch(word.c_str(), entry->path().filename().c_str(), FNM_PERIOD) == 0)
                        next.push_back(entry->path());
                    if (next.size() > max_listed_files) toml_.fail(node, "the pattern matches over a million files");
                }
            }
            found = std::move(next);
        }
        std::ranges::sort(found);
        for (const fs::path& path : found)
            if (fs::is_regular_file(path)) {
                axis.levels.push_back({relative_name(path)});
                axis.files.push_back(path);
            }
        if (axis.levels.empty()) toml_.fail(node, fmt::format("no file matches {}", pattern.string()));
    }

    /// As it is called from the sweep: results stay equal where the whole is moved.
    std::string relative_name(const fs::path& path) const {
        return path.lexically_relative(folder_).string().starts_with("..") ? path.string()
                                                                           : path.lexically_relative(folder_).string();
    }

    void read_table(Axis& axis, const toml::table& table, const toml::node& node) const {
        const fs::path path = path_of(file_name(node));
        std::error_code ignored;
        if (!fs::is_regular_file(path, ignored)) toml_.fail(node, fmt::format("there is no file {}", path.string()));
        const table::NumberTable read = table::load_number_table(path);
        axis.columns = table.contains("columns") ? toml_.words(*table.get("columns"), 1, 64) : read.names;
        if (read.rows() == 0) toml_.fail(node, fmt::format("{} has no rows", path.string()));
        if (read.rows() > max_levels) toml_.fail(node, "the table has over five million rows");
        std::vector<const std::vector<std::string>*> columns;
        std::set<std::string> seen;
        for (const std::string& name : axis.columns) {
            if (!is_plain(name))
                toml_.fail(node, fmt::format("the column '{}' is no name: letters, digits and '_'", name));
            if (!seen.insert(lower(name)).second)
                toml_.fail(node, fmt::format("the column '{}' is there twice; choose with 'columns'", name));
            columns.push_back(&read.text(name));
        }
        for (std::size_t row = 0; row < read.rows(); ++row) {
            axis.levels.push_back({std::to_string(row + 1), static_cast<double>(row + 1)});
            axis.rows.emplace_back();
            for (const auto* column : columns) axis.rows.back().push_back((*column)[row]);
        }
    }

    void read_limits(const toml::table& table) {
        toml_.know(table, {"time", "memory", "retries"});
        if (const auto* node = table.get("time")) sweep_.limits.seconds = toml_.quantity(*node, "s", 1e-3, 1e7);
        if (const auto* node = table.get("memory")) {
            try {
                sweep_.limits.bytes = file::parse_memory_size(toml_.word(*node));
            } catch (const Error& error) {
                if (error.where().line > 0) throw;
                toml_.fail(*node, error.message());
            }
            if (sweep_.limits.bytes < 1'000'000) toml_.fail(*node, "a limit below 1 MB stops every point");
        }
        if (const auto* node = table.get("retries")) sweep_.limits.retries = toml_.whole(*node, 0, 100);
    }

    void read_step(const toml::table& table) {
        toml_.know(table, {"tactus", "command", "values", "from", "files", "accept"});
        Step step;
        step.is_own = table.contains("tactus");
        if (step.is_own == table.contains("command"))
            toml_.fail(table, "a step is either tactus = [\"VERB\", …] or command = [\"PROGRAM\", …]");
        const toml::node& words = *table.get(step.is_own ? "tactus" : "command");
        const toml::array& list = toml_.list(words, 1, 1000);
        for (const toml::node& one : list) {
            const std::string word = toml_.word(one);
            if (word.find('\0') != std::string::npos) toml_.fail(one, "a zero byte cannot be part of a command");
            check_word(one, word);
            step.words.push_back(word);
        }
        if (step.is_own) {
            for (const char* verb : {"sweep", "bench", "view"})
                if (step.words.front() == verb)
                    toml_.fail(list[0], std::string(verb) == "bench"
                                            ? "bench is a program of its own: command = [\"{tactus}\", \"bench\", …]"
                                            : fmt::format("'{}' cannot be a step of a sweep", verb));
        }
        if (const auto* node = table.get("from")) step.from = output_name(*node);
        if (const auto* node = table.get("values")) read_kept(step, toml_.as_table(*node));
        if (const auto* node = table.get("files"))
            for (const toml::node& one : toml_.list(*node, 0, 100)) step.files.push_back(output_name(one));
        if (const auto* node = table.get("accept")) {
            step.accepted.clear();
            for (const toml::node& one : toml_.list(*node, 1, 256)) step.accepted.push_back(toml_.whole(one, 0, 255));
        }
        for (const std::string& name : step.files)
            if (!kept_files_.insert(name).second) toml_.fail(table, fmt::format("'{}' is kept twice", name));
        sweep_.steps.push_back(std::move(step));
    }

    void read_kept(Step& step, const toml::table& table) {
        for (const toml::key* key : in_file_order(table)) {
            const toml::node& node = *table.get(key->str());
            KeptValue kept{std::string(key->str()), toml_.word(node)};
            take_name(node, kept.name);
            if (!kept.pointer.empty() && !kept.pointer.starts_with('/'))
                toml_.fail(node,
                           fmt::format(
                               "'{}' is no JSON pointer; write \"/section/name\", \"/rows/0/success\", or \"\" for all",
                               kept.pointer));
            step.values.push_back(std::move(kept));
        }
    }

    /// A name within the point's folder.
    std::string output_name(const toml::node& node) const {
        const std::string name = file_name(node);
        const fs::path path = fs::path(name).lexically_normal();
        if (path.is_absolute() || path.empty() || *path.begin() == ".." || path == "." || !path.has_filename())
            toml_.fail(node, "a file below {out} is expected here, as in \"run/force.csv\"");
        return path.string();
    }

    void check_word(const toml::node& node, const std::string& word) const {
        try {
            for (const TemplatePart& part : template_parts(word)) {
                if (!part.is_placeholder) continue;
                if (const std::string problem = placeholder_problem(sweep_, part.text); !problem.empty())
                    toml_.fail(node, problem);
            }
        } catch (const Error& error) {
            if (error.where().line > 0) throw;
            toml_.fail(node, error.message());
        }
    }

    void read_figure(const toml::table& table) {
        toml_.know(table, {"name", "title", "kind", "value", "minus", "unit", "x", "y", "series", "panel", "unless",
                           "statistic", "log"});
        FigureChoice figure;
        const toml::node& name = toml_.need(table, "name", "name = \"success\"");
        figure.name = toml_.word(name);
        if (!is_plain(figure.name)) toml_.fail(name, "a name of letters, digits and '_' is expected here");
        if (!figures_.insert(figure.name).second)
            toml_.fail(name, fmt::format("two figures are called '{}'", figure.name));
        if (const auto* node = table.get("title")) figure.title = toml_.line(*node);
        if (const auto* node = table.get("kind"))
            figure.kind =
                toml_.choice(*node, {"heat", "lines"}) == "heat" ? FigureChoice::Kind::heat : FigureChoice::Kind::lines;
        if (const auto* node = table.get("unit")) figure.unit = toml_.line(*node);
        const auto columns = [&](const toml::node& node) {
            return node.is_array() ? toml_.words(node, 1, 24) : std::vector<std::string>{toml_.word(node)};
        };
        figure.values = columns(toml_.need(table, "value", "value = \"success\""));
        if (const auto* node = table.get("minus")) figure.minus = columns(*node);
        if (const auto* node = table.get("unless")) figure.unless = toml_.word(*node);
        figure.x = toml_.word(toml_.need(table, "x", "x = \"stiffness\""));
        if (const auto* node = table.get("y")) figure.y = toml_.word(*node);
        if (const auto* node = table.get("series")) figure.series = toml_.word(*node);
        if (const auto* node = table.get("panel")) figure.panel = toml_.word(*node);
        if (const auto* node = table.get("statistic"))
            figure.statistic = statistic_of(toml_.choice(*node, statistic_names()));
        if (const auto* node = table.get("log")) figure.is_log = toml_.flag(*node);
        if (const std::string problem = figure_problem(sweep_, figure); !problem.empty()) toml_.fail(table, problem);
        sweep_.figures.push_back(std::move(figure));
    }

    experiment::TomlValues toml_;
    fs::path folder_;
    const fs::path& library_;
    Sweep sweep_;
    std::set<std::string> names_, figures_, kept_files_;
    std::size_t sobol_axes_ = 0, all_levels_ = 0;
};

}  // namespace

std::size_t Sweep::point_count() const {
    double count = static_cast<double>(seeds.count) * static_cast<double>(samples > 0 ? samples : 1);
    std::size_t exact = seeds.count * (samples > 0 ? samples : 1);
    for (const Axis& axis : axes)
        if (axis.kind == Axis::Kind::grid) {
            count *= static_cast<double>(axis.levels.size());
            if (count > 1e15) return max_points + 1;
            exact *= axis.levels.size();
        }
    return exact;
}

const Axis* Sweep::find_axis(std::string_view name) const {
    const auto found = std::ranges::find(axes, name, &Axis::name);
    return found == axes.end() ? nullptr : &*found;
}

std::vector<std::string> Sweep::value_names() const {
    std::vector<std::string> names;
    for (const Step& step : steps)
        for (const KeptValue& value : step.values) names.push_back(value.name);
    return names;
}

namespace {

constexpr std::pair<std::string_view, FigureChoice::Statistic> statistics[] = {
    {"mean", FigureChoice::Statistic::mean},
    {"median", FigureChoice::Statistic::median},
    {"fraction", FigureChoice::Statistic::fraction}};

}  // namespace

std::string_view name_of(FigureChoice::Statistic statistic) {
    return std::ranges::find(statistics, statistic, [](const auto& one) { return one.second; })->first;
}

std::vector<std::string> statistic_names() {
    std::vector<std::string> names;
    for (const auto& [name, statistic] : statistics) names.emplace_back(name);
    return names;
}

FigureChoice::Statistic statistic_of(std::string_view name) {
    const auto found = std::ranges::find(statistics, name, [](const auto& one) { return one.first; });
    if (found == std::end(statistics)) throw Error(fmt::format("there is no statistic '{}'", name));
    return found->second;
}

std::string figure_problem(const Sweep& sweep, const FigureChoice& figure) {
    const std::vector<std::string> known = sweep.value_names();
    std::vector<std::string> columns = figure.values;
    columns.insert(columns.end(), figure.minus.begin(), figure.minus.end());
    if (!figure.unless.empty()) columns.push_back(figure.unless);
    for (const std::string& name : columns)
        if (std::ranges::find(known, name) == known.end())
            return fmt::format("no step has a value '{}'{}", name, did_you_mean(name, known));
    std::vector<std::string> axes, used;
    for (const Axis& axis : sweep.axes) axes.push_back(axis.name);
    for (const std::string& name : {figure.x, figure.y, figure.series, figure.panel}) {
        if (name.empty()) continue;
        if (std::ranges::find(axes, name) == axes.end())
            return fmt::format("there is no axis '{}'{}", name, did_you_mean(name, axes));
        if (std::ranges::find(used, name) != used.end()) return "a figure uses each axis once";
        used.push_back(name);
    }
    const bool is_heat = figure.kind == FigureChoice::Kind::heat;
    if (is_heat == figure.y.empty()) return is_heat ? "a heat map needs 'y'" : "'y' belongs to a heat map";
    if (is_heat && !figure.series.empty()) return "'series' belongs to lines";
    if (is_heat && figure.values.size() > 1) return "a heat map shows one value";
    if (figure.values.size() > 1 && !figure.series.empty())
        return "several values are a line each; leave out 'series', or use 'panel'";
    if (!figure.minus.empty() && figure.minus.size() != figure.values.size())
        return fmt::format("'minus' needs a column for each value: {} of {}", figure.minus.size(),
                           figure.values.size());
    if (figure.is_log && (figure.statistic == FigureChoice::Statistic::fraction || !figure.minus.empty()))
        return "fractions and differences have no logarithmic axis";
    return {};
}

Sweep load_sweep(const fs::path& path, const fs::path& folder, const fs::path& library) {
    try {
        return Reader(path, folder, library).read(path);
    } catch (const Error& error) {
        // Names are quoted as they are written, also those with a line end.
        std::string message = error.message();
        std::ranges::replace_if(message, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
        if (error.where().file.empty()) throw Error(message);
        throw Error(error.where(), message);
    }
}

}  // namespace tactus::sweep
