// SPDX-License-Identifier: Apache-2.0
#include "graph/plugin/declaration.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "graph/compile/schedule.hpp"
#include "graph/compile/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::plugin {

namespace {

class Check final : public MemberVisitor {
public:
    void input(std::string_view name, Input& port) override {
        member(name);
        if (port.type) unit(name, port.unit);
    }
    void output(std::string_view name, Output& port) override {
        member(name);
        unit(name, port.unit);
    }
    void param(std::string_view name, Param& p) override {
        member(name);
        if (!(p.min < p.max))
            throw Error(fmt::format("parameter '{}': its least value, {}, is not below its largest, {}", name,
                                    format_quantity(p.min, p.unit), format_quantity(p.max, p.unit)));
        if (!(p.value >= p.min && p.value <= p.max))
            throw Error(fmt::format("parameter '{}': its default, {}, is outside of {} … {}", name,
                                    format_quantity(p.value, p.unit), format_quantity(p.min, p.unit),
                                    format_quantity(p.max, p.unit)));
    }
    void choice(std::string_view name, Choice& c) override {
        member(name);
        if (c.options.empty()) throw Error(fmt::format("choice '{}' has no options", name));
    }
    void text(std::string_view name, Text&) override { member(name); }
    void flag(std::string_view name, Flag&) override { member(name); }
    void vector(std::string_view name, Vector&) override { member(name); }
    void asset(std::string_view name, AssetParam&) override { member(name); }

private:
    void member(std::string_view name) {
        for (const std::string_view key : {"type", "rate", "group"})
            if (name == key)
                throw Error(
                    fmt::format("a member cannot be called '{}': in a patch that is a key of every node", name));
        if (std::ranges::find(names_, name) != names_.end())
            throw Error(fmt::format("the member '{}' is listed twice", name));
        names_.emplace_back(name);
    }
    static void unit(std::string_view name, const char* text) {
        try {
            static_cast<void>(compile::stated_unit(text));
        } catch (const Error& error) {
            throw Error(fmt::format("unit of '{}': {}", name, error.message()));
        }
    }

    std::vector<std::string> names_;
};

}  // namespace

void check_declaration(const NodeType& type) {
    if (type.name.empty() || type.about.empty()) throw Error("it has no name, or no text `about`");
    const compile::NodeInstance node(type.create(), type.destroy);
    Check check;
    type.visit(node.get(), check);
}

}  // namespace tactus::plugin
