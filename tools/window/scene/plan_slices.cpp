// SPDX-License-Identifier: Apache-2.0
#include "tools/window/scene/plan_slices.hpp"

#include "dsp/core/error.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <system_error>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

constexpr std::array slices{Slice::axial, Slice::coronal, Slice::sagittal};

std::uint32_t ink_of(const Vec3& rgb, std::uint32_t alpha) {
    const auto part = [](double x) { return static_cast<std::uint32_t>(std::clamp(x, 0.0, 1.0) * 255.0 + 0.5); };
    return colour(part(rgb.x) << 16 | part(rgb.y) << 8 | part(rgb.z), alpha);
}

/// The fragments of the scene, or all of the scan.
display::Bounds bounds_of(const std::map<std::size_t, SceneModel::PlanPiece>& pieces, const volume::Grid& grid) {
    display::Bounds box;
    for (const auto& [place, piece] : pieces)
        for (const Vec3& p : piece.body->points) box.add(piece.pose.apply(p));
    if (box.empty()) {
        box.add(grid.origin);
        box.add(grid.position(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1));
    }
    return box;
}

}  // namespace

void PlanSlices::open(const fs::path& scan) {
    is_shown_ = is_chosen_ = true;
    asked_ = fs::absolute(scan);
    scan_.read(asked_);
}

void PlanSlices::toggle() {
    is_shown_ = !is_shown_;
    is_chosen_ = true;
}

/// Of the fragments, when no scan is asked for.
void PlanSlices::read(const fs::path& scan) {
    asked_ = scan;
    if (scan.empty()) scan_.read_fragments(plan_);
    else scan_.read(scan);
}

/// The scan that was shown with this plan last, or what its fragments hold. A plan that was changed keeps its scan; that of
/// another case does not get it.
void PlanSlices::find_scan() {
    const fs::path plan = scene_.plan_file();
    if (plan.empty() || plan == plan_) return;
    const fs::path before = std::exchange(plan_, plan);
    const bool is_further = before.empty() || are_of_one_case(before, plan);
    if (is_further && !asked_.empty()) return;
    if (is_further && !given_.empty()) return memory_.keep_scan(plan_, given_);
    if (!is_further) {
        scan_.forget();
        given_.clear();
    }
    const fs::path known = memory_.scan_of(plan_);
    std::error_code ignored;
    read(fs::exists(known, ignored) ? known : fs::path());
}

void PlanSlices::tend() {
    find_scan();
    try {
        if (!scan_.tend()) return;
    } catch (const std::exception& error) {
        bench_.tell(error.what(), true);
        const bool was_asked = !std::exchange(asked_, {}).empty();
        if (was_asked && !scan_.now() && !plan_.empty()) read({});
        return;
    }
    given_ = std::exchange(asked_, {});
    if (!given_.empty() && !plan_.empty()) memory_.keep_scan(plan_, given_);
    ++scans_;
    window_ = scan_.now()->window;
    sight_.pixels_per_m = 0.0;
}

void PlanSlices::move_cursor(const Vec3& to) {
    // Fragments may be moved out of the scan.
    const Vec3 beyond(0.3);
    const volume::Grid& grid = scan_.now()->grid;
    const Vec3 last = grid.position(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1);
    scene_.cursor = known_cursor_ = glm::clamp(to, grid.origin - beyond, last + beyond);
}

/// The scene has moved the cursor: what is around it comes into view.
void PlanSlices::follow_cursor(Point size) {
    if (scene_.cursor && *scene_.cursor != known_cursor_) {
        move_cursor(*scene_.cursor);
        const Vec3 reach(0.4 * std::min(size.x, size.y) / sight_.pixels_per_m);
        sight_.middle = glm::clamp(sight_.middle, *scene_.cursor - reach, *scene_.cursor + reach);
    }
    if (!scene_.cursor) move_cursor(known_cursor_);
}

void PlanSlices::draw_outlines(const Painter& paint, const SlicePlane& plane, Point middle, double scale) {
    constexpr double min_step = 1.5;  // pixels
    std::vector<ImVec2> points;
    for (const PlanOutlines::Piece& piece :
         outlines_.cut(scene_.plan_pieces(), plane.slice, plane.middle[axes_of(plane.slice).normal]))
        for (const Outline& line : *piece.lines) {
            points.clear();
            for (const Vec3& p : line) {
                const ImVec2 at = vec(middle + plane.pixel(p));
                const bool is_last = &p == &line.back();
                if (points.empty() || is_last ||
                    std::hypot(static_cast<double>(at.x - points.back().x),
                               static_cast<double>(at.y - points.back().y)) >= min_step)
                    points.push_back(at);
            }
            const double wide = piece.is_chosen ? 3.0 : piece.is_scanned ? 1.0 : 2.0;
            paint.list()->AddPolyline(points.data(), static_cast<int>(points.size()),
                                      ink_of(piece.colour, piece.is_scanned ? 150 : 255), ImDrawFlags_None,
                                      static_cast<float>(scale * wide));
        }
}

void PlanSlices::slice(std::size_t number, Point size, const Fonts& fonts) {
    const PlanScanData& scan = *scan_.now();
    const Point corner = point(ImGui::GetCursorScreenPos());
    const Box box{corner.x, corner.y, corner.x + size.x, corner.y + size.y};
    const Slice which = slices[number];
    const int normal = axes_of(which).normal;
    const std::string name(name_of(which));
    ImGui::InvisibleButton(
        name.c_str(), vec(size),
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
    mark_spot("slice " + name);
    const SlicePlane seen = sight_.plane(which, *scene_.cursor);
    if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left) && !ImGui::GetIO().KeyShift)
        move_cursor(seen.position(point(ImGui::GetIO().MousePos) - box.middle()));
    Vec3 cursor = *scene_.cursor;
    steer_slice(seen, box.middle(), scan.grid.spacing[normal], sight_, window_, cursor);
    if (cursor != *scene_.cursor) move_cursor(cursor);
    const SlicePlane plane = sight_.plane(which, *scene_.cursor);
    const long sample = std::lround((plane.middle[normal] - scan.grid.origin[normal]) / scan.grid.spacing[normal]);
    const Painter paint(ImGui::GetWindowDrawList(), fonts);
    paint.list()->PushClipRect(vec({box.left, box.top}), vec({box.right, box.bottom}), true);
    paint.box(box, colour(0x000000));
    // Beside the scan it is black.
    if (sample >= 0 && sample < scan.grid.size[static_cast<std::size_t>(normal)]) {
        textures_[number].show(fmt::format("{} {} {} {}", scans_, sample, window_.low, window_.high),
                               [&] { return slice_picture(scan.grid, which, plane.middle, window_, {}); });
        const auto corners = corners_of(scan.grid, plane);
        textures_[number].draw(paint, box.middle() + corners[0], box.middle() + corners[1]);
    }
    draw_outlines(paint, plane, box.middle(), fonts.scale);
    const Point at = box.middle() + plane.pixel(*scene_.cursor);
    draw_slice_cursor(paint, at, box, fonts.scale);
    set_spot("cursor " + name, {at.x - 1.0, at.y - 1.0, at.x + 1.0, at.y + 1.0});
    draw_slice_words(paint, which, *scene_.cursor, box, fonts.scale);
    paint.list()->PopClipRect();
}

void PlanSlices::head(const Fonts&) {
    const auto button = [](const char* label, const char* tip) {
        const bool is_pressed = ImGui::Button(label);
        mark_spot(label);
        if (ImGui::IsItemHovered()) show_tooltip(tip);
        ImGui::SameLine();
        return is_pressed;
    };
    if (button("Open a scan...", "slices of a CT in the frame of the case; a file dropped on the window, too") &&
        ask_scan)
        ask_scan();
    if (is_shown_ ? button("Hide slices", "leaves their room to the scene") : button("Show slices", "below the scene"))
        toggle();
    if (!is_shown_) return ImGui::NewLine();
    const PlanScanData* const scan = scan_.now();
    if (scan_.is_reading())
        return ImGui::TextDisabled("reading %s ...", asked_.empty() ? "the fragments" : asked_.filename().c_str());
    if (!scan) return ImGui::TextDisabled("this plan's files hold no densities, or too many for slices");
    std::string words = scan->name;
    if (scene_.cursor) {
        const volume::Grid& grid = scan->grid;
        const Vec3 at = glm::round((*scene_.cursor - grid.origin) / grid.spacing);
        const Vec3 size(grid.size[0], grid.size[1], grid.size[2]);
        const bool is_inside = glm::all(glm::greaterThanEqual(at, Vec3(0.0))) && glm::all(glm::lessThan(at, size));
        words += is_inside
                     ? fmt::format("; {:.0f} {} at the cursor",
                                   grid.at(static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)),
                                   scan->unit)
                     : "; the cursor is beside the scan";
    }
    ImGui::TextDisabled("%s", words.c_str());
    if (ImGui::IsItemHovered())
        show_tooltip(
            "left: the cursor, also of the scene; wheel: the next slice; Ctrl + wheel: zoom; right: grey values; "
            "middle, "
            "or Shift + left: move. Thick: where a fragment is; thin: where it was scanned");
}

void PlanSlices::draw(const Fonts& fonts) {
    if (is_shown_) tend();
    head(fonts);
    if (!is_shown_ || !scan_.now()) return rest();
    const double gap = 4.0 * fonts.scale;
    const Point room = point(ImGui::GetContentRegionAvail());
    const Point size{(room.x - 2.0 * gap) / 3.0, room.y};
    if (size.x < 16.0 || size.y < 16.0) return rest();
    if (sight_.pixels_per_m <= 0.0) {
        // The first fragments alone would be too close a view.
        if (scene_.plan_pieces().empty() || !scene_.is_fitted()) return rest();
        const display::Bounds box = bounds_of(scene_.plan_pieces(), scan_.now()->grid);
        const Vec3 wide = box.high - box.low;
        // On the fragment in the middle: between fragments there is nothing to see.
        Vec3 nearest(1e9);
        for (const auto& [place, piece] : scene_.plan_pieces())
            if (glm::length(piece.pose.position - box.middle()) < glm::length(nearest - box.middle()))
                nearest = piece.pose.position;
        move_cursor(nearest);
        sight_.fit(size, std::max({wide.x, wide.y, wide.z}), box.middle());
    }
    follow_cursor(size);
    for (std::size_t n = 0; n < slices.size(); ++n) {
        if (n > 0) ImGui::SameLine(0.0f, static_cast<float>(gap));
        slice(n, size, fonts);
    }
}

void PlanSlices::add_commands(std::vector<Command>& all) {
    if (!run_.is_there()) return;
    all.push_back({"plan", "Slices of a scan...", "", "ct dicom open axial coronal sagittal", [this] {
                       if (ask_scan) ask_scan();
                   }});
    all.push_back({"plan", "Show or hide the slices", "", "ct scan axial", [this] { toggle(); }});
}

}  // namespace tactus::window
