// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"
#include "dsp/core/units.hpp"
#include "graph/plugin/plugins.hpp"
#include "nodes/catalogue.hpp"
#include "tools/command/machine/node_project.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace tactus::command {

using file::Json;

namespace {

/// "any", or "number, vector or wrench".
std::string several(const Input& port) { return port.takes == kinds::every ? "any" : type_names(port.takes); }

class Describer : public MemberVisitor {
public:
    Json ports_in = Json::array(), ports_out = Json::array(), parameters = Json::array();

    void input(std::string_view name, Input& port) override {
        std::string type = port.type ? std::string(port.type->name) : several(port);
        if (port.kind == InputKind::batch) type = "batch of " + type;
        ports_in.push_back({{"name", name},
                            {"type", type},
                            {"optional", port.is_optional},
                            {"unit", port.unit},
                            {"about", port.about}});
    }
    void output(std::string_view name, Output& port) override {
        ports_out.push_back({{"name", name}, {"type", port.type->name}, {"unit", port.unit}, {"about", port.about}});
    }
    void param(std::string_view name, Param& p) override {
        parameters.push_back({{"name", name},
                              {"kind", "quantity"},
                              {"default", format_quantity(p.value, p.unit)},
                              {"min", format_quantity(p.min, p.unit)},
                              {"max", format_quantity(p.max, p.unit)},
                              {"live", !p.is_structural},
                              {"about", p.about}});
    }
    void choice(std::string_view name, Choice& c) override {
        parameters.push_back({{"name", name},
                              {"kind", "choice"},
                              {"default", c.options.front()},
                              {"options", c.options},
                              {"about", c.about}});
    }
    void text(std::string_view name, Text& t) override {
        parameters.push_back({{"name", name}, {"kind", "text"}, {"default", t.value}, {"about", t.about}});
    }
    void flag(std::string_view name, Flag& f) override {
        parameters.push_back({{"name", name}, {"kind", "flag"}, {"default", f.value}, {"about", f.about}});
    }
    void vector(std::string_view name, Vector& v) override {
        parameters.push_back(
            {{"name", name},
             {"kind", "vector"},
             {"default", fmt::format("[{}, {}, {}]", format_quantity(v.value.x, v.unit),
                                     format_quantity(v.value.y, v.unit), format_quantity(v.value.z, v.unit))},
             {"unit", v.unit},
             {"about", v.about}});
    }
    void asset(std::string_view name, AssetParam& a) override {
        parameters.push_back({{"name", name},
                              {"kind", "asset"},
                              {"asset", a.type_name},
                              {"optional", a.is_optional},
                              {"about", a.about}});
    }
};

std::string text_of(const Json& json, const char* key) {
    return json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : "";
}

Json describe(const NodeType& type) {
    const compile::NodeInstance node(type.create(), type.destroy);
    Describer describer;
    type.visit(node.get(), describer);
    Json json{{"type", type.name},
              {"about", type.about},
              {"inputs", describer.ports_in},
              {"outputs", describer.ports_out},
              {"parameters", describer.parameters}};
    if (const plugin::Plugin* of = plugin::plugin_of(type))
        json["plugin"] = Json{{"name", of->name},
                              {"version", of->version},
                              {"path", of->file.string()},
                              {"hash", fmt::format("{:016x}", of->hash)}};
    return json;
}

/// "my-lab 1.2, /home/me/my-lab.so"; "" for one of Tactus.
std::string origin_of(const Json& node) {
    if (!node.contains("plugin")) return "";
    const Json& of = node["plugin"];
    return fmt::format("{} {}, {}", text_of(of, "name"), text_of(of, "version"), text_of(of, "path"));
}

/// What a parameter may be, and what it is when the patch does not say.
std::string values_of(const Json& parameter) {
    const std::string kind = text_of(parameter, "kind"), standard = text_of(parameter, "default");
    if (kind == "quantity")
        return fmt::format("{} [{} … {}]{}", standard, text_of(parameter, "min"), text_of(parameter, "max"),
                           parameter["live"].get<bool>() ? "" : " structural");
    if (kind == "flag") return parameter["default"].get<bool>() ? "true [true, false]" : "false [true, false]";
    if (kind == "choice")
        return fmt::format("{} [{}]", standard, fmt::join(parameter["options"].get<std::vector<std::string>>(), ", "));
    if (kind == "text") return fmt::format("text \"{}\"", standard);
    if (kind == "asset")
        return fmt::format("{} of [assets]{}", text_of(parameter, "asset"),
                           parameter["optional"].get<bool>() ? ", optional" : "");
    return standard;
}

void print_whole(const Json& node) {
    fmt::print("{}\n  {}\n", text_of(node, "type"), text_of(node, "about"));
    if (const std::string origin = origin_of(node); !origin.empty()) fmt::print("  from {}\n", origin);
    for (const auto& [title, key] : {std::pair{"in", "inputs"}, {"out", "outputs"}})
        for (const Json& port : node[key])
            fmt::print("  {:>3}  {:<18} {:<16} {}{}{}\n", title, text_of(port, "name"), text_of(port, "type"),
                       text_of(port, "about"), text_of(port, "unit").empty() ? "" : ", " + text_of(port, "unit"),
                       port.value("optional", false) ? " (optional)" : "");
    for (const Json& p : node["parameters"])
        fmt::print("  set  {:<18} {}  {}\n", text_of(p, "name"), values_of(p), text_of(p, "about"));
}

int nodes(const std::string& wanted, bool json) {
    Json list = Json::array();
    std::vector<std::string> names;
    for (const NodeType* type : nodes::catalogue()) {
        names.push_back(type->name);
        if (wanted.empty() || type->name == wanted) list.push_back(describe(*type));
    }
    if (list.empty()) throw Error(fmt::format("no node type '{}'{}", wanted, did_you_mean(wanted, names)));
    if (json) fmt::print("{}\n", Json{{"version", 1}, {"rows", list}}.dump(2));
    else if (!wanted.empty()) print_whole(list[0]);
    else
        for (const Json& node : list) {
            const std::string origin = origin_of(node);
            fmt::print("{:<16} {}{}\n", text_of(node, "type"), text_of(node, "about"),
                       origin.empty() ? "" : fmt::format(" [{}]", origin));
        }
    return done;
}

int make_project(const std::string& name) {
    const std::string folder = write_node_project(name).string();
    fmt::print(
        "made {0}: {0}.cpp is the node, test.cpp its test\n"
        "  cmake -S {0} -B {0}/build && cmake --build {0}/build && ctest --test-dir {0}/build\n"
        "  tactus nodes {0} --nodes {0}/build/{0}.so\n",
        folder);
    return done;
}

Action declare_nodes(VerbOptions& verb) {
    struct Choice {
        std::string type, made;
        bool is_new = false, json = false;
    };
    const auto choice = std::make_shared<Choice>();
    verb.add("type", choice->type, "only this type");
    verb.flag("--json", choice->json, "as JSON");
    verb.call<std::string>(
            "--new",
            [choice](const std::string& name) {
                choice->made = name;
                choice->is_new = true;
            },
            "make a folder of this name with the project of a new node: source, test, CMakeLists.txt")
        .value_name("NAME")
        .excludes(verb.find("type"));
    return [choice] { return choice->is_new ? make_project(choice->made) : nodes(choice->type, choice->json); };
}

}  // namespace

Verb nodes_verb() { return {"nodes", "list the node types with ports, parameters, units and ranges", declare_nodes}; }

}  // namespace tactus::command
