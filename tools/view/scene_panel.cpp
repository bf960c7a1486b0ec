// SPDX-License-Identifier: Apache-2.0
#include "tools/view/scene_panel.hpp"

#include "dsp/core/error.hpp"
#include "tools/view/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

namespace tactus::view {

namespace {

// A picture of the scene costs far more than one of the panels: so many a second are enough while nobody moves it, and
// fewer where it takes more than a third of the time. A head that moves wants all there are.
constexpr double picture_every_s = 1.0 / 30.0, most_wait_s = 1.0;
constexpr std::size_t many_triangles = 300'000;

}  // namespace

void ScenePanel::add_wanted(std::set<std::string>& ports) const {
    ports.insert(wanted_.begin(), wanted_.end());
    for (const std::string& port : sight_.ports()) ports.insert(port);
}

void ScenePanel::attempt(const std::function<void()>& what) {
    try {
        what();
    } catch (const Error& error) {
        bench_.tell(error.what(), true);
    }
}

void ScenePanel::look_from(NamedView view) {
    camera.look_from(view);
    is_aimed_ = false;
}

void ScenePanel::reset() {
    look_from(NamedView::iso);
    clip(-1, 0.5);
    is_measuring = false;
    marks_.clear();
}

void ScenePanel::clip(int axis, double share) {
    clip_axis_ = axis;
    clip_share_ = share;
    needs_picture_ = true;
}

void ScenePanel::use(const SightChoice& choice) {
    Sight sight(choice);
    if (model_) sight.follow(model_->outline());
    sight_ = std::move(sight);
    rig_file_ = choice.rig.string();
    if (!choice.offset.empty()) offset_ = choice.offset;
    windows_ = Windows::where_rig_says;
    needs_picture_ = true;
}

void ScenePanel::use_stereo(const std::string& mode) {
    const bool is_number = mode.size() == 1 && mode[0] >= '0' && mode[0] <= '3';
    sight_.stereo = is_number ? static_cast<StereoMode>(mode[0] - '0') : parse_stereo(mode);
    // Which windows have a buffer for each eye is decided when they are opened.
    if (screens_.are_open() || sight_.stereo == StereoMode::quad_buffer)
        windows_ = screens_.are_open() ? Windows::all : Windows::where_rig_says;
    needs_picture_ = true;
}

void ScenePanel::use_head(const std::string& port) {
    sight_.head = port;
    needs_picture_ = true;
}

void ScenePanel::use_rig(const std::string& file) {
    sight_.use_rig(file);
    if (model_) sight_.follow(model_->outline());
    rig_file_ = file;
    offset_ = "as the rig says";
    windows_ = file.empty() ? Windows::none : Windows::where_rig_says;
    needs_picture_ = true;
}

void ScenePanel::use_offset(const std::string& offset) {
    sight_.set_offset(parse_offset(offset));
    offset_ = offset;
    needs_picture_ = true;
}

void ScenePanel::show_screens(bool wanted) { windows_ = wanted ? Windows::all : Windows::none; }

/// Opens and closes windows between two pictures of the scene.
void ScenePanel::tend_screens() {
    screens_.tend();
    const Windows wanted = std::exchange(windows_, Windows::as_they_are);
    if (wanted == Windows::as_they_are) return;
    needs_picture_ = true;
    note_.clear();
    screens_.close();
    if (wanted == Windows::none) return;
    try {
        screens_.open(sight_, wanted == Windows::all);
    } catch (const Error& error) {
        bench_.tell(note_ = error.what(), true);
        if (sight_.stereo == StereoMode::quad_buffer) sight_.stereo = StereoMode::side_by_side;
    }
}

/// In the row where it fits, or else in the next one.
static bool next_button(const char* label) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float end =
        ImGui::GetItemRectMax().x + style.ItemSpacing.x + ImGui::CalcTextSize(label).x + 2.0f * style.FramePadding.x;
    if (end < ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
    return ImGui::SmallButton(label);
}

void ScenePanel::tools() {
    for (std::size_t i = 0; i < view_names.size(); ++i) {
        const std::string name(view_names[i]);
        if (i == 0 ? ImGui::SmallButton(name.c_str()) : next_button(name.c_str())) look_from(static_cast<NamedView>(i));
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("key %d", static_cast<int>(i) + 1);
    }
    if (next_button("fit")) fit();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("key F");
    if (next_button("reset")) reset();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("key R: from iso, all of it, nothing cut away");
    if (next_button(is_measuring ? "measuring" : "measure")) {
        is_measuring = !is_measuring;
        marks_.clear();
        needs_picture_ = true;
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("two clicks: distance; three: angle at the second");
    sight_tools();
    ImGui::SameLine();
    const float unit = ImGui::GetFontSize();
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

/// Stereo, head, rig, offset, windows.
void ScenePanel::sight_tools() {
    const float unit = ImGui::GetFontSize();
    const auto chosen = static_cast<std::size_t>(sight_.stereo);
    ImGui::SetNextItemWidth(7.5f * unit);
    if (ImGui::BeginCombo("##stereo", std::string(stereo_names[chosen]).c_str())) {
        for (std::size_t i = 0; i < stereo_names.size(); ++i)
            if (ImGui::Selectable(std::string(stereo_names[i]).c_str(), i == chosen))
                use_stereo(std::string(stereo_names[i]));
        ImGui::EndCombo();
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(7.5f * unit);
    if (ImGui::BeginCombo("##head", sight_.head.empty() ? "no head" : sight_.head.c_str())) {
        if (ImGui::Selectable("no head", sight_.head.empty())) use_head("");
        if (observer_)
            for (const Observer::Port& port : observer_->ports())
                if (port.type == &value::pose && ImGui::Selectable(port.name.c_str(), port.name == sight_.head))
                    use_head(port.name);
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("the pose that is the viewer's head: the picture follows it");
    ImGui::SameLine();
    if (ImGui::SmallButton("screens...")) ImGui::OpenPopup("screens");
    if (!ImGui::BeginPopup("screens")) return;
    static char file[512] = "";
    if (ImGui::IsWindowAppearing()) std::snprintf(file, sizeof file, "%s", rig_file_.c_str());
    ImGui::SetNextItemWidth(24.0f * unit);
    ImGui::InputTextWithHint("rig", "file of 'tactus calibrate'", file, sizeof file);
    if (ImGui::Button("use")) attempt([&] { use_rig(file); });
    ImGui::SameLine();
    if (ImGui::Button("none")) use_rig("");
    if (sight_.rig()) {
        ImGui::SetNextItemWidth(12.0f * unit);
        if (ImGui::BeginCombo("seen against felt", offset_.c_str())) {
            for (const char* name : {"none", "study"})
                if (ImGui::Selectable(name, offset_ == name)) use_offset(name);
            ImGui::EndCombo();
        }
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("study: 0.3 m to the right");
    }
    bool open = screens_.are_open();
    if (ImGui::Checkbox("windows of their own", &open)) show_screens(open);
    ImGui::EndPopup();
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
    if (!io.WantTextInput && ImGui::IsKeyPressed('R', false)) reset();
    needs_picture_ = needs_picture_ || before.eye() != camera.eye() || before.target != camera.target;
}

void ScenePanel::render(int width, int height) {
    const double now = ImGui::GetTime();
    const bool same_size = width == width_ && height == height_;
    if (std::exchange(was_drawn_, false)) cost_s_ = static_cast<double>(ImGui::GetIO().DeltaTime);
    const double every = std::clamp((sight_.is_off_axis() ? 1.0 : 3.0) * cost_s_,
                                    sight_.is_off_axis() ? 0.0 : picture_every_s, most_wait_s);
    if (!needs_picture_ && is_aimed_ && same_size && now - drawn_at_ < every) return;
    drawn_at_ = now;
    was_drawn_ = true;
    needs_picture_ = false;
    width_ = width;
    height_ = height;
    Picture& picture = model_->update();
    sight_.update(*observer_);
    screens_.lay_out(sight_, width, height);
    const double aspect =
        static_cast<double>(width) / height * (sight_.mode_of(0) == StereoMode::side_by_side ? 0.5 : 1.0);
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
    screens_.samples = renderer_->is_software() && model_->triangles() > many_triangles ? 1 : 4;
    screens_.draw(*renderer_, picture, sight_, camera, model_->legend());
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
            sight_.follow(model_->outline());
            plan_version_ = bench_.plan_version();
            is_aimed_ = false;
        }
        tools();
        const Point corner = point(ImGui::GetCursorScreenPos()), size = point(ImGui::GetContentRegionAvail());
        // Where the screen counts several pixels as one, the picture still has them all.
        const double dense = std::max(1.0, static_cast<double>(ImGui::GetIO().DisplayFramebufferScale.x));
        const int width = static_cast<int>(size.x * dense), height = static_cast<int>(size.y * dense);
        if (width < 8 || height < 8) return;
        ImGui::InvisibleButton(
            "space", vec(size),
            ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
        steer(static_cast<int>(size.x), static_cast<int>(size.y));
        tend_screens();
        render(width, height);
        if (is_measuring && ImGui::IsItemHovered() && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
            ImGui::GetIO().MouseDragMaxDistanceSqr[0] < 9.0f)
            measure((point(ImGui::GetIO().MousePos) - corner) * dense);
        const Painter paint(ImGui::GetWindowDrawList(), fonts);
        if (sight_.rig()) paint.box({corner.x, corner.y, corner.x + size.x, corner.y + size.y}, colour(0x0b0e13), 6.0);
        for (std::size_t i = 0; i < screens_.tiles().size(); ++i) {
            const SceneScreens::Tile& tile = screens_.tiles()[i];
            const Point at = corner + Point{tile.x / dense, tile.y / dense};
            const Point far = at + Point{tile.width / dense, tile.height / dense};
            paint.list()->AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(tile.texture)),
                                          vec(at), vec(far), ImVec2(0, 1), ImVec2(1, 0), 0xFFFFFFFF,
                                          static_cast<float>(6.0 * fonts.scale));
            if (sight_.rig())
                paint.text(at + Point{8.0, 6.0}, 11.0 * fonts.scale, colour(0x1e293b), sight_.rig()->screens[i].name);
        }
        draw_marks(paint, corner, 1.0 / dense);
        if (!screens_.are_open()) draw_legend(paint, corner, static_cast<int>(size.y), fonts.scale);
    } catch (const Error& error) {
        if (problem_ != error.what()) bench_.tell(problem_ = error.what(), true);
        ImGui::TextWrapped("%s", problem_.c_str());
    }
}

}  // namespace tactus::view
