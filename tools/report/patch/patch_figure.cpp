// SPDX-License-Identifier: Apache-2.0
#include "tools/report/patch/patch_figure.hpp"

#include "devices/display/figure_painter.hpp"
#include "dsp/core/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <vector>

namespace tactus::report {

namespace {

constexpr double box_width = 150, min_height = 46, column_gap = 90, row_gap = 26, lane_label = 190, lane_padding = 18,
                 margin = 16, title_height = 44;
constexpr double wire_pitch = 12;  // of the ends of wires at a box: the height of a label

constexpr std::size_t max_shown = 40;  ///< characters of a name

/// A box, and the wires that begin and end there, from the top.
struct Place {
    double x = 0, y = 0, height = min_height;
    int column = 0;
    std::vector<const compile::ScheduleWire*> out, in;
};

constexpr std::array<std::pair<std::string_view, display::Colour>, 7> colours{{{"pose", {0x25, 0x63, 0xEB}},
                                                                               {"wrench", {0xDC, 0x26, 0x26}},
                                                                               {"twist", {0x7C, 0x3A, 0xED}},
                                                                               {"vector", {0xDB, 0x27, 0x77}},
                                                                               {"number", {0x47, 0x55, 0x69}},
                                                                               {"bool", {0x0D, 0x94, 0x88}},
                                                                               {"signal", {0xD9, 0x77, 0x06}}}};
constexpr display::Colour snapshot_colour{0x15, 0x80, 0x3D}, ink{0x0F, 0x17, 0x2A}, soft{0x47, 0x55, 0x69},
    lane{0xF1, 0xF5, 0xF9}, paper{255, 255, 255}, rim{0x33, 0x41, 0x55}, faint{0x64, 0x74, 0x8B};

display::Colour colour_of(const ValueType& type) {
    for (const auto& [name, colour] : colours)
        if (type.name == name) return colour;
    return snapshot_colour;
}

std::string_view mode_name(patch::WireMode mode) {
    constexpr std::string_view names[] = {"hold", "linear", "batch", "delay"};
    return names[static_cast<std::size_t>(mode)];
}

class PatchDrawing {
public:
    explicit PatchDrawing(const compile::Schedule& plan) : plan_(plan), places_(plan.nodes.size()) {
        find_columns();
        find_wires();
        place();
    }

    display::Figure figure() const {
        display::Figure to(width_, height_);
        to.text({margin, 28.0}, plan_.patch.title, 18.0, ink, display::TextAnchor::start, true);
        draw_lanes(to);
        for (const compile::ScheduleWire& wire : plan_.wires) draw_wire(to, wire);
        draw_nodes(to);
        // Labels are above nodes and wires.
        for (const compile::ScheduleWire& wire : plan_.wires) draw_label(to, wire);
        draw_legend(to);
        return to;
    }

private:
    const compile::ScheduleNode& node(int index) const { return plan_.nodes[static_cast<std::size_t>(index)]; }
    Place& place_of(int index) { return places_[static_cast<std::size_t>(index)]; }
    const Place& place_of(int index) const { return places_[static_cast<std::size_t>(index)]; }

    /// Length of the longest path from a source, over forward wires. It orders the nodes of a group.
    void find_columns() {
        std::vector<std::vector<int>> after(plan_.nodes.size());
        for (const compile::ScheduleWire& wire : plan_.wires) {
            if (wire.from_node < 0 || wire.mode == patch::WireMode::delay) continue;
            if (node(wire.from_node).group != node(wire.to_node).group) continue;
            after[static_cast<std::size_t>(wire.from_node)].push_back(wire.to_node);
        }
        for (const compile::ScheduleGroup& group : plan_.groups)
            for (const int from : group.order)
                for (const int to : after[static_cast<std::size_t>(from)])
                    place_of(to).column = std::max(place_of(to).column, place_of(from).column + 1);
    }

    /// Boxes are high enough for the wires of each side, which are in the order of the ports; wires to parameters are the
    /// lowest.
    void find_wires() {
        for (const compile::ScheduleWire& wire : plan_.wires) {
            if (wire.from_node < 0) continue;
            place_of(wire.from_node).out.push_back(&wire);
            place_of(wire.to_node).in.push_back(&wire);
        }
        for (Place& p : places_) {
            std::ranges::stable_sort(p.out, {}, &compile::ScheduleWire::from_output);
            std::ranges::stable_sort(p.in, {}, [](const compile::ScheduleWire* wire) {
                return wire->to_input < 0 ? std::numeric_limits<int>::max() : wire->to_input;
            });
            p.height =
                std::max(min_height, wire_pitch * (static_cast<double>(std::max(p.out.size(), p.in.size())) + 1.0));
        }
    }

    void place() {
        double y = title_height;
        int columns = 1;
        for (const compile::ScheduleGroup& group : plan_.groups) {
            std::map<int, double> below;  // of the boxes in each column
            double deepest = y + lane_padding + min_height;
            for (const int index : group.order) {
                Place& p = place_of(index);
                double& next = below.try_emplace(p.column, y + lane_padding).first->second;
                p.x = margin + lane_label + p.column * (box_width + column_gap);
                p.y = next;
                next += p.height + row_gap;
                deepest = std::max(deepest, p.y + p.height);
                columns = std::max(columns, p.column + 1);
            }
            lanes_.push_back({y, deepest + lane_padding - y});
            y += lanes_.back().second + 34;
        }
        width_ = std::max(760.0, 2 * margin + lane_label + columns * (box_width + column_gap));
        height_ = y + 30;
    }

    void draw_lanes(display::Figure& to) const {
        for (std::size_t i = 0; i < lanes_.size(); ++i) {
            const compile::ScheduleGroup& group = plan_.groups[i];
            const std::string rate =
                format_quantity(rate_of(group.period), rate_of(group.period) >= 1000.0 ? "kHz" : "Hz");
            const double top = lanes_[i].first;
            to.rounded(margin, top, width_ - 2 * margin, lanes_[i].second, 8.0, lane);
            to.text({margin + 10, top + 24}, group.name, 12.0, ink, display::TextAnchor::start, true);
            to.text(
                {margin + 10, top + 40},
                fmt::format("{}latency {:.4g} ms", group.name == rate ? "" : rate + ", ", seconds(group.latency) * 1e3),
                10.0, soft);
        }
    }

    void draw_nodes(display::Figure& to) const {
        for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
            const Place& p = places_[i];
            const double middle = p.x + box_width / 2, centre = p.y + p.height / 2;
            const std::string name = shown(plan_.nodes[i].name);
            to.begin(plan_.nodes[i].name, "");
            to.rounded(p.x, p.y, box_width, p.height, 6.0, paper, rim, 1.0);
            to.text({middle, centre - 3}, name, name_size(name), ink, display::TextAnchor::middle, true);
            to.text({middle, centre + 13}, plan_.nodes[i].type->name, 10.0, faint, display::TextAnchor::middle);
            to.end();
        }
    }

    /// The size at which a name stays within its box.
    static double name_size(const std::string& name) {
        constexpr double size = 12.0;
        return std::min(size, size * (box_width - 12) / display::figure_painter().text_width(name, size, true));
    }

    static std::string shown(const std::string& name) {
        return name.size() <= max_shown ? name : name.substr(0, max_shown - 1) + "…";
    }

    /// Where a wire is among those of one side of a box, so that neither wires nor labels overlap.
    static double docked(const Place& p, const std::vector<const compile::ScheduleWire*>& side,
                         const compile::ScheduleWire& wire) {
        const auto at = static_cast<double>(std::ranges::find(side, &wire) - side.begin());
        return p.y + p.height * (at + 1.0) / (static_cast<double>(side.size()) + 1.0);
    }

    const ValueType& type_of(const compile::ScheduleWire& wire) const {
        return *node(wire.from_node).outputs[static_cast<std::size_t>(wire.from_output)].port->type;
    }
    bool crosses(const compile::ScheduleWire& wire) const {
        return node(wire.from_node).group != node(wire.to_node).group;
    }
    display::FigurePoint end_of(const compile::ScheduleWire& wire) const {
        const Place& b = place_of(wire.to_node);
        return {b.x, docked(b, b.in, wire)};
    }

    void draw_wire(display::Figure& to, const compile::ScheduleWire& wire) const {
        if (wire.from_node < 0) return;
        const Place& a = place_of(wire.from_node);
        const compile::ScheduleNode& from = node(wire.from_node);
        const std::string& output = from.outputs[static_cast<std::size_t>(wire.from_output)].name;
        const display::Colour colour = colour_of(type_of(wire));
        const display::FigurePoint begin{a.x + box_width, docked(a, a.out, wire)}, end = end_of(wire);
        const double reach = std::max(40.0, std::abs(end.x - begin.x) * 0.45);
        to.begin(fmt::format("wire-{}", &wire - plan_.wires.data()),
                 fmt::format("{}.{} to {}", from.name, output, node(wire.to_node).name));
        to.curve(begin, {begin.x + reach, begin.y}, {end.x - reach, end.y}, end, colour, 1.6,
                 crosses(wire) ? 5.0 : 0.0);
        to.disc(end, 3.0, colour);
        to.end();
    }

    /// Mode and delay of a wire, before the input, which no other wire reaches, so that it covers neither a node nor
    /// another label.
    void draw_label(display::Figure& to, const compile::ScheduleWire& wire) const {
        if (wire.from_node < 0 || (!crosses(wire) && wire.mode != patch::WireMode::delay)) return;
        const compile::ScheduleGroup& group = plan_.groups[static_cast<std::size_t>(node(wire.from_node).group)];
        const double ms =
            (crosses(wire) ? seconds(compile::wire_latency(group, wire)) : seconds(wire.delay * group.period)) * 1e3;
        const display::FigurePoint end = end_of(wire);
        to.text({end.x - 7, end.y - 3}, fmt::format("{} {:.4g} ms", mode_name(wire.mode), ms), 9.0,
                colour_of(type_of(wire)), display::TextAnchor::end, false, false, true);
    }

    void draw_legend(display::Figure& to) const {
        double x = margin + 10;
        const auto item = [&](std::string_view name, display::Colour colour) {
            to.line({{x, height_ - 20}, {x + 22, height_ - 20}}, colour, 3.0);
            to.text({x + 28, height_ - 16}, std::string(name), 10.0, rim);
            x += 95;
        };
        for (const auto& [name, colour] : colours) item(name, colour);
        item("snapshot", snapshot_colour);
        to.text({x, height_ - 16}, "dashed: between groups", 10.0, rim);
    }

    const compile::Schedule& plan_;
    std::vector<Place> places_;
    std::vector<std::pair<double, double>> lanes_;  // top and height
    double width_ = 0, height_ = 0;
};

}  // namespace

display::Figure draw_patch(const compile::Schedule& plan) { return PatchDrawing(plan).figure(); }

}  // namespace tactus::report
