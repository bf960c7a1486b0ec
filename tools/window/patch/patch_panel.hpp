// SPDX-License-Identifier: Apache-2.0
// The panel with the picture of the patch, edited with the mouse.
#pragma once

#include "tools/window/document/workbench.hpp"
#include "tools/window/frame/commands.hpp"
#include "tools/window/patch/node_palette.hpp"
#include "tools/window/signal/feed.hpp"
#include "tools/window/widgets/canvas.hpp"
#include "tools/window/widgets/painter.hpp"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tactus::window {

class PatchPanel {
public:
    explicit PatchPanel(Workbench& bench) : bench_(bench), palette_(bench) {}

    /// Draws into the current child window. Adds ports with visible values to `looked_at`.
    void draw(const Feed* feed, const Fonts& fonts, std::set<std::string>& looked_at);

    std::string selected;     ///< name of a node, empty: none
    std::set<std::string> chosen;  ///< nodes; with `selected` among them
    std::set<std::string> chosen_comments;
    bool has_chosen() const { return !chosen.empty() || !chosen_comments.empty(); }
    std::string wants_scope;  ///< a port to show in a scope
    bool is_read_only = false;
    void fit() { fits_ = false; }
    // What menus and keys do with the chosen nodes and comments.
    void copy() const;
    /// At the pointer when it is over the canvas, or at a point; else beside what was copied.
    void paste(std::optional<Point> at = std::nullopt);
    void duplicate();
    void cut();
    void remove_chosen();
    void choose_all();
    enum class Align { left, top, columns, rows };
    void align(Align how);
    void nudge(Point by);
    void add_comment(std::optional<Point> at = std::nullopt);
    /// Keeps the words of the comment that is being written.
    void end_typing() { keep_comment(""); }
    void make_sub_patch();
    void open_palette();
    /// What can be done with what the patch has: wires, comments, sub-patches, colours. `is_seen`: the panel is shown.
    void add_commands(std::vector<Command>& all, bool is_seen);
    bool has_minimap = true;
    void choose_only(const std::string& name);
    /// The node of the patch's text under the mouse, also while files are dragged; empty: none.
    std::string node_under_mouse() const;
    /// The place of the picture under the mouse; none: it is elsewhere.
    std::optional<Point> mouse_over() const;
    /// Centres the view on a node.
    void look_at(const std::string& node);
    /// Position of "node", "node.output" or "node.input"; none: not visible.
    std::optional<Point> place_of(const std::string& name) const;
    /// Positions of all visible nodes and ports, as spot_list() writes controls.
    std::string place_list() const;

private:
    static constexpr double text_size = 13.0, small_size = 10.5;  ///< at a zoom of one
    static constexpr double readable = 11.0;  ///< pixels at scale 1: text is never smaller

    struct Wiring {
        int node = -1, port = -1;  ///< the output, or input, from which a wire is being dragged
        bool is_backward = false;  ///< from an input to an output
        std::string taken_off;  ///< the end that a wire was taken off, "node.port"; empty: a new wire
        std::string checked, objection;
    };
    /// Nodes and comments, the corner of a comment, or a frame that the mouse drags; in units of the picture.
    struct Dragging {
        enum class What { nothing, chosen, corner, frame } what = What::nothing;
        Point from, to;
        std::string name;  ///< of the node that was pressed, or of the comment of a corner
        bool is_alone = false;  ///< a comment leaves where it is what lies in it
        bool is_moved() const { return what != What::nothing && (from.x != to.x || from.y != to.y); }
    };
    /// What moves when the chosen things move.
    struct Things {
        std::set<std::string> nodes, comments;
    };
    /// Nodes dropped in another lane, until a person says whether they run there.
    struct Arrival {
        std::map<std::string, patch::PatchPlace> places;  ///< if they stay
        std::vector<patch::PatchComment> comments;
        std::vector<std::string> nodes;  ///< that can run there
        std::string lane, old_lane;
        std::map<std::string, patch::PatchPlace> there;
    };
    /// A wire dropped on a node, until a person says where it leads.
    struct Landing {
        std::string end;  ///< that is held, "node.port"
        std::string node;  ///< that it was dropped on
        std::string taken_off;
        bool is_backward = false;
        const ValueType* type = nullptr;
    };
    /// Ticks of a group and the late ones among them, counted over a second.
    struct Health {
        double begin = -1e9;  ///< s, of the second
        std::int64_t ticks = 0, missed = 0;  ///< at its beginning
        double late_share = 0.0;  ///< in the last whole second
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
    void draw_comments(const Painter& paint);
    void draw_dragging(const Painter& paint);
    std::optional<Box> minimap() const;  ///< on the screen; none: it is not shown
    bool press_minimap();
    void draw_minimap(const Painter& paint);
    void edit_comment();
    void keep_comment(const std::string& colour);
    const patch::PatchComment* comment_named(const std::string& name) const;
    void name_sub_patch();
    void handle_mouse();
    void press(const Hit& over, Point world);
    void press_node(const std::string& name);
    void drag(Point world);
    void let_go(Point world);
    void press_wire(const PictureWire& wire, Point world);
    void press_comment(const PictureComment& comment, Point world);
    void finish_wire(const Hit& over);
    /// Makes a wire from what is held to this end, or leads the one that was taken off there.
    void land(const Landing& wire, const std::string& end);
    void landing_menu();
    void let_chosen_go(const Dragging& done, Point world);
    void arrival_menu();
    void take_dropped_type();
    Things moving(bool is_alone) const;
    patch::PatchComment moved_comment(const std::string& name, Point by) const;
    const PictureComment* comment_at(Point world) const;
    std::vector<std::string> chosen_nodes() const;  ///< of the patch's text, once each
    std::vector<std::string> whole_nodes() const;  ///< those that are chosen and stand in the patch's text
    void choose_these(const Workbench::Pasted& made);
    std::string copied_text() const;
    void move_chosen(Point by, bool is_alone);
    /// Size of text at this zoom; none: there is no room for readable letters.
    std::optional<double> letters(double size, double room) const;
    void explain(const Hit& over);
    void menus();
    void node_menu(const std::string& name, bool is_part);
    void canvas_menu();
    std::string port_name(const Hit& hit) const;
    /// The same as the text of the patch has it: of a node within a sub-patch, what that offers.
    std::string end_name(const Hit& hit) const;
    void add_wire_commands(std::vector<Command>& all);
    Point screen(Point world) const { return canvas_.to_pixel(world) + corner_; }
    Box screen(const Box& world) const;
    /// The view moves with the node under the pointer when an edit arranges the patch anew.
    void keep_under_pointer();
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
    NodePalette palette_;
    Dragging dragging_;
    std::string commented_;  ///< the comment to be written next
    std::string writing_, comment_text_;  ///< the one being written
    bool is_on_map_ = false;
    bool wants_part_name_ = false;
    mutable int pastes_ = 0;
    std::string under_;  ///< the node under the pointer in the last picture
    Point under_at_;  ///< its corner
    Point mouse_, menu_at_;  ///< in units of the picture
    bool is_pointed_ = false;  ///< the pointer is over the canvas
    std::optional<Arrival> arrival_;
    Landing landing_;
};

/// The most informative number of a value as text, such as "12.3 mm".
std::string short_value(const ValueType& type, const Feed::Latest& latest, const std::string& unit);

}  // namespace tactus::window
