// SPDX-License-Identifier: Apache-2.0
// Indexes for flattening sub-patches in linear time of the number of nodes. For sub_patch.cpp only.
#pragma once

#include "graph/patch/sub_patch.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tactus::patch {

/// A flattened sub-patch with indexes of its nodes and ends by name.
struct FlatPart {
    using Ends = std::vector<const PatchEnd*>;
    using Index = std::unordered_map<std::string_view, Ends>;

    explicit FlatPart(Patch flat) : patch(std::move(flat)) {
        index(patch.offered, offered);
        index(patch.inputs, targets);
        index(patch.parameters, targets);
        index(patch.outputs, outputs);
        index(patch.parameters, parameters);
        for (std::size_t i = 0; i < patch.nodes.size(); ++i) nodes.emplace(patch.nodes[i].name, i);
    }
    FlatPart(const FlatPart&) = delete;
    FlatPart& operator=(const FlatPart&) = delete;

    static void index(const std::vector<PatchEnd>& ends, Index& by_name) {
        for (const PatchEnd& end : ends) by_name[end.name].push_back(&end);
    }
    static const Ends& find(const Index& by_name, const std::string& name) {
        static const Ends none;
        const auto found = by_name.find(name);
        return found == by_name.end() ? none : found->second;
    }
    std::string file() const { return patch.file.filename().string(); }

    Patch patch;
    Index offered, outputs, parameters;
    Index targets;  ///< ends of wires: inputs, then parameters
    std::unordered_map<std::string_view, std::size_t> nodes;
};

/// The wires of a patch while its sub-patches are replaced: for each original wire, its current replacements.
class OuterWires {
public:
    OuterWires(std::vector<PatchWire> wires, const std::vector<PatchNode>& nodes) : pieces_(wires.size()) {
        for (const PatchNode& node : nodes)
            if (patch::is_sub_patch(node)) touching_.try_emplace(node.name);
        for (std::size_t w = 0; w < wires.size(); ++w) {
            note(wires[w].from_node, w);
            if (wires[w].to_node != wires[w].from_node) note(wires[w].to_node, w);
            pieces_[w].push_back(std::move(wires[w]));
        }
    }

    /// Calls `replace` with the current replacements of each wire at `node`, in the order of the file.
    template <class Replace>
    void at(const std::string& node, Replace&& replace) {
        for (const std::size_t w : touching_.at(node)) replace(pieces_[w]);
    }

    /// Returns all wires in the order of the file. Moves them out.
    std::vector<PatchWire> joined() {
        std::vector<PatchWire> wires;
        for (auto& pieces : pieces_) std::ranges::move(pieces, std::back_inserter(wires));
        return wires;
    }

private:
    void note(const std::string& node, std::size_t wire) {
        if (const auto found = touching_.find(node); found != touching_.end()) found->second.push_back(wire);
    }

    std::vector<std::vector<PatchWire>> pieces_;
    std::unordered_map<std::string, std::vector<std::size_t>> touching_;  // of each node that is a sub-patch
};

}  // namespace tactus::patch
