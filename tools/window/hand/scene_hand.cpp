// SPDX-License-Identifier: Apache-2.0
#include "tools/window/hand/scene_hand.hpp"

#include "dsp/core/clock.hpp"
#include "tools/window/document/hand_of_patch.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tactus::window {

namespace {

constexpr std::int64_t forgotten_ns = 2'000'000'000;  // a device that is not read any more
constexpr std::int64_t longest_hold_ns = 1'000'000'000;  // of what is held, without a picture
constexpr int first_pictures = 6, fewest_pictures = 2;
// A driver that has heard nothing for 10 s takes the window for lost: where pictures take long, fewer must do.
constexpr std::int64_t longest_wait_ns = 2'000'000'000;
constexpr double radians_per_pixel = 0.006;
constexpr double wheel_step_m = 1e-3, key_step_m = 0.5e-3, key_turn_rad = 0.03;

/// Bits of DeviceSample::buttons; bit 1 marks gaps of recordings.
struct HandButton {
    const char* name;
    char key;
    std::int64_t bit;
};
constexpr std::array<HandButton, 4> hand_buttons{
    {{"trigger (T)", 'T', 1}, {"second (Y)", 'Y', 4}, {"third (U)", 'U', 8}, {"fourth (I)", 'I', 16}}};

}  // namespace

SceneHand::SceneHand() : pulse_(haptic::window_hand(), steady_ns) {}

void SceneHand::begin_picture() {
    pulse_.begin_picture();
    // No key was looked at in the picture before: it may have been let go of since, and must be pressed anew.
    if (!std::exchange(is_steered_, false)) drop_keys();
    const std::int64_t now = steady_ns();
    interval_ns_ = picture_ns_ > 0 ? now - picture_ns_ : 0;
    picture_ns_ = now;
    // Only ticks count: between the device and the first of them the window may still read the scene.
    if (const std::int64_t ticked = std::exchange(ticked_ns_, felt_.at_ns); ticked != felt_.at_ns) {
        if (pictures_ == 0) first_ns_ = now;
        const bool is_long = pictures_ + 1 >= fewest_pictures && now - first_ns_ > longest_wait_ns;
        pictures_ = is_long ? first_pictures : std::min(pictures_ + 1, first_pictures);
    }
    beat();
}

void SceneHand::end_picture() {
    beat();
    pulse_.end_picture();
}

void SceneHand::let_go() {
    drop_keys();
    latched_ = 0;
    is_drag_stale_ = true;
    // Nor does the spring pull on.
    if (is_there_) cursor_.begin(felt_.pose);
}

void SceneHand::drop_keys() {
    keys_ = 0;
    stale_ = ~0u;
}

void SceneHand::beat() {
    const std::int64_t now = steady_ns();
    const bool was_silent = spoke_ns_ > 0 && now - spoke_ns_ > longest_hold_ns;
    spoke_ns_ = now;
    std::uint64_t number = 0;
    if (!haptic::window_hand().felt.read(felt_, number)) return;
    // The device of a run that stands still is not read; what it holds stays held.
    is_there_ = felt_.run != 0 && (now - felt_.at_ns < forgotten_ns || (stands_ && is_there_ && felt_.run == run_));
    if (was_silent) let_go();
    if (!is_there_) return pulse_.forget();
    if (felt_.run != run_) {
        run_ = felt_.run;
        cursor_.begin(felt_.pose);
        latched_ = keys_ = 0;
        pictures_ = 0;
        ticked_ns_ = felt_.at_ns;
    }
    // It goes on from where it is.
    if (stands_) cursor_.begin(felt_.pose);
    if (pictures_ < first_pictures) return pulse_.forget();
    cursor_.stay_near(felt_.pose, glm::length(felt_.force.force));
    pulse_.say({cursor_.wanted(), held_buttons(), now, interval_ns_, run_});
}

std::int64_t SceneHand::held_buttons() const {
    std::int64_t held = 0;
    for (std::size_t i = 0; i < hand_buttons.size(); ++i)
        if (((keys_ | latched_) >> i & 1u) != 0) held |= hand_buttons[i].bit;
    return held;
}

void SceneHand::follow(const std::shared_ptr<observe::Observer>& observer, const render::SceneOutline& outline,
                       const compile::Schedule& plan) {
    place_.forget();
    if (outline.places.empty()) return;
    const render::SceneOutline::Place* place = &outline.places.front();
    for (const compile::ScheduleNode& node : plan.nodes) {
        if (node.type->role != NodeRole::hand_source || driver_of(plan, device_of(plan, node)) != "mouse") continue;
        const auto own = std::ranges::find_if(outline.places, [&](const render::SceneOutline::Place& one) {
            return one.device.starts_with(node.name + ".");
        });
        if (own != outline.places.end()) place = &*own;
    }
    place_.follow(observer, *place);
}

Vec3 SceneHand::cursor_in_scene(const HandPlace& place) const {
    return in_scene(cursor_.wanted().position, felt_.pose.position, place);
}

void SceneHand::tools() {
    if (!is_there_) {
        if (offer) offer();
        return;
    }
    if (ImGui::SmallButton(is_on_ ? "mouse: hand (H)" : "mouse: view (H)")) is_on_ = !is_on_;
    mark_spot("mouse");
    if (ImGui::IsItemHovered())
        show_tooltip(
            "left button: move; with Shift, or the wheel: nearer and farther\nright button: turn; with Shift: roll\n"
            "middle button: turn the view\narrows, Page Up, Page Down: small steps; with Shift: turns\nH: mouse for "
            "the hand or the view");
    for (std::size_t i = 0; i < hand_buttons.size(); ++i) {
        const float end = ImGui::GetItemRectMax().x + 2.0f * ImGui::GetStyle().ItemSpacing.x +
                          ImGui::CalcTextSize(hand_buttons[i].name).x;
        if (end < ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
        const bool is_held = ((keys_ | latched_) >> i & 1u) != 0;
        if (is_held) ImGui::PushStyleColor(ImGuiCol_Button, faded(tone::good, 0.5));
        if (ImGui::SmallButton(hand_buttons[i].name)) latched_ ^= 1u << i;
        if (is_held) ImGui::PopStyleColor();
        mark_spot(hand_buttons[i].name);
        if (ImGui::IsItemHovered()) show_tooltip("press: stays held until pressed again; the key: while it is held");
    }
    if (offer) offer();
}

void SceneHand::hold(std::size_t button, bool wanted) {
    if (wanted) latched_ |= 1u << button;
    else latched_ &= ~(1u << button);
}

void SceneHand::go_to(const Vec3& to) {
    if (!is_there_) return;
    const HandPlace place = place_.of(felt_.pose);
    cursor_.move(to - cursor_in_scene(place), place);
}

void SceneHand::press_keys() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput) return drop_keys();
    // Keys for something else press nothing, but what is held stays held.
    const bool is_for_others = io.KeyCtrl || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    for (std::size_t i = 0; i < hand_buttons.size(); ++i) {
        const unsigned bit = 1u << i;
        if (!ImGui::IsKeyDown(hand_buttons[i].key)) {
            keys_ &= ~bit;
            stale_ &= ~bit;
        } else if (is_for_others && (keys_ & bit) == 0) stale_ |= bit;
        else if ((stale_ & bit) == 0) {
            keys_ |= bit;
            latched_ &= ~bit;
        }
    }
    if (!is_for_others && ImGui::IsKeyPressed('H', false)) is_on_ = !is_on_;
}

bool SceneHand::steer(const display::OrbitCamera& camera, int height) {
    if (!is_there_) return false;
    is_steered_ = true;
    press_keys();
    is_hovered_ = ImGui::IsItemHovered() || ImGui::IsItemActive();
    if (!is_on_) return false;
    const ImGuiIO& io = ImGui::GetIO();
    const HandPlace place = place_.of(felt_.pose);
    const Vec3 right = camera.orientation * Vec3(1.0, 0.0, 0.0), up = camera.orientation * Vec3(0.0, 1.0, 0.0),
               forward = camera.orientation * Vec3(0.0, 0.0, -1.0);
    step_by_keys(right, up, forward, place);
    if (!is_hovered_) return false;
    // A pixel at the depth of the hand.
    const double depth = std::max(glm::dot(place.handle - camera.eye(), forward), 1e-3);
    const double per_pixel = 2.0 * depth * std::tan(0.5 * camera.vertical_field_of_view_rad) / std::max(height, 1);
    const Point by = point(io.MouseDelta);
    // What the pointer moved before the press is none of it, what it moved before the release is.
    const bool drags =
        (ImGui::IsItemActive() ? !ImGui::IsItemActivated() : ImGui::IsItemDeactivated()) && !is_drag_stale_;
    if (!ImGui::IsItemActive()) is_drag_stale_ = false;
    const auto drags_with = [&](ImGuiMouseButton button) {
        return drags && (ImGui::IsMouseDown(button) || ImGui::IsMouseReleased(button));
    };
    if (drags_with(ImGuiMouseButton_Left)) {
        if (io.KeyShift) cursor_.move(forward * (-by.y * per_pixel), place);
        else cursor_.move((right * by.x - up * by.y) * per_pixel, place);
    } else if (drags_with(ImGuiMouseButton_Right)) {
        if (io.KeyShift) cursor_.turn(forward * (by.x * radians_per_pixel), place);
        else cursor_.turn((up * by.x + right * by.y) * radians_per_pixel, place);
    } else if (ImGui::IsMouseDown(ImGuiMouseButton_Middle)) return false;
    if (io.MouseWheel != 0.0f) cursor_.move(forward * (static_cast<double>(io.MouseWheel) * wheel_step_m), place);
    return true;
}

/// Wherever the pointer is: who has no mouse moves the hand, too.
void SceneHand::step_by_keys(const Vec3& right, const Vec3& up, const Vec3& forward, const HandPlace& place) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || io.KeyCtrl || io.KeyAlt || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) return;
    const auto step = [&](ImGuiKey key, const Vec3& along, const Vec3& about) {
        if (!ImGui::IsKeyPressed(ImGui::GetKeyIndex(key))) return;
        if (io.KeyShift) cursor_.turn(about * key_turn_rad, place);
        else cursor_.move(along * key_step_m, place);
    };
    step(ImGuiKey_LeftArrow, -right, -up);
    step(ImGuiKey_RightArrow, right, up);
    step(ImGuiKey_UpArrow, up, -right);
    step(ImGuiKey_DownArrow, -up, right);
    step(ImGuiKey_PageUp, forward, forward);
    step(ImGuiKey_PageDown, -forward, -forward);
}

std::optional<HandSight> SceneHand::sight(double limit_N) const {
    if (!is_there_) return std::nullopt;
    const HandPlace place = place_.of(felt_.pose);
    return HandSight{place.handle, cursor_in_scene(place), glm::length(felt_.force.force), limit_N, {}};
}

void SceneHand::draw_silence(const Painter& paint, const Box& picture) const {
    if (!is_there_ || felt_.is_silent == 0) return;
    const double size = 0.85 * static_cast<double>(ImGui::GetFontSize());
    paint.text({picture.left + size, picture.top + size}, size, tone::bad,
               "the hand was let go: pictures came too late");
}

}  // namespace tactus::window
