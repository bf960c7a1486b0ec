// SPDX-License-Identifier: Apache-2.0
#include "graph/edit/patch_editing.hpp"

#include "dsp/core/error.hpp"
#include "graph/patch/patch_wire.hpp"
#include "graph/patch/text_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace tactus::edit {

namespace {

using Path = Editing::Path;

bool starts_with(const Path& path, const Path& with) {
    return path.size() >= with.size() && std::equal(with.begin(), with.end(), path.begin());
}

/// Numbers, true and false are written without quotes.
bool is_bare(std::string_view value) {
    if (value == "true" || value == "false") return true;
    const std::string_view digits = value.starts_with('-') ? value.substr(1) : value;
    if (digits.empty() || !std::isdigit(static_cast<unsigned char>(digits.front()))) return false;
    if (digits.size() > 1 && digits[0] == '0' && digits[1] != '.') return false;
    if (!std::isdigit(static_cast<unsigned char>(value.back()))) return false;
    double number = 0.0;
    const auto [end, failure] = std::from_chars(value.data(), value.data() + value.size(), number);
    return failure == std::errc{} && end == value.data() + value.size();
}

std::string literal(std::string_view value) { return is_bare(value) ? std::string(value) : toml_quoted(value); }

/// Writes a value in the form of the old one: in quotes, as a list of quantities, or bare.
std::string literal_like(std::string_view before, std::string_view value) {
    if (before.starts_with('"') || before.starts_with('\'')) return toml_quoted(value);
    if (!before.starts_with('[')) return literal(value);
    std::string list = "[";
    for (std::size_t at = 0; at <= value.size();) {
        const std::size_t end = std::min(value.find(',', at), value.size());
        std::string_view part = value.substr(at, end - at);
        while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
        list += (list.size() > 1 ? ", " : "") + literal(part);
        at = end + 1;
    }
    return list + "]";
}

/// "key = value" in the layout of the entry above it.
std::string entry_like(std::string_view text, const TomlEntry& above, std::string_view key, std::string_view value) {
    const std::size_t key_begin = above.keys.back().begin, equals = text.find('=', above.keys.back().end);
    const std::string before(text.substr(above.span.begin, key_begin - above.span.begin));
    const std::string behind(text.substr(equals + 1, above.value.begin - equals - 1));
    const std::size_t width = std::max(equals - key_begin, key.size() + (equals > above.keys.back().end ? 1 : 0));
    return fmt::format("{}{:<{}}={}{}", before, key, width, behind, value);
}

}  // namespace

void Editing::set(const Path& owner, std::string_view name, std::string_view value) {
    Path path = owner;
    path.emplace_back(name);
    if (const TomlEntry* entry = spans_.find(path))
        return replace(entry->value, literal_like(entry->value.of(text_), value));
    insert(owner, name, literal(value));
}

void Editing::reset(const Path& owner, std::string_view name) {
    Path path = owner;
    path.emplace_back(name);
    const TomlEntry* entry = spans_.find(path);
    if (!entry) throw Error(fmt::format("'{}.{}' is not set in the patch", owner.back(), name));
    remove(*entry);
}

void Editing::put(const Path& owner, std::string_view name, std::string_view value) {
    if (!patch::is_name(name))
        throw Error(fmt::format("'{}' is no name; names have letters, digits, '_' and '-'", name));
    Path path = owner;
    path.emplace_back(name);
    if (const TomlEntry* entry = spans_.find(path)) return replace(entry->value, value);
    const TomlEntry* const inline_table = spans_.find(owner);
    const bool is_there = inline_table || std::ranges::any_of(spans_.headers, [&](const TomlHeader& header) {
                              return header.path == owner;
                          });
    if (!is_there) {
        const std::string newline(patch::newline_of(text_));
        std::string header;
        for (const std::string& part : owner) header += (header.empty() ? "" : ".") + part;
        const bool ends_line = text_.empty() || text_.back() == '\n';
        replace({text_.size(), text_.size()},
                fmt::format("{}{}[{}]{}", ends_line ? "" : newline, text_.empty() ? "" : newline, header, newline));
    }
    insert(owner, name, std::string(value));
}

bool Editing::drop(const Path& path) {
    bool is_gone = false;
    while (remove_one(path)) is_gone = true;
    return is_gone;
}

void Editing::add_table(const NewNode& node) {
    if (!patch::is_name(node.name))
        throw Error(fmt::format("'{}' is no name; names have letters, digits, '_' and '-'", node.name));
    if (has({"nodes", node.name})) throw Error(fmt::format("there is a node '{}' already", node.name));
    std::vector<std::pair<std::string, std::string>> lines{{"type", toml_quoted(node.type)}};
    if (!node.rate.empty()) lines.emplace_back("rate", toml_quoted(node.rate));
    if (!node.group.empty()) lines.emplace_back("group", toml_quoted(node.group));
    for (const auto& [name, value] : node.settings) lines.emplace_back(name, literal(value));
    if (const TomlEntry* all = spans_.find({"nodes"}); all && all->value.of(text_).starts_with('{')) {
        std::string table = "{ ";
        for (const auto& [name, value] : lines)
            table += fmt::format("{}{} = {}", table.size() > 2 ? ", " : "", name, value);
        return insert({"nodes"}, node.name, table + " }");
    }
    std::size_t width = 0;
    for (const auto& line : lines) width = std::max(width, line.first.size());
    const std::string newline(patch::newline_of(text_));
    std::string table = fmt::format("[nodes.{}]{}", node.name, newline);
    for (const auto& [name, value] : lines) table += fmt::format("{:<{}} = {}{}", name, width, value, newline);
    std::size_t at = text_.size();
    for (std::size_t h = 0; h < spans_.headers.size(); ++h)
        if (const auto& path = spans_.headers[h].path; !path.empty() && path.front() == "nodes")
            at = patch::line_end(text_, last_of(h));
    const bool ends_line = at == 0 || text_[at - 1] == '\n';
    replace({at, at}, (ends_line ? "" : newline) + (at == 0 ? "" : newline) + table);
}

void Editing::remove_node(std::string_view name) {
    const Path path{"nodes", std::string(name)};
    if (!has(path)) throw Error(fmt::format("no node '{}'", name));
    drop(path);
    for (const char* table : {"places", "colours"}) drop({"window", table, std::string(name)});
    close_part(name);
}

/// Takes a node off the list of open sub-patches.
void Editing::close_part(std::string_view name) {
    const TomlEntry* open = spans_.find({"window", "open"});
    if (!open || !open->value.of(text_).starts_with('[')) return;
    const std::vector<TomlElement> all = toml_elements(text_, open->value);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (toml_unquoted(all[i].value.of(text_)) != name) continue;
        const std::size_t own_end = std::max(all[i].value.end, all[i].comma.end);
        if (i + 1 < all.size()) replace({all[i].value.begin, all[i + 1].value.begin}, "");
        else if (i > 0) replace({all[i - 1].value.end, own_end}, "");
        else replace({all[i].value.begin, own_end}, "");
        return close_part(name);
    }
}

void Editing::rename(std::string_view from, std::string_view to) {
    const Path path{"nodes", std::string(from)};
    if (!has(path)) throw Error(fmt::format("no node '{}'", from));
    if (!patch::is_name(to)) throw Error(fmt::format("'{}' is no name; names have letters, digits, '_' and '-'", to));
    if (has({"nodes", std::string(to)})) throw Error(fmt::format("there is a node '{}' already", to));
    std::vector<TextSpan> places;
    for (const TomlHeader& header : spans_.headers)
        if (starts_with(header.path, path)) places.push_back(header.keys[1]);
    for (const TomlEntry& entry : spans_.entries)
        if (const TextSpan* key = entry.key(1); key && starts_with(entry.path, path)) places.push_back(*key);
    for (const TomlEntry& entry : spans_.entries)
        if (const TextSpan* key = entry.key(2);
            key && entry.path.size() == 3 && entry.path[0] == "window" && entry.path[2] == from)
            places.push_back(*key);
    // The list of open sub-patches has names in quotes.
    if (const TomlEntry* open = spans_.find({"window", "open"}); open && open->value.of(text_).starts_with('['))
        for (const TomlElement& element : toml_elements(text_, open->value))
            if (toml_unquoted(element.value.of(text_)) == from)
                places.push_back({element.value.begin + 1, element.value.end - 1});
    std::ranges::sort(places, std::greater{}, &TextSpan::begin);
    for (const TextSpan& place : places) text_.replace(place.begin, place.end - place.begin, to);
    spans_ = toml_spans(text_);
}

void Editing::move_to_lane(std::string_view node, std::string_view lane, bool is_group) {
    const Path path{"nodes", std::string(node)};
    if (!has(path)) throw Error(fmt::format("no node '{}'", node));
    const std::string key = is_group ? "group" : "rate", other = is_group ? "rate" : "group";
    Path known = path, former = path;
    known.push_back(key);
    former.push_back(other);
    if (spans_.find(known)) drop(former);
    else if (const TomlEntry* entry = spans_.find(former)) {
        // Keep the alignment of columns.
        TextSpan span = entry->keys.back();
        const bool has_room = std::string_view(text_).substr(span.end).starts_with("  ");
        if (is_group && has_room) ++span.end;
        replace(span, is_group ? "group" : has_room || text_[span.end] == ' ' ? "rate " : "rate");
    }
    set(path, key, lane);
}

void Editing::replace(const TextSpan& span, std::string_view by) {
    text_.replace(span.begin, span.end - span.begin, by);
    spans_ = toml_spans(text_);
}

bool Editing::has(const Path& path) const {
    return std::ranges::any_of(spans_.headers, [&](const auto& h) { return starts_with(h.path, path); }) ||
           std::ranges::any_of(spans_.entries, [&](const auto& e) { return starts_with(e.path, path); });
}

std::size_t Editing::last_of(std::size_t header) const {
    std::size_t end = spans_.headers[header].span.end;
    for (const TomlEntry& entry : spans_.entries)
        if (entry.header == static_cast<int>(header)) end = std::max(end, entry.span.end);
    return end;
}

void Editing::insert_line(std::size_t at, const std::string& entry) {
    const std::size_t end = patch::line_end(text_, at);
    const std::string newline(patch::newline_of(text_));
    if (end > 0 && text_[end - 1] == '\n') replace({end, end}, entry + newline);
    else replace({end, end}, newline + entry);
}

void Editing::insert(const Path& owner, std::string_view name, const std::string& value) {
    for (std::size_t h = 0; h < spans_.headers.size(); ++h) {
        if (spans_.headers[h].path != owner) continue;
        const TomlEntry* last = nullptr;
        for (const TomlEntry& entry : spans_.entries)
            if (entry.header == static_cast<int>(h) && entry.parent < 0 && entry.keys.size() == 1) last = &entry;
        if (!last) return insert_line(spans_.headers[h].span.end, fmt::format("{} = {}", name, value));
        const std::string indent = patch::indent_of(text_, last->span.begin);
        return insert_line(last->span.end, indent + entry_like(text_, *last, name, value));
    }
    if (const TomlEntry* table = spans_.find(owner); table && table->value.of(text_).starts_with('{')) {
        const int index = static_cast<int>(table - spans_.entries.data());
        const TomlEntry* last = nullptr;
        for (const TomlEntry& entry : spans_.entries)
            if (entry.parent == index) last = &entry;
        if (!last) return replace(table->value, fmt::format("{{ {} = {} }}", name, value));
        return replace({last->span.end, last->span.end}, fmt::format(", {} = {}", name, value));
    }
    const TomlEntry* last = nullptr;
    for (const TomlEntry& entry : spans_.entries)
        if (starts_with(entry.path, owner) && entry.path.size() == owner.size() + 1) last = &entry;
    if (!last) throw Error(fmt::format("no node '{}'", owner.back()));
    const std::string made = entry_like(text_, *last, name, value);
    if (last->parent >= 0) return replace({last->span.end, last->span.end}, ", " + made);
    insert_line(last->span.end, patch::indent_of(text_, last->span.begin) + made);
}

void Editing::remove(const TomlEntry& entry) {
    if (entry.parent < 0)
        return replace({patch::line_start(text_, entry.span.begin), patch::line_end(text_, entry.span.end)}, "");
    const TomlEntry *before = nullptr, *behind = nullptr;
    for (const TomlEntry& other : spans_.entries) {
        if (other.parent != entry.parent) continue;
        if (other.span.begin < entry.span.begin) before = &other;
        else if (other.span.begin > entry.span.begin && !behind) behind = &other;
    }
    if (behind) replace({entry.span.begin, behind->span.begin}, "");
    else if (before) replace({before->span.end, entry.span.end}, "");
    else replace(entry.span, "");
}

bool Editing::remove_one(const Path& path) {
    for (std::size_t h = 0; h < spans_.headers.size(); ++h) {
        if (!starts_with(spans_.headers[h].path, path)) continue;
        TextSpan block{patch::line_start(text_, spans_.headers[h].span.begin), patch::line_end(text_, last_of(h))};
        // Keeps one of the two blocks of empty lines around it.
        if (block.begin == 0 || patch::is_empty_line(text_, patch::line_start(text_, block.begin - 1)))
            while (block.end < text_.size() && patch::is_empty_line(text_, block.end))
                block.end = patch::line_end(text_, block.end);
        replace(block, "");
        return true;
    }
    for (const TomlEntry& entry : spans_.entries) {
        if (!starts_with(entry.path, path)) continue;
        remove(entry);
        return true;
    }
    return false;
}

}  // namespace tactus::edit
