// SPDX-License-Identifier: Apache-2.0
// Overlays of the scene: measured points and the legend.
#include "dsp/core/clock.hpp"
#include "tools/window/document/hand_of_patch.hpp"
#include "tools/window/scene/label_places.hpp"
#include "tools/window/scene/scene_panel.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace tactus::window {

namespace {

ImU32 packed(const Vec3& rgb) {
    const auto part = [](double x) { return static_cast<std::uint32_t>(std::clamp(x, 0.0, 1.0) * 255.0 + 0.5); };
    return colour(part(rgb.x) << 16 | part(rgb.y) << 8 | part(rgb.z));
}

}  // namespace

std::optional<display::Picked> ScenePanel::pick(Point pixel) {
    for (const SceneScreens::Tile& tile : screens_.tiles()) {
        if (tile.views.empty() || tile.width < 1 || tile.height < 1) continue;
        const double x = (pixel.x - tile.x) * tile.picture_width / tile.width;
        const double y = (tile.height - 1 - (pixel.y - tile.y)) * tile.picture_height / tile.height;
        const auto view = std::ranges::find_if(tile.views, [&](const display::DrawnView& v) {
            return x >= v.x && x < v.x + v.width && y >= v.y && y < v.y + v.height;
        });
        if (view != tile.views.end()) return renderer_->pick(model_->update(), *view, x, y);
    }
    return {};
}

void ScenePanel::measure(Point pixel) {
    if (marks_.size() == 3) marks_.clear();
    if (const auto picked = pick(pixel)) marks_.push_back(picked->position);
    needs_picture_ = true;
}

void ScenePanel::move_site(Point pixel) {
    const auto picked = pick(pixel);
    needs_picture_ = true;
    if (!picked || !model_->is_bone(picked->mesh))
        return bench_.tell("there is no bone under the pointer; click on the bone where the saw is to cut", true);
    is_siting = !bench_.cut_at(picked->position);
    if (!is_siting) sited_at_ = ImGui::GetTime();
}

/// The part under the pointer; with Ctrl it is added to the chosen ones. The cursor of the slices goes there.
void ScenePanel::choose(Point pixel) {
    const auto picked = pick(pixel);
    if (picked && cursor) cursor = picked->position;
    model_->choose_part(picked ? model_->part_of(picked->mesh) : std::string(), ImGui::GetIO().KeyCtrl);
    needs_picture_ = true;
}

/// The hand goes to the surface under the pointer.
void ScenePanel::lead_hand(Point pixel) {
    if (const auto picked = pick(pixel)) hand_.go_to(picked->position);
}

std::optional<Point> ScenePanel::place_in(const SceneScreens::Tile& tile, const display::DrawnView& view,
                                          const Vec3& in_scene, Point corner, double pixel) {
    const auto at = view.projection.seen(in_scene);
    if (!at) return std::nullopt;
    const double across = pixel * tile.width / std::max(tile.picture_width, 1),
                 down = pixel * tile.height / std::max(tile.picture_height, 1);
    return corner + Point{pixel * tile.x + across * (view.x + 0.5 * (at->x + 1.0) * view.width),
                          pixel * tile.y + down * 0.5 * (1.0 - at->y) * view.height};
}

/// Lines along the axes of the case, open in the middle.
void ScenePanel::draw_cursor(const Painter& paint, Point corner, double pixel) {
    if (!cursor) return;
    constexpr double open = 2e-3, end = 10e-3;
    for (const SceneScreens::Tile& tile : screens_.tiles())
        for (const display::DrawnView& view : tile.views) {
            for (int axis = 0; axis < 3; ++axis)
                for (const double side : {-1.0, 1.0}) {
                    Vec3 along{0.0};
                    along[axis] = side;
                    const auto from = place_in(tile, view, *cursor + open * along, corner, pixel),
                               to = place_in(tile, view, *cursor + end * along, corner, pixel);
                    if (from && to) paint.line(*from, *to, tone::cursor, 1.5);
                }
            if (const auto at = place_in(tile, view, *cursor, corner, pixel)) {
                set_spot("scene cursor", {at->x - 1.0, at->y - 1.0, at->x + 1.0, at->y + 1.0});
                paint.dot(*at, 2.0, tone::cursor);
            }
        }
}

void ScenePanel::draw_labels(const Painter& paint, Point corner, double pixel) {
    const double size = 0.85 * static_cast<double>(ImGui::GetFontSize());
    const std::vector<SceneModel::Label>& labels = model_->labels();
    for (const SceneScreens::Tile& tile : screens_.tiles())
        for (const display::DrawnView& view : tile.views) {
            std::vector<Point> points;
            std::vector<Box> wanted;
            std::vector<const SceneModel::Label*> named;
            for (const SceneModel::Label& label : labels)
                if (const auto at = place_in(tile, view, label.at, corner, pixel)) {
                    const Point to = *at + Point{8.0, -0.5 * size};
                    points.push_back(*at);
                    wanted.push_back(
                        {to.x - 3, to.y - 1, to.x + paint.width_of(label.text, size) + 3, to.y + size + 3});
                    named.push_back(&label);
                }
            const Box within{corner.x + pixel * tile.x, corner.y + pixel * tile.y,
                             corner.x + pixel * (tile.x + tile.width), corner.y + pixel * (tile.y + tile.height)};
            const std::vector<Box> places = label_places(wanted, within);
            for (std::size_t i = 0; i < places.size(); ++i) {
                const ImU32 ink = packed(0.7 * named[i]->colour);
                // A name that had to move is led to its point.
                if (places[i].top != wanted[i].top)
                    paint.line(points[i], {places[i].left, places[i].middle().y}, ink, 1.0);
                paint.box(places[i], colour(0xffffff, 200), 3.0);
                paint.text({places[i].left + 3, places[i].top + 1}, size, ink, named[i]->text);
            }
        }
}

void ScenePanel::draw_measured(const render::Measurement& measured, ImU32 ink, const Painter& paint, Point corner,
                               double pixel) {
    const std::vector<Vec3>& points = measured.points;
    if (points.empty()) return;
    const std::string text = render::measurement_words(measured);
    const double size = static_cast<double>(ImGui::GetFontSize());
    for (const SceneScreens::Tile& tile : screens_.tiles())
        for (const display::DrawnView& view : tile.views) {
            // Drawn for each eye at their 3-D position.
            std::vector<Point> seen;
            for (const Vec3& mark : points)
                if (const auto at = place_in(tile, view, mark, corner, pixel)) seen.push_back(*at);
            if (seen.size() != points.size()) continue;
            for (std::size_t i = 0; i < seen.size(); ++i) {
                if (i > 0) paint.line(seen[i - 1], seen[i], ink, 2.0);
                paint.dot(seen[i], 4.0, ink);
            }
            if (text.empty()) continue;
            const double wide = paint.width_of(text, size);
            const Point at = seen.back() + Point{10.0, -0.5 * size};
            paint.box({at.x - 4, at.y - 2, at.x + wide + 4, at.y + size + 4}, colour(0x12161d, 220), 4.0);
            paint.text(at, size, ink, text);
        }
}

/// Over the first view of the first screen.
void ScenePanel::draw_hand(const Painter& paint, Point corner, Point size, double pixel) {
    pulled_.look(*bench_.status(), steady_ns());
    std::vector<HandSight> sights = pulled_.sights();
    const double limit = bench_.plan() ? largest_force(*bench_.plan()) : max_of_device_N;
    if (auto own = hand_.sight(limit)) sights.insert(sights.begin(), std::move(*own));
    if (sights.empty() || screens_.tiles().empty() || screens_.tiles().front().views.empty()) return;
    const SceneScreens::Tile& tile = screens_.tiles().front();
    const auto seen = [&](const Vec3& in_scene) { return place_in(tile, tile.views.front(), in_scene, corner, pixel); };
    Box free{corner.x, corner.y, corner.x + size.x, corner.y + size.y};
    hand_.draw_silence(paint, free);
    for (HandSight& sight : sights) {
        if (sights.size() == 1) sight.name.clear();
        draw_spring(paint, seen, sight);
        free.right = draw_force_bar(paint, free, sight);
    }
}

display::Legend ScenePanel::legend() const {
    display::Legend legend = model_->legend();
    legend.warnings.insert(legend.warnings.end(), sight_.warnings().begin(), sight_.warnings().end());
    if (!note_.empty()) legend.warnings.push_back(note_);
    return legend;
}

void ScenePanel::draw_legend(const Painter& paint, Point corner, int height, double scale) {
    const display::Legend legend = this->legend();
    if (legend.empty()) return;
    const double line = 15.0 * scale, size = 11.0 * scale;
    const std::size_t lines = legend.entries.size() + legend.scales.size() + legend.warnings.size();
    if (lines == 0) return;
    double wide = 60.0 * scale;
    for (const auto& entry : legend.entries) wide = std::max(wide, paint.width_of(entry.text, size) + 26.0 * scale);
    for (const auto& s : legend.scales)
        wide = std::max(wide, paint.width_of(s.title + s.low_text + s.high_text, size) + 92.0 * scale);
    for (const auto& text : legend.warnings) wide = std::max(wide, paint.width_of(text, size) + 12.0 * scale);
    Point at{corner.x + 8.0 * scale,
             corner.y + height - 8.0 * scale - (static_cast<double>(lines) * line + 6.0 * scale)};
    paint.box({at.x, at.y, at.x + wide, corner.y + height - 8.0 * scale}, colour(0xffffff, 215), 5.0 * scale);
    at = at + Point{6.0 * scale, 4.0 * scale};
    const ImU32 ink = colour(0x1e293b);
    for (const auto& s : legend.scales) {
        double x = at.x;
        paint.text({x, at.y}, size, ink, s.title);
        x += paint.width_of(s.title, size) + 8.0 * scale;
        paint.text({x, at.y}, size, ink, s.low_text);
        x += paint.width_of(s.low_text, size) + 5.0 * scale;
        paint.list()->AddRectFilledMultiColor(vec({x, at.y + 2.0 * scale}),
                                              vec({x + 50.0 * scale, at.y + 11.0 * scale}), packed(s.low),
                                              packed(s.high), packed(s.high), packed(s.low));
        paint.text({x + 55.0 * scale, at.y}, size, ink, s.high_text);
        at.y += line;
    }
    for (const auto& entry : legend.entries) {
        paint.box({at.x, at.y + 2.0 * scale, at.x + 12.0 * scale, at.y + 12.0 * scale}, packed(entry.colour),
                  2.0 * scale);
        paint.text({at.x + 18.0 * scale, at.y}, size, ink, entry.text);
        at.y += line;
    }
    for (const auto& text : legend.warnings) {
        paint.text(at, size, colour(0xb91c1c), text);
        at.y += line;
    }
}

}  // namespace tactus::window
