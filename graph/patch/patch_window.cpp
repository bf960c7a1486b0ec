// SPDX-License-Identifier: Apache-2.0
#include "graph/patch/patch_window.hpp"

#include "assets/file/toml_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace tactus::patch {

namespace {

constexpr double farthest = 1e6;

class WindowReader {
public:
    WindowReader(const std::string& file, Problems& problems) : file_(file), problems_(problems) {}

    PatchWindow read(const toml::node& value) {
        const toml::table* table = table_of(value, "window");
        if (!table) return {};
        for (const auto& [key, item] : *table) entry(key, item);
        return std::move(window_);
    }

private:
    void add(const toml::source_region& where, const std::string& message) {
        problems_.add(file::toml_place(file_, where), message);
    }

    const toml::table* table_of(const toml::node& value, std::string_view name) {
        const toml::table* table = value.as_table();
        if (!table) add(value.source(), fmt::format("'{}' is a table; write [{}]", name, name));
        return table;
    }

    void entry(const toml::key& key, const toml::node& item) {
        static const std::array<std::string, 5> known{"layout", "open", "places", "colours", "comments"};
        const std::string_view name = key.str();
        if (name == "layout") layout(item);
        else if (name == "open") open(item);
        else if (name == "places") {
            each(item, "window.places", [&](const std::string& node, const toml::node& value) {
                if (const auto place = pair(value)) window_.places[node] = *place;
            });
        } else if (name == "colours") {
            each(item, "window.colours",
                 [&](const std::string& node, const toml::node& value) { window_.colours[node] = colour(value); });
        } else if (name == "comments") {
            each(item, "window.comments",
                 [&](const std::string& node, const toml::node& value) { comment(node, value); });
        } else add(key.source(), fmt::format("unknown key '{}' of a window{}", name, did_you_mean(name, known)));
    }

    template <class Each>
    void each(const toml::node& value, std::string_view name, Each&& what) {
        if (const toml::table* table = table_of(value, name))
            for (const auto& [key, item] : *table) what(std::string(key.str()), item);
    }

    void layout(const toml::node& value) {
        const std::string name = text(value);
        if (name == "patch" || name == "plan" || name == "train") window_.layout = name;
        else add(value.source(), "a layout is \"patch\", \"plan\" or \"train\"");
    }

    void open(const toml::node& value) {
        const toml::array* list = value.as_array();
        if (!list) return add(value.source(), "'open' is a list of nodes");
        for (const toml::node& item : *list) window_.open.push_back(text(item));
    }

    std::string text(const toml::node& value) {
        if (const auto* text = value.as_string()) return text->get();
        add(value.source(), "this is a text; put it in quotes");
        return {};
    }

    std::string colour(const toml::node& value) {
        std::string name = text(value);
        if (std::ranges::find(colour_names(), name) != colour_names().end()) return name;
        add(value.source(), fmt::format("unknown colour '{}'{}", name, did_you_mean(name, colour_names())));
        return {};
    }

    std::optional<PatchPlace> pair(const toml::node& value) {
        const toml::array* list = value.as_array();
        const std::optional<double> x = list && list->size() == 2 ? list->get(0)->value<double>() : std::nullopt,
                                    y = x ? list->get(1)->value<double>() : std::nullopt;
        if (x && y && std::abs(*x) <= farthest && std::abs(*y) <= farthest) return PatchPlace{*x, *y};
        add(value.source(), "a place is two numbers, as [240, 60]");
        return std::nullopt;
    }

    void comment(const std::string& name, const toml::node& value) {
        const toml::table* table = table_of(value, "window.comments." + name);
        if (!table) return;
        PatchComment made{name, {}, {}, {0.0, 0.0}, {220.0, 80.0}};
        for (const auto& [key, item] : *table) {
            if (key.str() == "text") made.text = text(item);
            else if (key.str() == "colour") made.colour = colour(item);
            else if (key.str() == "place") made.place = pair(item).value_or(made.place);
            else if (key.str() == "size") made.size = pair(item).value_or(made.size);
            else add(key.source(), fmt::format("unknown key '{}' of a comment", key.str()));
        }
        window_.comments.push_back(std::move(made));
    }

    const std::string& file_;
    Problems& problems_;
    PatchWindow window_;
};

}  // namespace

const std::vector<std::string>& colour_names() {
    static const std::vector<std::string> names{"blue", "green", "amber", "red", "violet", "teal", "grey"};
    return names;
}

PatchWindow read_window(const toml::node& value, const std::string& file, Problems& problems) {
    return WindowReader(file, problems).read(value);
}

PatchWindow window_of(std::string_view text) {
    if (text.find("window") == std::string_view::npos) return {};
    Problems ignored;
    try {
        const file::TomlTable root = file::parse_toml(text, "");
        if (const toml::node* window = root->get("window")) return read_window(*window, "", ignored);
    } catch (const Error&) {
        // The error is reported where the patch is parsed.
    }
    return {};
}

}  // namespace tactus::patch
