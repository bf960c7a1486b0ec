// SPDX-License-Identifier: Apache-2.0
// The picture of the patch in the window: looked at, and edited by pointing.
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

    /// Into the current child window. Ports whose values are shown are put into `looked_at`.
    void draw(const Feed* feed, const Fonts& fonts, std::set<std::string>& looked_at);

    std::string selected;     ///< name of a node, empty: none
    std::string wants_scope;  ///< a port that was asked to be shown, for the scopes to take
    bool is_read_only = false;
    void fit() { fits_ = false; }
    /// Brings a node into the middle.
    void look_at(const std::string& node);
    /// Where "node", "node.output" or "node.input" is seen, none: not in sight.
    std::optional<Point> place_of(const std::string& name) const;

private:
    static constexpr double text_size = 13.0, small_size = 10.5;  ///< at a zoom of one
    static constexpr double readable = 5.5;  ///< pixels: smaller text is left out

    struct Wiring {
        int node = -1, port = -1;  ///< the output that a wire is being drawn from
        std::string checked, objection;
    };
    struct Health {
        std::int64_t missed = 0;
        double since = -1e9;  ///< when the last miss was noticed
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
    /// So far off that boxes above each other run together, and wires are but a fog.
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
    std::vector<const NodeStatus*> times_;  ///< of `status_`, by the picture's nodes
    std::map<std::string, Health> health_;
    std::map<std::string, double> meters_;  ///< of signals: the largest of late
    std::string new_name_;
};

/// "12.3 mm" for people: one number that says most about a value.
std::string short_value(const ValueType& type, const Feed::Latest& latest, const std::string& unit);

}  // namespace tactus::view
