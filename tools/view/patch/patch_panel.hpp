// SPDX-License-Identifier: Apache-2.0
// The panel with the picture of the patch, edited with the mouse.
#pragma once

#include "tools/view/canvas.hpp"
#include "tools/view/painter.hpp"
#include "tools/view/signal/feed.hpp"
#include "tools/view/workbench.hpp"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tactus::view {

class PatchPanel {
public:
    explicit PatchPanel(Workbench& bench) : bench_(bench) {}

    /// Draws into the current child window. Adds ports with visible values to `looked_at`.
    void draw(const Feed* feed, const Fonts& fonts, std::set<std::string>& looked_at);

    std::string selected;     ///< name of a node, empty: none
    std::string wants_scope;  ///< a port to show in a scope
    bool is_read_only = false;
    void fit() { fits_ = false; }
    /// Centres the view on a node.
    void look_at(const std::string& node);
    /// Position of "node", "node.output" or "node.input"; none: not visible.
    std::optional<Point> place_of(const std::string& name) const;

private:
    static constexpr double text_size = 13.0, small_size = 10.5;  ///< at a zoom of one
    static constexpr double readable = 5.5;  ///< pixels: smaller text is left out

    struct Wiring {
        int node = -1, port = -1;  ///< the output from which a wire is being dragged
        std::string checked, objection;
    };
    struct Health {
        std::int64_t missed = 0;
        double since = -1e9;  ///< time of the last missed deadline
    };

    void notice_new_plan();
    void notice_status();
    void draw_lanes(const Painter& paint);
    void draw_heads(const Painter& paint, const RunStatus& status);
    void draw_wires(const Painter& paint, const Box& visible);
    void draw_piece(const Painter& paint, const BezierCurve& piece, bool dashed, ImU32 ink, double width);
    void draw_deliveries(const Painter& paint, const Box& visible);
    void draw_stacks(const Painter& paint, const Box& visible);
    void draw_node(const Painter& paint, const PictureNode& node, const NodeStatus* status, const Feed* feed,
                   std::set<std::string>& looked_at);
    void draw_ports(const Painter& paint, const PictureNode& node, const Feed* feed, std::set<std::string>& looked_at);
    void draw_wiring(const Painter& paint);
    void handle_mouse();
    void finish_wire(const Hit& over);
    void explain(const Hit& over);
    void menus();
    std::string port_name(const Hit& hit) const;
    Point screen(Point world) const { return canvas_.to_pixel(world) + corner_; }
    Box screen(const Box& world) const;
    /// Zoomed out so far that stacked boxes merge and single wires are not visible.
    bool is_afar() const { return canvas_.zoom < 0.12; }
    bool is_late(const std::string& group) const;

    Workbench& bench_;
    Canvas canvas_;
    Point corner_;
    double width_ = 0.0, height_ = 0.0, unit_ = 1.0;
    bool fits_ = false, follows_size_ = true;
    std::int64_t plan_version_ = -1;
    Wiring wiring_;
    Hit hovered_, menu_;
    std::shared_ptr<const RunStatus> status_;
    std::vector<const NodeStatus*> times_;  ///< entries of `status_`, by node of the picture
    std::map<std::string, Health> health_;
    std::map<std::string, double> meters_;  ///< peak meters of signals
    std::string new_name_;
};

/// The most informative number of a value as text, such as "12.3 mm".
std::string short_value(const ValueType& type, const Feed::Latest& latest, const std::string& unit);

}  // namespace tactus::view
