// SPDX-License-Identifier: Apache-2.0
// An edit of a patch's text on its way: what the text looks like by now, and where its parts stand. Behind
// graph/edit/patch_edit.hpp.
#pragma once

#include "graph/edit/patch_edit.hpp"
#include "graph/edit/toml_spans.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tactus::edit {

/// Members throw Error when what they name is not there.
class Editing {
public:
    using Path = std::vector<std::string>;

    explicit Editing(std::string_view text) : text_(text), spans_(toml_spans(text_)) {}

    std::string result() { return std::move(text_); }

    void set(const Path& owner, std::string_view name, std::string_view value);

    void reset(const Path& owner, std::string_view name);

    /// Sets an entry to a value as TOML writes it. A table that is not there is added at the end.
    void put(const Path& owner, std::string_view name, std::string_view value);
    /// Removes an entry or a table, wherever it is written. False: it is not there.
    bool drop(const Path& path);

    void add_table(const NewNode& node);

    void remove_node(std::string_view name);

    void rename(std::string_view from, std::string_view to);

    /// Gives a node another group or rate, where the one that it has is written.
    void move_to_lane(std::string_view node, std::string_view lane, bool is_group);

    std::string_view text() const { return text_; }
    const TomlSpans& spans() const { return spans_; }

    void replace(const TextSpan& span, std::string_view by);

private:
    bool has(const Path& path) const;

    /// End of the last thing that belongs to a header.
    std::size_t last_of(std::size_t header) const;

    /// A new entry, as a line behind `at`.
    void insert_line(std::size_t at, const std::string& entry);

    void insert(const Path& owner, std::string_view name, const std::string& value);

    /// With its line, or with a comma when it stands between braces.
    void remove(const TomlEntry& entry);

    bool remove_one(const Path& path);

    void close_part(std::string_view name);

    std::string text_;
    TomlSpans spans_;
};

}  // namespace tactus::edit
