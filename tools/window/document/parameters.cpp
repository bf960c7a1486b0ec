// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/parameters.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::window {

namespace {

using Kind = ParameterField::Kind;

class Lister : public MemberVisitor {
public:
    std::vector<ParameterField> fields;

    void param(std::string_view name, Param& p) override {
        ParameterField& field = add(Kind::quantity, name, p.about, format_quantity(p.value, p.unit));
        const double factor = p.unit.empty() ? 1.0 : parse_unit(p.unit).factor;
        field.unit = p.unit;
        field.value = p.value / factor;
        field.least = p.min / factor;
        field.most = p.max / factor;
        field.is_live = !p.is_structural;
    }
    void choice(std::string_view name, Choice& c) override {
        add(Kind::choice, name, c.about, c.options[static_cast<std::size_t>(c.index)]).options = c.options;
    }
    void text(std::string_view name, Text& t) override { add(Kind::text, name, t.about, t.value); }
    void flag(std::string_view name, Flag& f) override { add(Kind::flag, name, f.about, f.value ? "true" : "false"); }
    void vector(std::string_view name, Vector& v) override {
        add(Kind::vector, name, v.about,
            fmt::format("{}, {}, {}", format_quantity(v.value.x, v.unit), format_quantity(v.value.y, v.unit),
                        format_quantity(v.value.z, v.unit)))
            .unit = v.unit;
    }
    void asset(std::string_view name, AssetParam& a) override {
        add(Kind::asset, name, fmt::format("{}: {}", a.type_name, a.about), a.name).type = a.type_name;
    }

private:
    ParameterField& add(Kind kind, std::string_view name, std::string_view about, std::string text) {
        ParameterField& field = fields.emplace_back();
        field.kind = kind;
        field.name = name;
        field.about = about;
        field.text = std::move(text);
        return field;
    }
};

std::vector<ParameterField> fields_of(const NodeType& type, void* node) {
    Lister lister;
    type.visit(node, lister);
    return std::move(lister.fields);
}

}  // namespace

std::vector<ParameterField> parameters_of(const compile::Schedule& plan, int index) {
    const compile::ScheduleNode& node = plan.nodes[static_cast<std::size_t>(index)];
    std::vector<ParameterField> fields = fields_of(*node.type, node.instance.get());
    const compile::NodeInstance fresh(node.type->create(), node.type->destroy);
    const std::vector<ParameterField> standards = fields_of(*node.type, fresh.get());
    const auto patched = std::ranges::find(plan.patch.nodes, node.name, &patch::PatchNode::name);
    for (std::size_t i = 0; i < fields.size(); ++i) {
        ParameterField& field = fields[i];
        field.standard = standards[i].text;
        field.normal = standards[i].value;
        field.is_set = patched != plan.patch.nodes.end() &&
                       std::ranges::find(patched->settings, field.name, &OptionText::name) != patched->settings.end();
        if (field.kind == Kind::asset)
            for (const patch::PatchAsset& asset : plan.patch.assets) field.options.push_back(asset.name);
        if (field.kind != Kind::quantity) continue;
        const Param* param = node.params.at(field.name);
        field.is_driven = std::ranges::any_of(
            plan.wires, [&](const compile::ScheduleWire& w) { return w.to_input < 0 && w.param == param; });
    }
    return fields;
}

void take_setting(ParameterField& field, const patch::PatchNode& node) {
    const auto setting = std::ranges::find(node.settings, field.name, &OptionText::name);
    if (setting == node.settings.end()) return;
    field.is_set = true;
    field.text = setting->text;
    if (field.kind != Kind::quantity) return;
    try {
        field.value = parse_as(setting->text, field.unit) / (field.unit.empty() ? 1.0 : parse_unit(field.unit).factor);
    } catch (const Error&) {
        // The compiler will say so; the form shows the default.
    }
}

std::vector<ParameterField> parameters_of(const NodeType& type, const patch::Patch& patch,
                                          const patch::PatchNode& node) {
    const compile::NodeInstance fresh(type.create(), type.destroy);
    std::vector<ParameterField> fields = fields_of(type, fresh.get());
    for (ParameterField& field : fields) {
        field.standard = field.text;
        field.normal = field.value;
        if (field.kind == Kind::asset)
            for (const patch::PatchAsset& asset : patch.assets) field.options.push_back(asset.name);
        take_setting(field, node);
    }
    return fields;
}

std::optional<double> drag_speed(const ParameterField& field) {
    const double size = std::max({std::abs(field.value), std::abs(field.normal), 1.0});
    const bool is_wide = field.least < 0.0 && field.most - field.least > 1e3 * size;
    if (!is_wide && field.most < 1e9) return std::nullopt;
    return 0.005 * size;
}

std::string quantity_text(double value, std::string_view unit) {
    return unit.empty() ? fmt::format("{:.6g}", value) : fmt::format("{:.6g} {}", value, unit);
}

}  // namespace tactus::window
