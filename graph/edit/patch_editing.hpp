// SPDX-License-Identifier: Apache-2.0
// A patch's text during an edit, with the positions of its parts. Implementation of graph/edit/patch_edit.hpp.
#pragma once

#include "graph/edit/patch_edit.hpp"
#include "graph/edit/toml_spans.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tactus::edit {

/// Members throw Error if the named item does not exist.
class Editing {
public:
    using Path = std::vector<std::string>;

    explicit Editing(std::string_view text) : text_(text), spans_(toml_spans(text_)) {}

    std::string result() { return std::move(text_); }

    void set(const Path& owner, std::string_view name, std::string_view value);

    void reset(const Path& owner, std::string_view name);

    /// Sets an entry to a value in TOML syntax. Adds the table at the end if it does not exist.
    void put(const Path& owner, std::string_view name, std::string_view value);
    /// Removes an entry or a table, in whichever notation it is written. Returns false if it does not exist.
    bool drop(const Path& path);

    void add_table(const NewNode& node);

    void remove_node(std::string_view name);

    void rename(std::string_view from, std::string_view to);

    /// Replaces the group or rate of a node in its line.
    void move_to_lane(std::string_view node, std::string_view lane, bool is_group);

    std::string_view text() const { return text_; }
    const TomlSpans& spans() const { return spans_; }

    void replace(const TextSpan& span, std::string_view by);

private:
    bool has(const Path& path) const;

    /// Returns the end of the last item that belongs to a header.
    std::size_t last_of(std::size_t header) const;

    /// Inserts a new entry as a line after `at`.
    void insert_line(std::size_t at, const std::string& entry);

    void insert(const Path& owner, std::string_view name, const std::string& value);

    /// Removes an entry with its line or, in an inline table, with a comma.
    void remove(const TomlEntry& entry);

    bool remove_one(const Path& path);

    void close_part(std::string_view name);

    std::string text_;
    TomlSpans spans_;
};

}  // namespace tactus::edit
