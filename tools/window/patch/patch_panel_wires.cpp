// SPDX-License-Identifier: Apache-2.0
// Drawing of the wires.
#include "tools/window/patch/patch_panel.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::window {

namespace {

/// Upper bound of a curve's length in pixels: the length of its control polygon.
double length_of(const BezierCurve& c) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::hypot(c[i + 1].x - c[i].x, c[i + 1].y - c[i].y);
    return sum;
}

}  // namespace

void PatchPanel::draw_wires(const Painter& paint, const Box& visible) {
    const PatchPicture& picture = bench_.picture();
    const double z = canvas_.zoom;
    const int chosen_node = picture.find(selected);
    for (std::size_t w = 0; w < picture.wires.size(); ++w) {
        const PictureWire& wire = picture.wires[w];
        const bool is_near = wire.from == chosen_node || wire.to == chosen_node;
        if (!wire.bounds.meets(visible) || (is_afar() && !is_near)) continue;
        const PictureNode& from = picture.nodes[static_cast<std::size_t>(wire.from)];
        ImU32 ink = colour_of(from.outputs[static_cast<std::size_t>(wire.output)].type);
        const bool is_hovered = hovered_ == Hit{Hit::What::wire, static_cast<int>(w), -1};
        if (!wire.fault.empty()) ink = tone::bad;
        else if (!is_hovered && !is_near) ink = faded(ink, 0.62);
        // Whole pixels: fractional widths need three times as many triangles.
        const double width = std::max(1.0, std::round((is_hovered ? 3.2 : is_near ? 2.4 : 1.7) * std::max(z, 0.35)));
        for (const BezierCurve& piece : wire.way)
            if (bounds_of(piece).meets(visible)) draw_piece(paint, piece, wire.crosses && z >= 0.4, ink, width);
    }
}

/// Wires between groups are dashed.
void PatchPanel::draw_piece(const Painter& paint, const BezierCurve& piece, bool dashed, ImU32 ink, double width) {
    BezierCurve c;
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = screen(piece[i]);
    if (!dashed) {
        paint.list()->AddBezierCubic(vec(c[0]), vec(c[1]), vec(c[2]), vec(c[3]), ink, static_cast<float>(width));
        return;
    }
    const int dashes = std::clamp(static_cast<int>(length_of(c) / (13.0 * canvas_.zoom)), 2, 160);
    for (int d = 0; d < dashes; ++d)
        paint.line(on_curve(c, (d + 0.0) / dashes), on_curve(c, (d + 0.62) / dashes), ink, width);
}

/// Labels of the selected node's wires: type and delay.
void PatchPanel::draw_deliveries(const Painter& paint, const Box& visible) {
    const PatchPicture& picture = bench_.picture();
    const double z = canvas_.zoom;
    const int chosen_node = picture.find(selected);
    const std::optional<double> written = letters(small_size, port_height);
    if (chosen_node < 0 || !written) return;
    const double size = *written;
    std::vector<Box> taken;
    for (const PictureWire& wire : picture.wires) {
        if ((wire.from != chosen_node && wire.to != chosen_node) || !wire.bounds.meets(visible)) continue;
        const PictureNode& from = picture.nodes[static_cast<std::size_t>(wire.from)];
        const ValueType* type = from.outputs[static_cast<std::size_t>(wire.output)].type;
        // Wires within a tick have no delay, and the colour shows the type.
        if (!wire.crosses && wire.latency == 0) continue;
        const std::string text = fmt::format("{}, {}", type ? type->name : "any", describe(wire));
        const double wide = paint.width_of(text, size);
        const Point middle = screen(middle_of(wire));
        Box box{middle.x - 0.5 * wide - 4.0 * z, middle.y - 8.0 * z, middle.x + 0.5 * wide + 4.0 * z,
                middle.y + 8.0 * z};
        while (std::ranges::any_of(taken, [&](const Box& other) { return other.meets(box); })) {
            box.top += 17.0 * z;
            box.bottom += 17.0 * z;
        }
        taken.push_back(box);
        paint.box(box, colour(0x0c1015, 230), 4.0 * z);
        paint.text({box.left + 4.0 * z, box.top + 1.5 * z}, size, colour_of(type), text);
    }
}

void PatchPanel::draw_wiring(const Painter& paint) {
    if (wiring_.node < 0) return;
    const PictureNode& node = bench_.picture().nodes[static_cast<std::size_t>(wiring_.node)];
    const PicturePort& port =
        (wiring_.is_backward ? node.inputs : node.outputs)[static_cast<std::size_t>(wiring_.port)];
    const Point mouse = point(ImGui::GetIO().MousePos), from = screen(port.at);
    const auto curve = wiring_.is_backward ? curve_between(mouse, from) : curve_between(from, mouse);
    const bool refused =
        hovered_.what == (wiring_.is_backward ? Hit::What::output : Hit::What::input) && !wiring_.objection.empty();
    paint.list()->AddBezierCubic(vec(curve[0]), vec(curve[1]), vec(curve[2]), vec(curve[3]),
                                 refused ? tone::bad : colour_of(port.type), 2.5f);
}

}  // namespace tactus::window
