// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/faults.hpp"

#include "assets/file/toml_file.hpp"
#include "graph/edit/patch_arrange.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ranges>
#include <set>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

/// The node whose table a line belongs to, by its header; empty: the line belongs to no node.
std::string table_node(std::string_view text, int line) {
    std::string node;
    int at = 1;
    for (std::size_t begin = 0; begin <= text.size() && at <= line; ++at) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view here = text.substr(begin, end - begin);
        here.remove_prefix(std::min(here.find_first_not_of(" \t"), here.size()));
        // A list may begin a line as well.
        if (here.size() > 1 && here.front() == '[' && here[1] != '"') {
            constexpr std::string_view head = "[nodes.";
            node.clear();
            const std::size_t close = here.find(']');
            if (here.starts_with(head) && close != std::string_view::npos)
                node = here.substr(head.size(), close - head.size());
            if (node.size() > 1 && node.front() == '"' && node.back() == '"') node = node.substr(1, node.size() - 2);
        }
        begin = end + 1;
    }
    return node;
}

/// The text with this line empty; all others keep their numbers.
bool clear_line(std::string& text, int line) {
    std::size_t begin = 0;
    for (int at = 1; at < line; ++at) {
        begin = text.find('\n', begin);
        if (begin == std::string::npos) return false;
        ++begin;
    }
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (text.find_first_not_of(" \t\r", begin) >= end) return false;
    text.erase(begin, end - begin);
    return true;
}

class ErrorRecovery {
public:
    ErrorRecovery(std::string_view text, fs::path file, const CompilePatch& compile)
        : text_(text), file_(std::move(file)), compile_(compile) {}

    RecoveredPatch run() {
        leave_out_faults();
        std::ranges::stable_sort(made_.faults, [](const Fault& a, const Fault& b) {
            return std::pair(!a.file.empty(), a.line) < std::pair(!b.file.empty(), b.line);
        });
        return std::move(made_);
    }

private:
    void leave_out_faults() {
        read();
        constexpr int max_rounds = 100;
        for (int round = 0; round < max_rounds; ++round)
            if (try_rest()) return;
        give_up();
    }

    /// What can be read, without lines that are no TOML.
    void read() {
        std::string readable = text_;
        const std::vector<Error> torn = clear_torn_lines(readable);
        patch::Problems problems;
        made_.written = patch::read_patch(readable, file_, problems);
        std::set<std::string> torn_nodes;
        for (const Error& error : torn) {
            add(error);
            assign(error);
            torn_nodes.insert(table_node(text_, error.where().line));
        }
        for (const Error& error : problems.list) {
            if (error.message().starts_with("the patch has no nodes")) continue;
            assign(error);
            const patch::PatchNode* node = node_at(error.where());
            // What a table lacks stands in its line that is no TOML.
            if (!node || !torn_nodes.contains(node->name)) add(error);
        }
    }

    std::vector<Error> clear_torn_lines(std::string& text) const {
        constexpr std::size_t max_lines = 8;
        std::vector<Error> torn;
        for (;;) try {
                file::parse_toml(text, file_.string());
                return torn;
            } catch (const Error& error) {
                torn.push_back(error);
                if (torn.size() > max_lines || !clear_line(text, error.where().line)) return torn;
            }
    }

    /// True: what is left compiles, or nothing is left.
    bool try_rest() {
        patch::Patch whole = made_.written;
        std::erase_if(whole.wires, [&](const patch::PatchWire& wire) { return is_broken(wire); });
        patch::Problems problems;
        made_.unfinished = unfinished_of(whole, problems, nodes_);
        for (const patch::PatchWire& wire : made_.written.wires)
            if (const auto broken = wires_.find(place(wire.where)); broken != wires_.end())
                made_.unfinished.broken.push_back({wire, broken->second});
        made_.plan.reset();
        if (problems.empty()) {
            patch::Patch rest = std::move(whole);
            const std::vector<std::string> names = made_.unfinished.names();
            const std::set<std::string_view> out(names.begin(), names.end());
            const auto is_out = [&](const std::string& node) { return out.contains(node); };
            std::erase_if(rest.nodes, [&](const patch::PatchNode& node) { return is_out(node.name); });
            std::erase_if(rest.wires, [&](const patch::PatchWire& wire) {
                return is_out(wire.to_node) || (!wire.from_port.empty() && is_out(wire.from_node));
            });
            for (auto* ends : {&rest.inputs, &rest.outputs, &rest.parameters})
                std::erase_if(*ends, [&](const patch::PatchEnd& end) { return is_out(end.node); });
            if (rest.nodes.empty()) return true;
            if (!made_.unfinished.empty()) rest.text = edit_out();
            std::optional<compile::Schedule> plan = compile_(std::move(rest), problems);
            if (plan && problems.empty()) {
                made_.plan = std::make_unique<compile::Schedule>(std::move(*plan));
                return true;
            }
        }
        bool is_assigned = false;
        for (const Error& error : problems.list) {
            add(error);
            is_assigned |= assign(error);
        }
        if (!is_assigned) give_up();
        return !is_assigned;
    }

    std::string edit_out() const {
        try {
            return edit::without_nodes(made_.written.text, made_.unfinished.names());
        } catch (const Error&) {
            return made_.written.text;
        }
    }

    /// The errors cannot be assigned to nodes or wires: shows all nodes and runs none.
    void give_up() {
        made_.plan.reset();
        std::map<std::string, std::string> all;
        for (const patch::PatchNode& node : made_.written.nodes) all.emplace(node.name, "waits for the errors below");
        for (const auto& [node, why] : nodes_) all[node] = why;
        patch::Problems ignored;
        patch::Patch whole = made_.written;
        std::erase_if(whole.wires, [&](const patch::PatchWire& wire) { return is_broken(wire); });
        auto broken = std::move(made_.unfinished.broken);
        made_.unfinished = unfinished_of(whole, ignored, all);
        made_.unfinished.broken = std::move(broken);
    }

    using Place = std::pair<int, int>;
    static Place place(const SourceLocation& where) { return {where.line, where.column}; }
    bool is_broken(const patch::PatchWire& wire) const { return wires_.contains(place(wire.where)); }

    const patch::PatchWire* wire_at(const SourceLocation& where) const {
        if (where.file != file_.string() || where.line == 0) return nullptr;
        const auto found = std::ranges::find_if(
            made_.written.wires, [&](const patch::PatchWire& wire) { return place(wire.where) == place(where); });
        return found == made_.written.wires.end() ? nullptr : &*found;
    }

    /// The node that an error belongs to; null: none of this patch.
    const patch::PatchNode* node_at(const SourceLocation& where) const {
        const auto& nodes = made_.written.nodes;
        if (where.file != file_.string()) {
            // Of a sub-patch: the node that names the file.
            const auto part = std::ranges::find_if(nodes, [&](const patch::PatchNode& node) {
                return patch::is_sub_patch(node) &&
                       patch::file_of_part(made_.written, patch::part_path("", node.type)).string() == where.file;
            });
            return part == nodes.end() ? nullptr : &*part;
        }
        if (where.line == 0) return nullptr;
        const auto is_here = [&](const patch::PatchNode& node) {
            const auto is_at = [&](const SourceLocation& at) { return place(at) == place(where); };
            return is_at(node.where) || is_at(node.type_where) || is_at(node.rate_where) ||
                   std::ranges::any_of(node.settings, is_at, &OptionText::where);
        };
        auto found = std::ranges::find_if(nodes, is_here);
        if (found == nodes.end())
            found = std::ranges::find(nodes, table_node(text_, where.line), &patch::PatchNode::name);
        return found == nodes.end() ? nullptr : &*found;
    }

    /// Leaves out what the error concerns. False: it concerns no wire and no node, or these are out already.
    bool assign(const Error& error) {
        if (const patch::PatchWire* wire = wire_at(error.where()))
            return wires_.emplace(place(wire->where), error.message()).second;
        const patch::PatchNode* node = node_at(error.where());
        return node && nodes_.emplace(node->name, error.message()).second;
    }

    void add(const Error& error) {
        if (!known_.insert(error.what()).second) return;
        Fault fault;
        fault.text = error.what();
        fault.message = error.message();
        const SourceLocation& where = error.where();
        if (where.file == file_.string()) fault.line = where.line;
        else if (where.line > 0) fault.file = where.file;
        if (const patch::PatchWire* wire = wire_at(where)) fault.wire = *wire;
        else if (const patch::PatchNode* node = node_at(where)) {
            fault.node = node->name;
            const auto setting = std::ranges::find_if(
                node->settings, [&](const OptionText& given) { return place(given.where) == place(where); });
            if (setting != node->settings.end() && fault.file.empty()) fault.param = setting->name;
        } else if (fault.line > 0) fault.node = table_node(text_, fault.line);
        if (auto correction = correction_in(fault.message)) {
            fault.wrong = std::move(correction->wrong);
            fault.suggestion = std::move(correction->suggestion);
        }
        made_.faults.push_back(std::move(fault));
    }

    const std::string text_;
    const fs::path file_;
    const CompilePatch& compile_;
    RecoveredPatch made_;
    std::map<std::string, std::string> nodes_;  ///< at fault, and why
    std::map<Place, std::string> wires_;
    std::set<std::string> known_;
};

}  // namespace

std::optional<std::string> refusal_of(const std::vector<Fault>& before, const std::vector<Fault>& after) {
    const auto has = [](const std::vector<Fault>& all, const Fault& fault) {
        return std::ranges::find(all, fault.message, &Fault::message) != all.end();
    };
    const bool repairs = std::ranges::any_of(before, [&](const Fault& fault) { return !has(after, fault); });
    const auto added = std::ranges::find_if(after, [&](const Fault& fault) { return !has(before, fault); });
    if (repairs || added == after.end()) return std::nullopt;
    return added->text;
}

std::optional<Correction> correction_in(std::string_view message) {
    constexpr std::string_view mark = "; did you mean '";
    const std::size_t at = message.find(mark);
    if (at == std::string_view::npos) return std::nullopt;
    const std::size_t begin = at + mark.size(), end = message.find('\'', begin);
    const std::size_t first = message.find('\''), second = message.find('\'', first + 1);
    if (end == std::string_view::npos || second == std::string_view::npos || second > at) return std::nullopt;
    return Correction{std::string(message.substr(first + 1, second - first - 1)),
                      std::string(message.substr(begin, end - begin))};
}

RecoveredPatch recover_patch(std::string_view text, const fs::path& file, const CompilePatch& compile) {
    return ErrorRecovery(text, file, compile).run();
}

}  // namespace tactus::window
