// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/draw.hpp"

#include "dsp/core/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

namespace tactus::analyse {

namespace {

constexpr double box_width = 150, box_height = 46, column_gap = 90, row_gap = 26, lane_label = 190, lane_padding = 18,
                 margin = 16, title_height = 44;

constexpr std::size_t max_shown = 40;  ///< characters of a name

struct Place {
    double x = 0, y = 0;
    int column = 0, row = 0;
};

constexpr std::array<std::pair<std::string_view, std::string_view>, 7> colours{{{"pose", "#2563eb"},
                                                                                {"wrench", "#dc2626"},
                                                                                {"twist", "#7c3aed"},
                                                                                {"vector", "#db2777"},
                                                                                {"number", "#475569"},
                                                                                {"bool", "#0d9488"},
                                                                                {"signal", "#d97706"}}};
constexpr std::string_view snapshot_colour = "#15803d";

std::string_view colour_of(const ValueType& type) {
    for (const auto& [name, colour] : colours)
        if (type.name == name) return colour;
    return snapshot_colour;
}

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&': out += "&amp;"; break;
            case '<': out += "&lt;"; break;
            case '>': out += "&gt;"; break;
            case '"': out += "&quot;"; break;
            default: out += c;
        }
    }
    return out;
}

std::string_view mode_name(patch::WireMode mode) {
    constexpr std::string_view names[] = {"hold", "linear", "batch", "delay"};
    return names[static_cast<std::size_t>(mode)];
}

class Drawing {
public:
    explicit Drawing(const compile::Schedule& plan) : plan_(plan), places_(plan.nodes.size()) {
        find_columns();
        place();
    }

    std::string svg() {
        std::string wires;
        for (const compile::ScheduleWire& wire : plan_.wires) wires += draw_wire(wire);
        return fmt::format(
                   "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
                   "height=\"{1:.0f}\" "
                   "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
                   "fill=\"#ffffff\"/>\n"
                   "<text x=\"{2}\" y=\"28\" font-size=\"18\" font-weight=\"bold\" fill=\"#0f172a\">{3}</text>\n",
                   width_, height_, margin, escaped(plan_.patch.title)) +
               draw_lanes() + wires + draw_nodes() + labels_ + draw_legend() + "</svg>\n";
    }

private:
    const compile::ScheduleNode& node(int index) const { return plan_.nodes[static_cast<std::size_t>(index)]; }
    Place& place_of(int index) { return places_[static_cast<std::size_t>(index)]; }

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

    void place() {
        double y = title_height;
        int columns = 1;
        for (const compile::ScheduleGroup& group : plan_.groups) {
            std::map<int, int> rows;
            int deepest = 1;
            for (const int index : group.order) {
                Place& p = place_of(index);
                p.row = rows[p.column]++;
                p.x = margin + lane_label + p.column * (box_width + column_gap);
                p.y = y + lane_padding + p.row * (box_height + row_gap);
                deepest = std::max(deepest, p.row + 1);
                columns = std::max(columns, p.column + 1);
            }
            lanes_.push_back({y, 2 * lane_padding + deepest * (box_height + row_gap) - row_gap});
            y += lanes_.back().second + 34;
        }
        width_ = std::max(760.0, 2 * margin + lane_label + columns * (box_width + column_gap));
        height_ = y + 30;
    }

    std::string draw_lanes() const {
        std::string text;
        for (std::size_t i = 0; i < lanes_.size(); ++i) {
            const compile::ScheduleGroup& group = plan_.groups[i];
            const std::string rate =
                format_quantity(rate_of(group.period), rate_of(group.period) >= 1000.0 ? "kHz" : "Hz");
            text += fmt::format(
                "<rect x=\"{}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"8\" fill=\"#f1f5f9\"/>\n"
                "<text x=\"{}\" y=\"{:.1f}\" font-weight=\"bold\" fill=\"#0f172a\">{}</text>\n"
                "<text x=\"{}\" y=\"{:.1f}\" font-size=\"10\" fill=\"#475569\">{}latency {:.4g} ms</text>\n",
                margin, lanes_[i].first, width_ - 2 * margin, lanes_[i].second, margin + 10, lanes_[i].first + 24,
                escaped(group.name), margin + 10, lanes_[i].first + 40, group.name == rate ? "" : escaped(rate) + ", ",
                seconds(group.latency) * 1e3);
        }
        return text;
    }

    std::string draw_nodes() {
        std::string text;
        for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
            const Place& p = places_[i];
            text += fmt::format(
                "<rect x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2}\" height=\"{3}\" rx=\"6\" fill=\"#ffffff\" "
                "stroke=\"#334155\"/>\n<text x=\"{4:.1f}\" y=\"{5:.1f}\" text-anchor=\"middle\" font-weight=\"bold\" "
                "font-size=\"{9:.1f}\" "
                "fill=\"#0f172a\">{6}</text>\n<text x=\"{4:.1f}\" y=\"{7:.1f}\" text-anchor=\"middle\" "
                "font-size=\"10\" "
                "fill=\"#64748b\">{8}</text>\n",
                p.x, p.y, box_width, box_height, p.x + box_width / 2, p.y + 20, escaped(shown(plan_.nodes[i].name)),
                p.y + 36, escaped(plan_.nodes[i].type->name), name_size(plan_.nodes[i].name));
        }
        return text;
    }

    /// The size at which a name stays within its box, or that of 40 characters.
    static double name_size(std::string_view name) {
        constexpr double character = 0.66;  // width of a bold one, of its height
        const auto characters = static_cast<double>(std::clamp<std::size_t>(name.size(), 1, max_shown));
        return std::min(12.0, (box_width - 12) / (character * characters));
    }

    static std::string shown(const std::string& name) {
        return name.size() <= max_shown ? name : name.substr(0, max_shown - 1) + "…";
    }

    /// The place of a wire among a node's ports, so that wires do not overlap.
    static double docked(double y, std::size_t port, std::size_t ports) {
        return y + box_height * (static_cast<double>(port) + 1.0) / (static_cast<double>(ports) + 1.0);
    }

    std::string draw_wire(const compile::ScheduleWire& wire) {
        if (wire.from_node < 0) return {};
        const Place &a = place_of(wire.from_node), &b = place_of(wire.to_node);
        const compile::ScheduleNode &from = node(wire.from_node), &to = node(wire.to_node);
        const ValueType& type = *from.outputs[static_cast<std::size_t>(wire.from_output)].port->type;
        const double x1 = a.x + box_width,
                     y1 = docked(a.y, static_cast<std::size_t>(wire.from_output), from.outputs.size());
        const double x2 = b.x;
        const double y2 = wire.to_input < 0 ? b.y + box_height - 4
                                            : docked(b.y, static_cast<std::size_t>(wire.to_input), to.inputs.size());
        const double reach = std::max(40.0, std::abs(x2 - x1) * 0.45);
        const bool crosses = from.group != to.group;
        if (crosses || wire.mode == patch::WireMode::delay) {
            const double ms =
                crosses ? seconds(compile::wire_latency(plan_.groups[static_cast<std::size_t>(from.group)], wire)) * 1e3
                        : seconds(wire.delay * plan_.groups[static_cast<std::size_t>(from.group)].period) * 1e3;
            // Labels stand before the input, which no other wire reaches, so none covers a node or another label.
            labels_ += fmt::format(
                "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"9\" text-anchor=\"end\" fill=\"{}\" stroke=\"#ffffff\" "
                "stroke-width=\"3\" paint-order=\"stroke\">{} {:.4g} ms</text>\n",
                x2 - 7, y2 - 3, colour_of(type), mode_name(wire.mode), ms);
        }
        return fmt::format(
            "<path d=\"M{:.1f} {:.1f} C{:.1f} {:.1f} {:.1f} {:.1f} {:.1f} {:.1f}\" fill=\"none\" stroke=\"{}\" "
            "stroke-width=\"1.6\"{}><title>{}.{} to {}</title></path>\n<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" "
            "fill=\"{}\"/>\n",
            x1, y1, x1 + reach, y1, x2 - reach, y2, x2, y2, colour_of(type), crosses ? " stroke-dasharray=\"6 4\"" : "",
            escaped(from.name), escaped(from.outputs[static_cast<std::size_t>(wire.from_output)].name),
            escaped(to.name), x2, y2, colour_of(type));
    }

    std::string draw_legend() const {
        std::string text;
        double x = margin + 10;
        const auto item = [&](std::string_view name, std::string_view colour) {
            text += fmt::format(
                "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" y2=\"{1:.1f}\" stroke=\"{3}\" "
                "stroke-width=\"3\"/>\n"
                "<text x=\"{4:.1f}\" y=\"{5:.1f}\" font-size=\"10\" fill=\"#334155\">{6}</text>\n",
                x, height_ - 20, x + 22, colour, x + 28, height_ - 16, name);
            x += 95;
        };
        for (const auto& [name, colour] : colours) item(name, colour);
        item("snapshot", snapshot_colour);
        return text +
               fmt::format(
                   "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"10\" fill=\"#334155\">dashed: between groups</text>\n",
                   x, height_ - 16);
    }

    const compile::Schedule& plan_;
    std::vector<Place> places_;
    std::vector<std::pair<double, double>> lanes_;  // top and height
    double width_ = 0, height_ = 0;
    std::string labels_;
};

}  // namespace

std::string draw_svg(const compile::Schedule& plan) { return Drawing(plan).svg(); }

}  // namespace tactus::analyse
