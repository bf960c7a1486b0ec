// SPDX-License-Identifier: Apache-2.0
#include "tools/window/signal/table.hpp"

#include "assets/table/csv_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace tactus::window {

namespace {

std::string column_name(const std::string& name, const std::string& unit) {
    return unit.empty() ? name : name.empty() ? unit : name + " " + unit;
}

/// Columns of one list of positions, which increase.
struct Part {
    const std::vector<double>* at = nullptr;
    std::vector<const std::vector<double>*> columns;
    std::size_t next = 0;
};

/// Rows of all parts by position; those within `same` of each other are one.
template <class Spell>
std::string rows_of(std::vector<Part> parts, double last, double same, Spell&& spell) {
    std::string text;
    for (;;) {
        double here = std::numeric_limits<double>::infinity();
        for (const Part& part : parts)
            if (part.next < part.at->size()) here = std::min(here, (*part.at)[part.next]);
        if (!(here <= last)) return text;
        text += spell(here);
        for (Part& part : parts) {
            const bool has_value = part.next < part.at->size() && (*part.at)[part.next] <= here + same;
            for (const auto* column : part.columns) text += has_value ? fmt::format(",{}", (*column)[part.next]) : ",";
            if (has_value) ++part.next;
        }
        text += "\n";
    }
}

}  // namespace

void write_csv(std::span<const TableTrace> traces, Range time, const std::filesystem::path& path) {
    std::string text = "time s";
    std::vector<Part> parts;
    for (const TableTrace& from : traces) {
        const Trace& trace = *from.trace;
        Part part{&trace.times, {}, 0};
        part.next = static_cast<std::size_t>(std::ranges::lower_bound(trace.times, time.low) - trace.times.begin());
        for (std::size_t c = 0; c < trace.columns.size(); ++c) {
            const std::string column = c < trace.names.size() ? trace.names[c] : "";
            const std::string name = from.name + (from.name.empty() || column.empty() ? "" : " ") + column;
            text += "," + column_name(name, c < from.units.size() ? from.units[c] : "");
            part.columns.push_back(&trace.columns[c]);
        }
        parts.push_back(std::move(part));
    }
    text += "\n" + rows_of(std::move(parts), time.high, 0.5e-9, [](double at) { return fmt::format("{:.9f}", at); });
    table::save_csv(path, text);
}

void write_spectrum_csv(const Plot& plot, const std::filesystem::path& path) {
    std::string text = "frequency Hz";
    std::vector<std::vector<double>> at(plot.curves.size()), levels(plot.curves.size());
    std::vector<Part> parts;
    for (std::size_t k = 0; k < plot.curves.size(); ++k) {
        text += "," + column_name(plot.curves[k].name, plot.level_unit);
        for (const Point& p : plot.curves[k].points) {
            at[k].push_back(p.x);
            levels[k].push_back(p.y);
        }
        parts.push_back({&at[k], {&levels[k]}, 0});
    }
    text += "\n" + rows_of(std::move(parts), plot.x.high, 1e-6, [](double hz) { return fmt::format("{}", hz); });
    table::save_csv(path, text);
}

void write_waterfall_csv(const Plot& plot, const std::filesystem::path& path) {
    if (!plot.waterfall) return;
    const Waterfall& all = *plot.waterfall;
    std::string text = "time s";
    for (int c = 0; c < all.columns; ++c)
        text += fmt::format(",{:.6g} Hz in {}", plot.value_at((c + 0.5) / all.columns), plot.level_unit);
    text += "\n";
    for (int row = 0; row < all.rows; ++row) {
        text += fmt::format("{:.9f}", all.time.low + all.time.span() * (row + 0.5) / all.rows);
        for (int c = 0; c < all.columns; ++c)
            text += all.bins[all.index_of(row, c)] > 0.0 ? fmt::format(",{}", all.at(row, c)) : ",";
        text += "\n";
    }
    table::save_csv(path, text);
}

void write_histogram_csv(const Plot& plot, const std::filesystem::path& path) {
    std::string text = fmt::format("{},{},share %\n", column_name("from", plot.x_unit), column_name("to", plot.x_unit));
    // A part is four points: up at its left edge, down at its right one.
    for (const Curve& curve : plot.curves)
        for (std::size_t i = 0; i + 3 < curve.points.size(); i += 4)
            text += fmt::format("{},{},{}\n", curve.points[i + 1].x, curve.points[i + 2].x, curve.points[i + 1].y);
    table::save_csv(path, text);
}

void write_pairs_csv(const Plot& plot, const std::filesystem::path& path) {
    std::string text = column_name("x", plot.x_unit) + "," + column_name("y", plot.y_unit) + "\n";
    for (const Curve& curve : plot.curves)
        for (const Point& p : curve.points) text += fmt::format("{},{}\n", p.x, p.y);
    table::save_csv(path, text);
}

}  // namespace tactus::window
