// SPDX-License-Identifier: Apache-2.0
#include "graph/patch/patch.hpp"

#include "assets/file/toml_file.hpp"
#include "dsp/core/units.hpp"
#include "graph/patch/patch_window.hpp"
#include "graph/patch/patch_wire.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <unordered_set>

namespace tactus::patch {

namespace {

const std::array<std::string, 16> top_level{"title",   "about",      "wires",     "quantum", "seed",  "assets",
                                            "groups",  "devices",    "actuators", "sensors", "nodes", "inputs",
                                            "outputs", "parameters", "parts",     "window"};

class PatchReader {
public:
    PatchReader(const std::filesystem::path& file, Problems& problems)
        : file_(file), name_(file.string()), problems_(problems), earlier_(problems.list.size()) {}

    Patch read(std::string_view text) {
        patch_.file = file_;
        patch_.text = text;
        file::TomlTable parsed;
        try {
            parsed = file::parse_toml(text, name_);
        } catch (const Error& error) {
            problems_.list.push_back(error);
            return std::move(patch_);
        }
        const toml::table& root = *parsed;
        for (const auto& [key, value] : root) entry(key, value);
        if (const toml::array* parts = root["parts"].as_array(); parts && !parts->empty()) end_text(*parts, root);
        sort_by_place(patch_.nodes);
        sort_by_place(patch_.assets);
        sort_by_place(patch_.devices);
        sort_by_place(patch_.actuators);
        if (patch_.nodes.empty() && problems_.empty())
            problems_.add({file_.string(), 1, 1}, "the patch has no nodes; a node is a table such as [nodes.hand]");
        std::ranges::stable_sort(problems_.list.begin() + static_cast<std::ptrdiff_t>(earlier_), problems_.list.end(),
                                 comes_before, &Error::where);
        return std::move(patch_);
    }

private:
    SourceLocation at(const toml::source_region& region) const { return file::toml_place(name_, region); }
    SourceLocation at(const toml::node& node) const { return at(node.source()); }

    static bool comes_before(const SourceLocation& a, const SourceLocation& b) {
        return std::pair(a.line, a.column) < std::pair(b.line, b.column);
    }

    // TOML tables are sorted by key. Users expect the order of the file.
    template <class Item>
    static void sort_by_place(std::vector<Item>& items) {
        if (std::ranges::is_sorted(items, comes_before, &Item::where)) return;
        // Items are large: move each once.
        std::vector<Item*> order;
        for (Item& item : items) order.push_back(&item);
        std::ranges::stable_sort(order, comes_before, [](const Item* item) { return std::cref(item->where); });
        std::vector<Item> sorted;
        sorted.reserve(items.size());
        for (Item* item : order) sorted.push_back(std::move(*item));
        items = std::move(sorted);
    }

    void entry(const toml::key& key, const toml::node& value) {
        const std::string_view name = key.str();
        if (name == "title" || name == "about") {
            const std::string text = string_of(value, name);
            if (name == "title") patch_.title = text;
        } else if (name == "wires") wires(value);
        else if (name == "quantum") quantum(value);
        else if (name == "seed") seed(value);
        else if (name == "assets") for_each(value, name, [this](const auto& k, const toml::node& v) { asset(k, v); });
        else if (name == "groups") for_each(value, name, [this](const auto& k, const toml::node& v) { group(k, v); });
        else if (name == "devices") for_each(value, name, [this](const auto& k, const toml::node& v) { device(k, v); });
        else if (name == "actuators")
            for_each(value, name, [this](const auto& k, const toml::node& v) { actuator(k, v, "actuators"); });
        else if (name == "sensors")
            for_each(value, name, [this](const auto& k, const toml::node& v) { actuator(k, v, "sensors"); });
        else if (name == "nodes") for_each(value, name, [this](const auto& k, const toml::node& v) { node(k, v); });
        else if (name == "inputs" || name == "parameters" || name == "outputs") {
            auto& ends = name == "inputs" ? patch_.inputs : name == "outputs" ? patch_.outputs : patch_.parameters;
            for_each(value, name, [&](const toml::key& k, const toml::node& v) { offer(k, v, name, ends); });
        } else if (name == "parts") parts(value);
        else if (name == "window") read_window(value, name_, problems_);
        else
            problems_.add(at(key.source()),
                          fmt::format("unknown key '{}' at the top of a patch{}", name, did_you_mean(name, top_level)));
    }

    template <class Each>
    void for_each(const toml::node& value, std::string_view name, Each&& each) {
        const toml::table* table = value.as_table();
        if (!table) return problems_.add(at(value), fmt::format("'{}' is a table; write [{}]", name, name));
        for (const auto& [key, item] : *table) {
            if (key.str() == "wires" && item.is_array()) misplaced_wires(key, name);
            else if (!is_name(key.str()))
                problems_.add(at(key.source()),
                              fmt::format("'{}' is no name; names have letters, digits, '_' and '-'", key.str()));
            else each(key, item);
        }
    }

    std::string string_of(const toml::node& value, std::string_view name) {
        if (const auto* text = value.as_string()) return text->get();
        problems_.add(at(value), fmt::format("'{}' is a text; put it in quotes", name));
        return {};
    }

    void misplaced_wires(const toml::key& key, std::string_view table) {
        problems_.add(at(key.source()), fmt::format("'wires' is inside [{}]; move it above the first table", table));
    }

    void wires(const toml::node& value) {
        const toml::array* list = value.as_array();
        if (!list) return problems_.add(at(value), "'wires' is a list: wires = [ \"hand.pose -> blade.pose\", … ]");
        for (const toml::node& item : *list) {
            const auto* text = item.as_string();
            if (!text) {
                problems_.add(at(item), "a wire is a text: \"hand.pose -> blade.pose\"");
                continue;
            }
            // Columns inside a text are known only for text on one line without escapes.
            const toml::source_region& region = item.source();
            const bool as_written = region.begin.line == region.end.line &&
                                    region.end.column - region.begin.column == text->get().size() + 2;
            SourceLocation where = at(item);
            if (as_written) ++where.column;  // past the quotation mark
            try {
                patch_.wires.push_back(parse_wire(text->get(), where, as_written));
            } catch (const Error& error) {
                problems_.list.push_back(error);
            }
        }
    }

    void quantum(const toml::node& value) {
        const std::string text = string_of(value, "quantum");
        if (text.empty()) return;
        try {
            const double flicks = parse_as(text, "s") * static_cast<double>(flicks_per_second);
            if (flicks < 1.0 || flicks > static_cast<double>(flicks_per_second))
                throw Error(fmt::format("a quantum lies above zero and up to 1 s, not {}", text));
            if (std::abs(flicks - std::round(flicks)) > 1e-6)
                throw Error(fmt::format("{} is not exact; the nearest that is: {:.12g} ms", text,
                                        std::round(flicks) * 1e3 / static_cast<double>(flicks_per_second)));
            patch_.quantum = std::llround(flicks);
        } catch (const Error& error) {
            problems_.add(at(value), error.message());
        }
    }

    void seed(const toml::node& value) {
        const auto* number = value.as_integer();
        if (!number || number->get() < 0) return problems_.add(at(value), "'seed' is a whole number, not negative");
        patch_.seed = static_cast<std::uint64_t>(number->get());
    }

    void offer(const toml::key& key, const toml::node& value, std::string_view table, std::vector<PatchEnd>& ends) {
        const auto one = [&](const toml::node& item) {
            const auto* text = item.as_string();
            const std::string_view end = text ? std::string_view(text->get()) : "";
            const std::size_t dot = end.find('.');
            if (dot == std::string_view::npos || !is_name(end.substr(0, dot)) || !is_name(end.substr(dot + 1)))
                return problems_.add(at(item), fmt::format("'{}' must name what it controls: \"node.{}\"", key.str(),
                                                           table == "parameters" ? "parameter" : "port"));
            ends.push_back(
                {std::string(key.str()), std::string(end.substr(0, dot)), std::string(end.substr(dot + 1)), at(item)});
        };
        if (const toml::array* list = value.as_array(); list && table != "outputs")
            for (const toml::node& item : *list) one(item);
        else one(value);
    }

    void parts(const toml::node& value) {
        const toml::array* list = value.as_array();
        if (!list) return problems_.add(at(value), "'parts' are tables: [[parts]] with 'path' and 'text'");
        std::unordered_set<std::string> known;
        for (const toml::node& item : *list) {
            const toml::table* part = item.as_table();
            const toml::value<std::string>* path = part ? part->get_as<std::string>("path") : nullptr;
            const toml::value<std::string>* text = part ? part->get_as<std::string>("text") : nullptr;
            if (!path || !text || part->size() != 2 || path->get().empty()) {
                problems_.add(at(item), "a part has a 'path' and a 'text', and nothing else");
            } else if (!known.insert(path->get()).second) {
                problems_.add(at(item), fmt::format("the part '{}' is there already", path->get()));
            } else {
                patch_.parts.push_back({path->get(), text->get()});
            }
        }
    }

    /// Cuts the text at the first [[parts]].
    void end_text(const toml::array& parts, const toml::table& root) {
        const auto first = parts.front().source().begin.line;
        for (const auto& [key, value] : root)
            if (key.str() != "parts" && std::max(key.source().begin.line, last_line(value)) >= first)
                return problems_.add(at(parts.front()), "[[parts]] stand at the end of a patch");
        std::size_t end = 0;
        for (toml::source_index line = 1; line < first; ++line) end = patch_.text.find('\n', end) + 1;
        patch_.text.resize(end - (end > 0));  // with the newline that a bundle adds before the parts
    }

    /// The last line on which an item of `value` begins. The tables of a file need not be adjacent.
    static toml::source_index last_line(const toml::node& value) {
        toml::source_index last = value.source().begin.line;
        if (const toml::table* table = value.as_table())
            for (const auto& [key, item] : *table) last = std::max({last, key.source().begin.line, last_line(item)});
        return last;
    }

    void asset(const toml::key& key, const toml::node& value) {
        const std::string path = string_of(value, key.str());
        if (!value.is_string()) return;
        if (path.empty()) return problems_.add(at(value), fmt::format("asset '{}' names no file", key.str()));
        const std::filesystem::path given(path);
        patch_.assets.push_back(
            {std::string(key.str()), given.is_absolute() ? given : file_.parent_path() / given, at(value)});
    }

    /// True for a value that is no text; the error has been reported.
    static bool is_mistyped(const toml::table& table, std::string_view key) {
        const toml::node* value = table.get(key);
        return value && !value->is_string();
    }

    /// The table `[kind.name]`, or null after an error.
    const toml::table* table_of(const toml::key& key, const toml::node& value, std::string_view kind) {
        const toml::table* table = value.as_table();
        if (!table) problems_.add(at(value), fmt::format("'{}' is a table; write [{}.{}]", key.str(), kind, key.str()));
        return table;
    }

    void group(const toml::key& key, const toml::node& value) {
        const toml::table* table = table_of(key, value, "groups");
        if (!table) return;
        PatchGroup group{std::string(key.str()), {}, {}, -1, at(key.source())};
        static const std::array<std::string, 3> keys{"rate", "latency", "backlog"};
        for (const auto& [name, item] : *table) {
            if (name.str() == "rate") group.rate = string_of(item, "rate");
            else if (name.str() == "latency") group.latency = string_of(item, "latency");
            else if (name.str() == "backlog") {
                const auto* number = item.as_integer();
                if (number && number->get() >= 0 && number->get() <= 1'000'000)
                    group.backlog = static_cast<int>(number->get());
                else problems_.add(at(item), "'backlog' is a whole number of ticks, not negative");
            } else if (name.str() == "wires") misplaced_wires(name, fmt::format("groups.{}", group.name));
            else
                problems_.add(at(name.source()),
                              fmt::format("unknown key '{}' of a group{}", name.str(), did_you_mean(name.str(), keys)));
        }
        if (group.rate.empty() && !is_mistyped(*table, "rate"))
            problems_.add(group.where, fmt::format("group '{}' has no rate", group.name));
        patch_.groups.push_back(std::move(group));
    }

    void device(const toml::key& key, const toml::node& value) {
        const toml::table* table = table_of(key, value, "devices");
        if (!table) return;
        PatchDevice device{std::string(key.str()), {}, at(key.source()), {}};
        for (const auto& [name, item] : *table) {
            if (name.str() == "driver") device.driver = string_of(item, "driver");
            else setting(name, item, fmt::format("devices.{}", device.name), device.settings);
        }
        if (device.driver.empty() && !is_mistyped(*table, "driver"))
            problems_.add(device.where, fmt::format("device '{}' names no driver", device.name));
        sort_by_place(device.settings);
        patch_.devices.push_back(std::move(device));
    }

    /// A sensor is kept among the actuators, as "sensors.NAME": names have no point.
    void actuator(const toml::key& key, const toml::node& value, const char* kind) {
        const toml::table* table = table_of(key, value, kind);
        if (!table) return;
        const std::string name = fmt::format("{}.{}", kind, key.str());
        PatchActuator actuator{
            kind == std::string_view("sensors") ? name : std::string(key.str()), at(key.source()), {}};
        for (const auto& [option, item] : *table) setting(option, item, name, actuator.settings);
        sort_by_place(actuator.settings);
        patch_.actuators.push_back(std::move(actuator));
    }

    void node(const toml::key& key, const toml::node& value) {
        const toml::table* table = table_of(key, value, "nodes");
        if (!table) return;
        PatchNode node;
        node.name = key.str();
        node.where = node.type_where = node.rate_where = at(key.source());
        for (const auto& [name, item] : *table) {
            if (name.str() == "type") {
                node.type = string_of(item, "type");
                node.type_where = at(item);
            } else if (name.str() == "rate" || name.str() == "group") {
                (name.str() == "rate" ? node.rate : node.group) = string_of(item, name.str());
                node.rate_where = at(item);
            } else setting(name, item, fmt::format("nodes.{}", node.name), node.settings);
        }
        if (node.type.empty() && !is_mistyped(*table, "type"))
            problems_.add(node.where, fmt::format("node '{}' has no type", node.name));
        // The nodes of a sub-patch have rates of their own, or rate = "outer".
        const bool may_be_without = is_sub_patch(node) && node.rate.empty() && node.group.empty();
        if (!may_be_without && node.rate.empty() == node.group.empty() && !is_mistyped(*table, "rate") &&
            !is_mistyped(*table, "group"))
            problems_.add(node.where, fmt::format("node '{}' needs {}", node.name,
                                                  node.rate.empty() ? "a 'rate' or a 'group'"
                                                                    : "either 'rate' or 'group', not both"));
        sort_by_place(node.settings);
        patch_.nodes.push_back(std::move(node));
    }

    void setting(const toml::key& key, const toml::node& value, const std::string& owner,
                 std::vector<OptionText>& into) {
        if (key.str() == "wires" && value.is_array()) return misplaced_wires(key, owner);
        if (const std::optional<std::string> text = scalar_text(value)) {
            into.push_back({std::string(key.str()), *text, at(value)});
            return;
        }
        if (const toml::array* list = value.as_array(); list && list->size() == 3) {
            std::string joined;
            for (const toml::node& item : *list) {
                const std::optional<std::string> text = item.is_boolean() ? std::nullopt : scalar_text(item);
                if (!text) return problems_.add(at(item), "a vector has three quantities");
                joined += (&item == list->get(0) ? "" : ", ") + *text;
            }
            into.push_back({std::string(key.str()), joined, at(value)});
            return;
        }
        problems_.add(at(value),
                      fmt::format("'{}' is neither a text, a number, true or false, nor a list of three", key.str()));
    }

    static std::optional<std::string> scalar_text(const toml::node& value) {
        if (const auto* text = value.as_string()) return text->get();
        if (const auto* number = value.as_integer()) return fmt::format("{}", number->get());
        if (const auto* number = value.as_floating_point()) return fmt::format("{}", number->get());
        if (const auto* flag = value.as_boolean()) return flag->get() ? "true" : "false";
        return std::nullopt;
    }

    std::filesystem::path file_;
    std::string name_;  ///< of the file, for messages
    Problems& problems_;
    std::size_t earlier_;  ///< number of problems before
    Patch patch_;
};

}  // namespace

Patch read_patch(std::string_view text, const std::filesystem::path& file, Problems& problems) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return PatchReader(file, problems).read(text);
}

}  // namespace tactus::patch
