// SPDX-License-Identifier: Apache-2.0
#include "tools/view/scene_panel.hpp"

#include "dsp/core/error.hpp"
#include "tools/view/theme.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tactus::view {

namespace {

// A picture of the scene costs far more than one of the panels: so many a second are enough while nobody moves it, and
// fewer where it takes more than a third of the time.
constexpr double picture_every_s = 1.0 / 30.0, most_wait_s = 1.0;

ImU32 packed(const Vec3& rgb) {
    const auto part = [](double x) { return static_cast<std::uint32_t>(std::clamp(x, 0.0, 1.0) * 255.0 + 0.5); };
    return colour(part(rgb.x) << 16 | part(rgb.y) << 8 | part(rgb.z));
}

}  // namespace

void ScenePanel::add_wanted(std::set<std::string>& ports) const { ports.insert(wanted_.begin(), wanted_.end()); }

void ScenePanel::look_from(NamedView view) {
    camera.look_from(view);
    is_aimed_ = false;
}

void ScenePanel::clip(int axis, double share) {
    clip_axis_ = axis;
    clip_share_ = share;
    needs_picture_ = true;
}

void ScenePanel::tools() {
    static const char* const stereo_names[] = {"mono", "side by side", "anaglyph", "quad buffer"};
    const float unit = ImGui::GetFontSize();
    for (std::size_t i = 0; i < view_names.size(); ++i) {
        if (ImGui::SmallButton(std::string(view_names[i]).c_str())) look_from(static_cast<NamedView>(i));
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("key %d", static_cast<int>(i) + 1);
        ImGui::SameLine();
    }
    if (ImGui::SmallButton("fit")) fit();
    ImGui::SameLine();
    if (ImGui::SmallButton(is_measuring ? "measuring" : "measure")) {
        is_measuring = !is_measuring;
        marks_.clear();
        needs_picture_ = true;
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("two clicks: distance; three: angle at the second");
    ImGui::SetNextItemWidth(8.0f * unit);
    int chosen = static_cast<int>(stereo);
    if (ImGui::Combo("##stereo", &chosen, stereo_names, 3)) {
        stereo = static_cast<StereoMode>(chosen);
        needs_picture_ = true;
    }
    ImGui::SameLine();
    static const char* const axes[] = {"no clip", "clip x", "clip y", "clip z"};
    int axis = clip_axis_ + 1;
    ImGui::SetNextItemWidth(6.0f * unit);
    if (ImGui::Combo("##axis", &axis, axes, 4)) clip(axis - 1, clip_share_);
    if (clip_axis_ < 0) return;
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1.0f);
    auto share = static_cast<float>(clip_share_);
    if (ImGui::SliderFloat("##clip", &share, 0.0f, 1.0f, "%.2f")) clip(clip_axis_, static_cast<double>(share));
}

void ScenePanel::steer(int width, int height) {
    if (!ImGui::IsItemHovered() && !ImGui::IsItemActive()) return;
    const ImGuiIO& io = ImGui::GetIO();
    const Point by = point(io.MouseDelta);
    const OrbitCamera before = camera;
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2.0f) && !io.KeyShift)
        camera.orbit(-by.x * 2.0 * std::numbers::pi / width, by.y * std::numbers::pi / height);
    else if (ImGui::IsMouseDragging(ImGuiMouseButton_Right, 2.0f) ||
             ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 2.0f) ||
             ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2.0f))
        camera.pan(by.x / height, -by.y / height);
    if (io.MouseWheel != 0.0f) camera.zoom(std::pow(1.15, static_cast<double>(io.MouseWheel)));
    if (!io.WantTextInput)
        for (int key = 1; key <= 7; ++key)
            if (ImGui::IsKeyPressed('0' + key, false)) look_from(*view_of_number(key));
    if (!io.WantTextInput && ImGui::IsKeyPressed('F', false)) fit();
    needs_picture_ = needs_picture_ || before.eye() != camera.eye() || before.target != camera.target;
}

void ScenePanel::render(int width, int height) {
    const double now = ImGui::GetTime();
    const bool same_size = width == target_.width() && height == target_.height();
    if (std::exchange(was_drawn_, false)) cost_s_ = static_cast<double>(ImGui::GetIO().DeltaTime);
    const double every = std::clamp(3.0 * cost_s_, picture_every_s, most_wait_s);
    if (!needs_picture_ && is_aimed_ && same_size && now - drawn_at_ < every) return;
    drawn_at_ = now;
    was_drawn_ = true;
    needs_picture_ = false;
    Picture& picture = model_->update();
    const double aspect = static_cast<double>(width) / height * (stereo == StereoMode::side_by_side ? 0.5 : 1.0);
    if (!is_aimed_ && !model_->bounds().empty()) {
        camera.fit(model_->bounds(), aspect);
        is_aimed_ = true;
    }
    picture.clip.reset();
    if (clip_axis_ >= 0 && !model_->bounds().empty()) {
        const Bounds& box = model_->bounds();
        Vec3 normal(0.0);
        normal[clip_axis_] = 1.0;
        picture.clip = Plane{box.low + clip_share_ * (box.high - box.low), normal};
    }
    views_ = views_of(camera, picture.bounds, width, height, stereo);
    target_.begin(width, height);
    renderer_->draw(picture, views_);
    target_.end();
}

void ScenePanel::measure(Point pixel, int height) {
    if (views_.empty()) return;
    if (marks_.size() == 3) marks_.clear();
    target_.begin(target_.width(), target_.height());
    const auto picked = renderer_->pick(model_->update(), views_.front(), pixel.x, height - 1 - pixel.y);
    target_.end();
    needs_picture_ = true;
    if (picked) marks_.push_back(picked->position);
}

void ScenePanel::draw_marks(const Painter& paint, Point corner, int width, int height) {
    if (marks_.empty() || views_.empty()) return;
    std::vector<Point> seen;
    for (const Vec3& mark : marks_)
        if (const auto at = views_.front().projection.seen(mark))
            seen.push_back(corner + Point{0.5 * (at->x + 1.0) * views_.front().width, 0.5 * (1.0 - at->y) * height});
    if (seen.size() != marks_.size() || width == 0) return;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (i > 0) paint.line(seen[i - 1], seen[i], tone::chosen, 2.0);
        paint.dot(seen[i], 4.0, tone::chosen);
    }
    std::string text;
    if (marks_.size() >= 2) text = fmt::format("{:.2f} mm", 1e3 * glm::length(marks_[1] - marks_[0]));
    if (marks_.size() == 3) {
        const Vec3 a = marks_[0] - marks_[1], b = marks_[2] - marks_[1];
        const double cosine = glm::dot(a, b) / std::max(glm::length(a) * glm::length(b), 1e-30);
        text += fmt::format(", {:.2f} mm, {:.1f}°", 1e3 * glm::length(b),
                            std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi);
    }
    const double size = static_cast<double>(ImGui::GetFontSize());
    const double wide = paint.width_of(text, size);
    if (text.empty()) return;
    const Point at = seen.back() + Point{10.0, -0.5 * size};
    paint.box({at.x - 4, at.y - 2, at.x + wide + 4, at.y + size + 4}, colour(0x12161d, 220), 4.0);
    paint.text(at, size, tone::chosen, text);
}

void ScenePanel::draw_legend(const Painter& paint, Point corner, int height, double scale) {
    const Legend& legend = model_->legend();
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

void ScenePanel::draw(const std::shared_ptr<Observer>& observer, const Fonts& fonts) {
    if (!observer || !bench_.plan()) return ImGui::TextDisabled("no run");
    try {
        if (!renderer_) renderer_ = std::make_unique<SceneRenderer>();
        if (observer != observer_) {
            model_.reset();
            observer_ = observer;
            plan_version_ = -1;
        }
        if (plan_version_ != bench_.plan_version()) {
            SceneOutline outline = outline_of(*bench_.plan());
            const std::vector<std::string> ports = outline.ports();
            wanted_ = {ports.begin(), ports.end()};
            if (!model_) model_ = std::make_unique<SceneModel>(std::move(outline), *observer_, *renderer_);
            else model_->follow(std::move(outline));
            plan_version_ = bench_.plan_version();
            is_aimed_ = false;
        }
        tools();
        const Point corner = point(ImGui::GetCursorScreenPos()), size = point(ImGui::GetContentRegionAvail());
        const int width = static_cast<int>(size.x), height = static_cast<int>(size.y);
        if (width < 8 || height < 8) return;
        ImGui::InvisibleButton(
            "space", vec(size),
            ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
        steer(width, height);
        render(width, height);
        if (is_measuring && ImGui::IsItemHovered() && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
            ImGui::GetIO().MouseDragMaxDistanceSqr[0] < 9.0f)
            measure(point(ImGui::GetIO().MousePos) - corner, height);
        const Painter paint(ImGui::GetWindowDrawList(), fonts);
        paint.list()->AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(target_.texture())),
                                      vec(corner), vec(corner + size), ImVec2(0, 1), ImVec2(1, 0), 0xFFFFFFFF,
                                      static_cast<float>(6.0 * fonts.scale));
        draw_marks(paint, corner, width, height);
        draw_legend(paint, corner, height, fonts.scale);
    } catch (const Error& error) {
        if (problem_ != error.what()) bench_.tell(problem_ = error.what(), true);
        ImGui::TextWrapped("%s", problem_.c_str());
    }
}

}  // namespace tactus::view
