// SPDX-License-Identifier: Apache-2.0
#include "tools/report/result/printers.hpp"

#include "assets/table/csv_field.hpp"
#include "dsp/core/overload.hpp"
#include "tools/report/figures/html_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace tactus::report {

namespace {

using file::Json;

/// Characters: bytes that begin one.
std::size_t width_of(std::string_view text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t width, bool to_right) {
    const std::string space(width - std::min(width, width_of(text)), ' ');
    return to_right ? space + text : text + space;
}

enum class Medium { terminal, page };

bool is_printed(const ResultEntry& entry, Medium medium) {
    return !entry.name.empty() &&
           (entry.where == Where::everywhere || (entry.where == Where::pages && medium == Medium::page));
}

template <class Kind>
const Kind* as(const ResultEntry& entry) {
    return std::get_if<Kind>(&entry.value);
}

bool is_scalar(const ResultEntry& entry) {
    return !as<ResultEntry::Rows>(entry) && !as<ResultEntry::Children>(entry) && !as<ResultEntry::Picture>(entry) &&
           !as<ResultEntry::Series>(entry) && !as<ResultEntry::Pictures>(entry) && !as<ResultEntry::Remark>(entry);
}

/// A name and a value on one line, or, of texts that are apart, a line for each.
bool is_line(const ResultEntry& entry, Medium medium) {
    return is_printed(entry, medium) && is_scalar(entry) && !is_missing(entry) && entry.severity != Severity::warning;
}

/// Paragraphs of pages, under a heading.
const ResultEntry::Texts* section_of_texts(const ResultEntry& entry) {
    const auto* texts = as<ResultEntry::Texts>(entry);
    return texts && texts->is_apart && entry.where == Where::pages ? texts : nullptr;
}

std::vector<std::string> lines_of(const ResultEntry& entry) {
    const auto* texts = as<ResultEntry::Texts>(entry);
    if (const auto* groups = as<ResultEntry::Groups>(entry)) {
        std::vector<std::string> lines;
        for (const auto& group : groups->groups) lines.push_back(fmt::format("{}", fmt::join(group, ", ")));
        return lines;
    }
    return texts && texts->is_apart ? texts->texts : std::vector{shown(entry)};
}

std::vector<std::string> warnings_of(const ResultEntry& entry, Medium medium) {
    if (entry.severity != Severity::warning || is_missing(entry) || !is_printed(entry, medium)) return {};
    const auto* texts = as<ResultEntry::Texts>(entry);
    return texts ? texts->texts : std::vector{shown(entry)};
}

std::string_view unit_of(const ResultEntry& entry) {
    if (const auto* q = as<ResultEntry::Quantity>(entry))
        return q->number.unit.empty() ? q->format.unit : q->number.unit;
    if (const auto* n = as<ResultEntry::Numbers>(entry)) return n->format.unit;
    return {};
}

/// A table as cells. A column of numbers in one unit has it in its head.
struct Cells {
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
    std::vector<bool> are_numbers, warnings;
    std::vector<Vec3> marks;
};

const ResultEntry* entry_of(const Result& row, const std::pair<std::string, std::string>& column) {
    for (const ResultEntry& entry : row.entries)
        if (entry.key == column.first && entry.name == column.second) return &entry;
    return nullptr;
}

Cells cells_of(const ResultEntry::Rows& table) {
    Cells cells;
    cells.rows.resize(table.rows.size());
    cells.warnings.resize(table.rows.size());
    for (const Result& row : table.rows)
        if (row.mark) cells.marks.push_back(*row.mark);
    for (const auto& column : table.columns) {
        std::vector<const ResultEntry*> entries;
        bool is_number = false, is_used = false;
        std::string_view unit;
        bool has_one_unit = true;
        for (const Result& row : table.rows) {
            const ResultEntry* entry = entry_of(row, column);
            entries.push_back(entry);
            if (!entry || is_missing(*entry)) continue;
            is_used = true;
            is_number |= as<ResultEntry::Quantity>(*entry) || as<ResultEntry::Integer>(*entry);
            const auto* q = as<ResultEntry::Quantity>(*entry);
            if (q && q->format.notation == NumberFormat::Notation::prefixed) has_one_unit = false;
            if (unit.empty()) unit = unit_of(*entry);
            has_one_unit &= unit == unit_of(*entry);
        }
        if (!is_used) continue;
        const bool in_head = has_one_unit && !unit.empty();
        cells.head.push_back(in_head ? fmt::format("{}, {}", column.second, unit) : column.second);
        cells.are_numbers.push_back(is_number);
        for (std::size_t n = 0; n < entries.size(); ++n) {
            std::string text = entries[n] ? shown(*entries[n]) : "–";
            if (in_head) {
                const std::string ending = unit == "°" ? std::string(unit) : " " + std::string(unit);
                for (std::size_t at = 0; (at = text.find(ending, at)) != std::string::npos;)
                    text.erase(at, ending.size());
            }
            cells.rows[n].push_back(std::move(text));
            if (entries[n] && (entries[n]->severity == Severity::warning || entries[n]->severity == Severity::fail))
                cells.warnings[n] = true;
        }
    }
    return cells;
}

std::string table_text(const Cells& cells, const std::string& indent) {
    std::string out;
    std::vector<std::size_t> widths;
    for (const std::string& head : cells.head) widths.push_back(width_of(head));
    for (const auto& row : cells.rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width_of(row[c]));
    const auto add = [&](const std::vector<std::string>& row) {
        std::string line = indent;
        for (std::size_t c = 0; c < row.size(); ++c)
            line += (c > 0 ? "  " : "") + padded(row[c], widths[c], cells.are_numbers[c]);
        while (line.ends_with(' ')) line.pop_back();
        out += line + "\n";
    };
    add(cells.head);
    for (const auto& row : cells.rows) add(row);
    return out;
}

/// `heading`: above the result; a table of this name does not repeat it.
void add_text(std::string& out, const Result& result, const std::string& indent, const std::string& heading) {
    for (const ResultEntry& entry : result.entries)
        for (const std::string& text : warnings_of(entry, Medium::terminal))
            out += fmt::format("{}{}: {}\n", indent, entry.name, text);
    std::size_t width = 0;
    for (const ResultEntry& entry : result.entries)
        if (is_line(entry, Medium::terminal)) width = std::max(width, width_of(entry.name));
    for (const ResultEntry& entry : result.entries) {
        if (!is_printed(entry, Medium::terminal) || is_missing(entry)) continue;
        if (const auto* rows = as<ResultEntry::Rows>(entry))
            out += (entry.name == heading ? "" : fmt::format("{}{}\n", indent, entry.name)) +
                   table_text(cells_of(*rows), entry.name == heading ? indent : indent + "  ");
        else if (const auto* children = as<ResultEntry::Children>(entry)) {
            for (const Result& one : children->results) {
                const std::string& head = one.title.empty() ? entry.name : one.title;
                out += fmt::format("{}{}\n", indent, head);
                add_text(out, one, indent + "  ", head);
            }
        } else if (is_line(entry, Medium::terminal)) {
            for (const std::string& line : lines_of(entry))
                out += fmt::format("{}{}  {}\n", indent, padded(entry.name, width, false), line);
        }
    }
}

/// A negative zero becomes 0.
Json number_json(double value) { return std::isfinite(value) ? Json(value + 0.0) : Json(); }

Json value_json(const ResultEntry& entry) {
    return std::visit(
        Overload{[](const ResultEntry::Quantity& q) { return q.number.value ? number_json(*q.number.value) : Json(); },
                 [](const ResultEntry::Numbers& n) {
                     if (!n.values) return Json();
                     Json list = Json::array();
                     for (const auto& value : *n.values) list.push_back(value ? number_json(*value) : Json());
                     return list;
                 },
                 [](const ResultEntry::Integer& i) { return i.value ? Json(*i.value) : Json(); },
                 [](const ResultEntry::Integers& i) { return Json(i.values); },
                 [](const ResultEntry::Text& t) { return t.text ? Json(*t.text) : Json(); },
                 [](const ResultEntry::Flag& f) { return f.value ? Json(*f.value) : Json(); },
                 [](const ResultEntry::Texts& t) { return Json(t.texts); },
                 [](const ResultEntry::Groups& g) { return Json(g.groups); },
                 [](const ResultEntry::Remark&) { return Json(); },
                 [](const ResultEntry::Series& s) {
                     Json list = Json::array();
                     if (s.columns == 0)
                         for (std::size_t n = 0; n < s.size; ++n) list.push_back(number_json(s.at(n)));
                     else
                         for (std::size_t row = 0; row < s.size; row += s.columns) {
                             list.push_back(Json::array());
                             for (std::size_t n = row; n < row + s.columns; ++n)
                                 list.back().push_back(number_json(s.at(n)));
                         }
                     return list;
                 },
                 [](const ResultEntry::Picture&) { return Json(); },
                 [](const ResultEntry::Pictures&) { return Json(); },
                 [](const ResultEntry::Rows& r) {
                     Json list = Json::array();
                     for (const Result& row : r.rows) list.push_back(json_of(row));
                     return list;
                 },
                 [](const ResultEntry::Children& c) {
                     if (!c.is_list) return c.results.empty() ? Json() : json_of(c.results.front());
                     Json list = Json::array();
                     for (const Result& one : c.results) list.push_back(json_of(one));
                     return list;
                 }},
        entry.value);
}

std::string capitalised(std::string text) {
    if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
        text.front() = static_cast<char>(text.front() - 32);
    return text;
}

/// `title`: of the page or the section, which is no heading again.
void add_blocks(std::vector<ReportBlock>& out, const Result& result, int depth, const std::string& title) {
    ReportList warnings{{}, true};
    ReportTable values{{"value", ""}, {}};
    for (const ResultEntry& entry : result.entries)
        std::ranges::copy(warnings_of(entry, Medium::page), std::back_inserter(warnings.items));
    if (!warnings.items.empty()) {
        out.emplace_back(Heading{"Warnings", true, depth});
        out.emplace_back(std::move(warnings));
    }
    for (const ResultEntry& entry : result.entries) {
        const auto* remark = as<ResultEntry::Remark>(entry);
        if (remark && !remark->text.empty()) out.emplace_back(Paragraph{remark->text});
        if (const auto* picture = as<ResultEntry::Picture>(entry); picture && picture->draw)
            out.emplace_back(Drawing{picture->draw(screen_style), entry.name});
        if (const auto* pictures = as<ResultEntry::Pictures>(entry); pictures && pictures->make)
            if (auto made = pictures->make(); !made.empty()) out.emplace_back(PictureGrid{std::move(made)});
    }
    for (const ResultEntry& entry : result.entries)
        if (is_line(entry, Medium::page) && !section_of_texts(entry))
            for (std::string& line : lines_of(entry)) {
                values.rows.push_back({entry.name, std::move(line)});
                values.warnings.push_back(entry.severity == Severity::fail);
            }
    if (!values.rows.empty()) out.emplace_back(std::move(values));
    const auto head = [&](const std::string& text) {
        if (text != title) out.emplace_back(Heading{capitalised(text), false, depth});
    };
    for (const ResultEntry& entry : result.entries) {
        if (!is_printed(entry, Medium::page) || is_missing(entry)) continue;
        if (const auto* texts = section_of_texts(entry)) {
            head(entry.name);
            out.emplace_back(ReportList{texts->texts});
        } else if (const auto* rows = as<ResultEntry::Rows>(entry)) {
            Cells cells = cells_of(*rows);
            head(entry.name);
            if (!entry.remark.empty()) out.emplace_back(Paragraph{entry.remark});
            out.emplace_back(ReportTable{std::move(cells.head), std::move(cells.rows), std::move(cells.marks),
                                         std::move(cells.warnings)});
        } else if (const auto* children = as<ResultEntry::Children>(entry)) {
            for (const Result& one : children->results) {
                const std::string& section = one.title.empty() ? entry.name : one.title;
                head(section);
                add_blocks(out, one, depth + 1, section);
            }
        }
    }
}

std::string scalar_csv(const Json& json) {
    return json.is_null()           ? std::string()
           : json.is_string()       ? table::csv_field(json.as_text())
           : json.is_number_float() ? fmt::format("{}", json.get<double>())
                                    : json.dump();
}

/// A line for each value of a list, of lists too.
void add_csv(std::string& out, const Json& value, const std::string& path, const std::string& unit) {
    if (!value.is_array()) {
        out += fmt::format("{},{},{}\n", table::csv_field(path), scalar_csv(value), unit);
        return;
    }
    for (std::size_t n = 0; n < value.size(); ++n) add_csv(out, value[n], fmt::format("{}.{}", path, n), unit);
}

void add_csv(std::string& out, const Result& result, const std::string& above) {
    for (const ResultEntry& entry : result.entries) {
        if (entry.key.empty() || (entry.is_omitted && is_missing(entry))) continue;
        const std::string path = above + entry.key;
        const auto each = [&](const std::vector<Result>& all) {
            for (std::size_t n = 0; n < all.size(); ++n) add_csv(out, all[n], fmt::format("{}.{}.", path, n));
        };
        if (const auto* rows = as<ResultEntry::Rows>(entry)) each(rows->rows);
        else if (const auto* children = as<ResultEntry::Children>(entry); children && children->is_list)
            each(children->results);
        else if (children && !children->results.empty()) add_csv(out, children->results.front(), path + ".");
        else add_csv(out, value_json(entry), path, table::csv_field(std::string(unit_of_value(entry))));
    }
}

}  // namespace

std::string text_of(const Result& result) {
    std::string out = result.title.empty() ? "" : result.title + "\n";
    add_text(out, result, result.title.empty() ? "" : "  ", "");
    return out;
}

Json json_of(const Result& result) {
    Json json = Json::object();
    for (const ResultEntry& entry : result.entries)
        if (!entry.key.empty() && !(entry.is_omitted && is_missing(entry))) json[entry.key] = value_json(entry);
    return json;
}

Json output_json(const Result& result) {
    Json json{{"version", result_version}};
    json.update(json_of(result));
    return json;
}

std::vector<ReportBlock> blocks_of(const Result& result) {
    std::vector<ReportBlock> out;
    add_blocks(out, result, 1, title_of(result));
    return out;
}

std::string title_of(const Result& result) {
    if (!result.page_title.empty()) return result.page_title;
    if (!result.title.empty()) return result.title;
    for (const ResultEntry& entry : result.entries)
        if (const auto* children = as<ResultEntry::Children>(entry); children && !children->results.empty()) {
            const std::size_t count = children->results.size();
            return count == 1 ? title_of(children->results.front()) : fmt::format("{} {}s", count, entry.name);
        }
    return {};
}

std::string html_of(const Result& result) { return html::page(title_of(result), html_of(blocks_of(result), "r")); }

std::string csv_of(const Result& result) {
    std::string out = "path,value,unit\n";
    add_csv(out, result, "");
    return out;
}

std::string csv_table(const std::vector<std::string>& columns, const std::vector<Json>& rows) {
    std::string out = fmt::format("{}\n", fmt::join(columns, ","));
    for (const Json& row : rows)
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const Json* cell = row.find(columns[c]);
            out += (c > 0 ? "," : "") + (cell ? scalar_csv(*cell) : std::string());
            if (c + 1 == columns.size()) out += '\n';
        }
    return out;
}

Json schema_of_output(std::vector<Json> kinds) {
    // A kind may itself be one of several.
    std::vector<Json> objects;
    for (const Json& kind : kinds)
        if (const Json* several = kind.find("anyOf")) objects.insert(objects.end(), several->begin(), several->end());
        else objects.push_back(kind);
    for (Json& object : objects) {
        object["properties"]["version"] = {{"const", result_version}};
        object["required"].push_back("version");
    }
    return objects.size() == 1 ? objects.front() : Json{{"anyOf", Json(objects)}};
}

}  // namespace tactus::report
