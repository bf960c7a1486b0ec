// SPDX-License-Identifier: Apache-2.0
#include "tools/window/patch/patch_panel.hpp"

#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace tactus::window {

namespace {

constexpr double rounding = 6.0;
/// Above it a group is outlined: single late ticks are only counted.
constexpr double max_late_share = 0.01;
constexpr ImU32 lane_ground = colour(0x171d26);
constexpr double smallest_box = 9.0;  ///< pixels: smaller boxes are drawn without details

}  // namespace

Box PatchPanel::screen(const Box& world) const {
    const Point a = screen(Point{world.left, world.top}), b = screen(Point{world.right, world.bottom});
    return {a.x, a.y, b.x, b.y};
}

std::optional<double> PatchPanel::letters(double size, double room) const {
    const double least = readable * unit_;
    if (room * canvas_.zoom < least) return std::nullopt;
    return std::max(size * canvas_.zoom, least);
}

bool PatchPanel::is_late(const std::string& group) const {
    const auto found = health_.find(group);
    return found != health_.end() && found->second.late_share > max_late_share;
}

std::string PatchPanel::port_name(const Hit& at) const {
    const PictureNode& node = bench_.picture().nodes[static_cast<std::size_t>(at.index)];
    const auto& ports = at.what == Hit::What::output ? node.outputs : node.inputs;
    return node.name + "." + ports[static_cast<std::size_t>(at.port)].name;
}

void PatchPanel::look_at(const std::string& name) {
    const int index = bench_.picture().find(name);
    if (index < 0) return;
    const Point middle = bench_.picture().nodes[static_cast<std::size_t>(index)].box.middle();
    follows_size_ = false;
    canvas_.zoom = std::max(canvas_.zoom, 0.9 * unit_);
    canvas_.origin = middle - Point{width_, height_} * (0.5 / canvas_.zoom);
    fits_ = true;
}

std::optional<Point> PatchPanel::place_of(const std::string& name) const {
    const std::size_t dot = name.find('.');
    const int index = bench_.picture().find(name.substr(0, dot));
    if (index < 0) return std::nullopt;
    const PictureNode& node = bench_.picture().nodes[static_cast<std::size_t>(index)];
    std::optional<Point> at;
    if (dot == std::string::npos) at = Point{node.box.middle().x, node.box.top + 0.3 * title_height};
    for (const auto* ports : {&node.inputs, &node.outputs})
        for (const PicturePort& port : *ports)
            if (dot != std::string::npos && port.name == name.substr(dot + 1)) at = port.at;
    if (!at) return std::nullopt;
    const Point seen = canvas_.to_pixel(*at);
    if (!Box{0.0, 0.0, width_, height_}.contains(seen)) return std::nullopt;
    return seen + corner_;
}

std::string PatchPanel::place_list() const {
    std::string text;
    const auto add = [&](const std::string& name) {
        if (const auto at = place_of(name))
            text += fmt::format("{}\t{:.0f}\t{:.0f}\t{:.0f}\t{:.0f}\n", name, at->x, at->y, at->x, at->y);
    };
    for (const PictureNode& node : bench_.picture().nodes) {
        add(node.name);
        for (const auto* ports : {&node.inputs, &node.outputs})
            for (const PicturePort& port : *ports) add(node.name + "." + port.name);
    }
    return text;
}

void PatchPanel::notice_new_plan() {
    if (plan_version_ == bench_.plan_version()) return;
    // Indices refer to the previous picture.
    wiring_ = {};
    hovered_ = menu_ = {};
    // A fitted view stays fitted; what somebody points at stays where it is if all can still be seen.
    if (!under_.empty()) keep_under_pointer();
    else if (follows_size_) fits_ = false;
    plan_version_ = bench_.plan_version();
    times_.clear();
    dragging_ = {};
    arrival_.reset();
    landing_ = {};
    std::erase_if(chosen_comments, [&](const std::string& name) { return !comment_named(name); });
    if (!selected.empty() && bench_.picture().find(selected) < 0) selected.clear();
    std::erase_if(chosen, [&](const std::string& name) { return bench_.picture().find(name) < 0; });
}

void PatchPanel::keep_under_pointer() {
    const int index = bench_.picture().find(std::exchange(under_, {}));
    if (index < 0) return;
    const Box& box = bench_.picture().nodes[static_cast<std::size_t>(index)].box;
    if (box.left == under_at_.x && box.top == under_at_.y) return;
    canvas_.origin = canvas_.origin + Point{box.left, box.top} - under_at_;
    // Where a part of a patch that was seen as a whole would leave the view, the whole is shown again.
    const Box all = screen(bench_.picture().bounds);
    const bool is_whole = all.left >= corner_.x && all.top >= corner_.y && all.right <= corner_.x + width_ &&
                          all.bottom <= corner_.y + height_;
    if (follows_size_ && !is_whole) fits_ = false;
    else follows_size_ = false;
}

/// The status changes several times a second, and a patch can have ten thousand nodes.
void PatchPanel::notice_status() {
    auto status = bench_.status();
    const auto& nodes = bench_.picture().nodes;
    if (status == status_ && times_.size() == nodes.size()) return;
    status_ = std::move(status);
    for (const GroupStatus& group : status_->groups) {
        Health& health = health_[group.name];
        const double now = ImGui::GetTime();
        if (group.ticks < health.ticks) health = {};
        if (now - health.begin < 1.0) continue;
        const auto ticks = static_cast<double>(group.ticks - health.ticks);
        const auto missed = static_cast<double>(group.missed - health.missed);
        health = {now, group.ticks, group.missed, health.begin < 0.0 || ticks <= 0.0 ? 0.0 : missed / ticks};
    }
    std::unordered_map<std::string_view, const NodeStatus*> by_name;
    for (const NodeStatus& node : status_->nodes) by_name[node.name] = &node;
    times_.assign(nodes.size(), nullptr);
    for (std::size_t n = 0; n < nodes.size(); ++n)
        if (const auto found = by_name.find(nodes[n].name); found != by_name.end()) times_[n] = found->second;
}

void PatchPanel::draw(const Feed* feed, const Fonts& fonts, std::set<std::string>& looked_at) {
    const PatchPicture& picture = bench_.picture();
    unit_ = fonts.scale;
    corner_ = point(ImGui::GetCursorScreenPos());
    const Point size = point(ImGui::GetContentRegionAvail());
    // A fitted view is fitted again when the panel is resized.
    if (follows_size_ && (width_ != size.x || height_ != size.y)) fits_ = false;
    width_ = size.x;
    height_ = size.y;
    if (width_ < 8.0 || height_ < 8.0) return;
    notice_new_plan();
    // Somebody else has selected a node.
    if (!selected.empty() && !chosen.contains(selected)) chosen = {selected};
    if (selected.empty() && chosen.size() == 1) chosen.clear();
    if (!fits_ && picture.nodes.empty() && picture.comments.empty()) {
        canvas_ = {{-40.0, -60.0}, unit_};
        fits_ = true;
        follows_size_ = false;
    }
    if (!fits_) {
        canvas_.fit(picture.bounds, width_, height_, unit_);
        fits_ = follows_size_ = true;
    }
    ImGui::InvisibleButton(
        "canvas", vec(size),
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
    handle_mouse();
    take_dropped_type();
    notice_new_plan();
    under_ = is_pointed_ ? node_under_mouse() : std::string();
    if (const int index = picture.find(under_); index >= 0) {
        const Box& box = picture.nodes[static_cast<std::size_t>(index)].box;
        under_at_ = {box.left, box.top};
    }

    notice_status();
    const Painter paint(ImGui::GetWindowDrawList(), fonts);
    const ImVec2 low = vec(corner_), high = vec(corner_ + size);
    paint.list()->PushClipRect(low, high, true);
    const Box visible = canvas_.visible(width_, height_);
    draw_lanes(paint);
    draw_comments(paint);
    draw_wires(paint, visible);
    draw_heads(paint, *status_);
    if (is_afar()) draw_stacks(paint, visible);
    else
        for (std::size_t n = 0; n < picture.nodes.size(); ++n)
            if (picture.nodes[n].box.meets(visible)) draw_node(paint, picture.nodes[n], times_[n], feed, looked_at);
    draw_deliveries(paint, visible);
    draw_wiring(paint);
    draw_dragging(paint);
    draw_minimap(paint);
    if (picture.nodes.empty() && !bench_.is_broken() && !is_read_only)
        paint.text(corner_ + Point{24, 24}, text_size * unit_, tone::dim, "Double-click, or press Tab, to add a node");
    paint.list()->PopClipRect();
    if (ImGui::IsItemHovered() && dragging_.what == Dragging::What::nothing) explain(hovered_);
    menus();
    edit_comment();
    name_sub_patch();
    if (const std::string made = palette_.draw(fonts); !made.empty()) choose_only(made);
}

void PatchPanel::draw_lanes(const Painter& paint) {
    const PatchPicture& picture = bench_.picture();
    const double z = canvas_.zoom;
    for (const PictureLane& lane : picture.lanes) {
        const Box box = screen(Box{picture.bounds.left, lane.top, picture.bounds.right, lane.bottom});
        const bool late = is_late(lane.name);
        paint.box(box, lane_ground, 8.0 * z);
        paint.frame(box, late ? tone::bad : tone::lane_edge, 8.0 * z, late ? 2.0 : 1.0);
    }
}

/// Drawn above the wires between lanes.
void PatchPanel::draw_heads(const Painter& paint, const RunStatus& status) {
    const PatchPicture& picture = bench_.picture();
    const double z = canvas_.zoom;
    const auto large = letters(text_size, lane_head_height - 3.0), small = letters(small_size, lane_head_height - 3.0);
    if (!large || !small) return;
    struct Words {
        std::string text;
        double size;
        ImU32 ink;
        bool is_heavy;
    };
    for (const PictureLane& lane : picture.lanes) {
        std::vector<Words> words{{lane.name, *large, tone::text, true}, {lane.note, *small, tone::dim, false}};
        const auto group = std::ranges::find(status.groups, lane.name, &GroupStatus::name);
        if (group != status.groups.end() && group->ticks > 0) {
            words.push_back({fmt::format("{:.1f} µs a call, load {:.1f} %, late {:.3f} ms (99 %)", group->execution_us,
                                         100.0 * group->load, group->late_p99_ms),
                             *small, tone::dim, false});
            if (group->missed > 0)
                words.push_back(
                    {fmt::format(
                         "{} late{}", group->missed,
                         is_late(lane.name) ? fmt::format(", above {:.0f} %", 100.0 * max_late_share) : std::string()),
                     *small, is_late(lane.name) ? tone::bad : tone::dim, true});
        }
        const Point begin = screen(Point{picture.bounds.left + 16, lane.top + 8});
        double wide = 0.0;
        for (const Words& w : words) wide += paint.width_of(w.text, w.size, w.is_heavy) + 14.0 * z;
        paint.box({begin.x - 4.0 * z, begin.y - 1.0 * z, begin.x + wide - 6.0 * z, begin.y + 17.0 * z}, lane_ground);
        Point at = begin;
        for (const Words& w : words) {
            paint.text({at.x, at.y + (*large - w.size) * 0.7}, w.size, w.ink, w.text, w.is_heavy);
            at.x += paint.width_of(w.text, w.size, w.is_heavy) + 14.0 * z;
        }
    }
}

/// Drawn in place of boxes with invisible gaps.
void PatchPanel::draw_stacks(const Painter& paint, const Box& visible) {
    for (const Box& stack : bench_.picture().stacks)
        if (stack.meets(visible)) paint.box(screen(stack), tone::node_edge);
    if (const int node = bench_.picture().find(selected); node >= 0)
        paint.box(screen(bench_.picture().nodes[static_cast<std::size_t>(node)].box), tone::chosen);
}

void PatchPanel::draw_node(const Painter& paint, const PictureNode& node, const NodeStatus* status, const Feed* feed,
                           std::set<std::string>& looked_at) {
    const double z = canvas_.zoom;
    const Box box = screen(node.box);
    const bool is_chosen = chosen.contains(node.name);
    const ImU32 flaw = node.is_at_fault ? tone::bad : tone::warm;
    const ImU32 edge = is_chosen ? tone::chosen : node.lacks.empty() ? tone::node_edge : flaw;
    if (box.height() < smallest_box) return paint.box(box, is_chosen ? tone::chosen : tone::node_edge);
    const auto large = letters(text_size, title_height - 6.0), small = letters(small_size, 16.0);
    const ImU32 head_ink = node.colour.empty() ? tone::node_head : colour_named(node.colour);
    if (!large) {
        // Many boxes, too small for visible round corners.
        paint.box(box, edge);
        paint.box({box.left + 1.0, box.top + title_height * z, box.right - 1.0, box.bottom - 1.0},
                  node.colour.empty() ? tone::node : head_ink);
        // The name across the box, where that is large enough for some letters.
        if (const double size = readable * unit_; box.height() > size && box.width() > 3.0 * size)
            paint.text({box.left + 2.0, box.top}, size, tone::text,
                       paint.shortened(node.name, size, box.width() - 4.0));
        return;
    }
    paint.box(box, tone::node, rounding * z);
    Box head = box;
    head.bottom = box.top + (title_height - 6.0) * z;
    paint.list()->AddRectFilled(vec({head.left, head.top}), vec({head.right, head.bottom}), head_ink,
                                static_cast<float>(rounding * z), ImDrawFlags_RoundCornersTop);
    paint.frame(box, edge, rounding * z, is_chosen || node.is_part ? 2.0 : 1.0);
    double room = node_width * z - 16.0 * z;
    if (small && status && status->mean_us > 0.0) {
        const std::string time = fmt::format("{:.{}f} µs", status->mean_us, status->mean_us < 10.0 ? 1 : 0);
        paint.text_left_of({box.right - 8.0 * z, box.top + 5.0 * z}, *small, tone::dim, time);
        room -= paint.width_of(time, *small) + 6.0 * z;
        // Load of the node as a bar below the title.
        const double share = std::clamp(status->share, 0.0, 1.0);
        Box bar{box.left, head.bottom - 2.0 * z, box.left + share * box.width(), head.bottom};
        paint.box(bar, share > 0.7 ? tone::bad : share > 0.4 ? tone::warm : tone::good);
    }
    // Without room for the type the name stands in the middle.
    const double title_top = small ? box.top + 3.0 * z : box.top + 0.45 * ((title_height - 6.0) * z - *large);
    paint.text({box.left + 8.0 * z, title_top}, *large, tone::text, paint.shortened(node.name, *large, room, true),
               true);
    if (small)
        paint.text({box.left + 8.0 * z, box.top + 17.5 * z}, *small, node.lacks.empty() ? tone::dim : flaw,
                   paint.shortened(node.lacks.empty() ? node.type : node.lacks, *small, node_width * z - 14.0 * z));
    draw_ports(paint, node, feed, looked_at);
}

void PatchPanel::draw_ports(const Painter& paint, const PictureNode& node, const Feed* feed,
                            std::set<std::string>& looked_at) {
    const double z = canvas_.zoom;
    const std::optional<double> written = letters(small_size, port_height - 1.0);
    const double size = written.value_or(0.0);
    const double half = 0.5 * node_width * z - 10.0 * z;
    const PatchPicture& picture = bench_.picture();
    const ValueType *wanted = nullptr, *wanted_source = nullptr;
    if (wiring_.node >= 0) {
        const PictureNode& held = picture.nodes[static_cast<std::size_t>(wiring_.node)];
        const auto port = static_cast<std::size_t>(wiring_.port);
        if (wiring_.is_backward) wanted_source = held.inputs[port].type;
        else wanted = held.outputs[port].type;
    }
    for (const PicturePort& port : node.inputs) {
        const Point at = screen(port.at);
        const bool suits = wanted && (!port.type || port.type == wanted);
        const ImU32 ink = port.is_missing ? tone::bad : colour_of(port.type);
        if (suits) paint.dot(at, 8.0 * z, faded(ink, 0.35));
        paint.dot(at, 4.0 * z, ink);
        if (!port.is_connected) paint.dot(at, 2.4 * z, tone::node);
        if (written)
            paint.text({at.x + 9.0 * z, at.y - 0.6 * size}, size, port.is_connected || suits ? tone::text : tone::dim,
                       paint.shortened(port.name, size, half));
    }
    for (const PicturePort& port : node.outputs) {
        const Point at = screen(port.at);
        const ImU32 ink = port.is_missing ? tone::bad : colour_of(port.type);
        if (wanted_source && (!port.type || port.type == wanted_source)) paint.dot(at, 8.0 * z, faded(ink, 0.35));
        paint.dot(at, 4.0 * z, ink);
        if (!port.is_connected) paint.dot(at, 2.4 * z, tone::node);
        if (!written) continue;
        paint.text_left_of({at.x - 9.0 * z, at.y - 0.6 * size}, size, tone::text,
                           paint.shortened(port.name, size, half));
        if (!feed || !port.type || !node.lacks.empty() || node.is_part) continue;
        const std::string name = node.name + "." + port.name;
        looked_at.insert(name);
        const Feed::Latest latest = feed->latest(name);
        if (latest.count == 0) continue;
        if (port.type == &value::signal) {
            double& meter = meters_[name];
            meter = std::max(0.93 * meter, std::abs(latest.columns[0]));
            const double level = meter > 0.0 ? std::clamp(1.0 + std::log10(meter) / 3.0, 0.0, 1.0) : 0.0;
            const Box all{at.x + 8.0 * z, at.y - 11.0 * z, at.x + 58.0 * z, at.y - 6.0 * z};
            paint.box(all, colour(0x0c1015), 2.0 * z);
            paint.box({all.left, all.top, all.left + level * all.width(), all.bottom}, ink, 2.0 * z);
            continue;
        }
        const std::string text = short_value(*port.type, latest, port.unit);
        paint.text({at.x + 8.0 * z, at.y - 1.3 * size}, size, faded(ink, 0.95),
                   paint.shortened(text, size, (column_gap - 12.0) * z));
    }
}

std::string short_value(const ValueType& type, const Feed::Latest& latest, const std::string& unit) {
    const auto& c = latest.columns;
    const auto length = [&](std::size_t at) { return std::hypot(c[at], c[at + 1], c[at + 2]); };
    if (&type == &value::pose) return fmt::format("{:.1f} {:.1f} {:.1f} mm", c[0] * 1e3, c[1] * 1e3, c[2] * 1e3);
    if (&type == &value::wrench) return fmt::format("{:.2f} N", length(0));
    if (&type == &value::twist) return fmt::format("{:.1f} mm/s", length(0) * 1e3);
    if (&type == &value::boolean) return c[0] != 0.0 ? "true" : "false";
    if (&type == &value::vector && unit != "m")
        return fmt::format("{:.3g} {:.3g} {:.3g}{}{}", c[0], c[1], c[2], unit.empty() ? "" : " ", unit);
    if (&type == &value::vector) return fmt::format("{:.1f} {:.1f} {:.1f} mm", c[0] * 1e3, c[1] * 1e3, c[2] * 1e3);
    if (unit == "m") return fmt::format("{:.3f} mm", c[0] * 1e3);
    return fmt::format("{:.4g}{}{}", c[0], unit.empty() ? "" : " ", unit);
}

}  // namespace tactus::window
