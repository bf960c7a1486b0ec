// SPDX-License-Identifier: Apache-2.0
#include "tools/view/scene/scene_hand.hpp"

#include "devices/hosted/clocks.hpp"
#include "tools/view/spots.hpp"
#include "tools/view/theme.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tactus::view {

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

SceneHand::SceneHand() : pulse_(haptic::window_hand(), hosted::steady_ns) {}

void SceneHand::begin_picture() {
    pulse_.begin_picture();
    // No key was looked at in the picture before: it may have been let go of since, and must be pressed anew.
    if (!std::exchange(is_steered_, false)) drop_keys();
    const std::int64_t now = hosted::steady_ns();
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
    const std::int64_t now = hosted::steady_ns();
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

void SceneHand::follow(const std::shared_ptr<observe::Observer>& observer, const picture::SceneOutline& outline) {
    forget();
    observer_ = observer;
    if (outline.places.empty()) return;
    frame_port_ = outline.places.front().frame;
    scale_port_ = outline.places.front().scale;
    for (const std::string& port : {frame_port_, scale_port_}) observer_->watch(port, observe::Watch::latest, this);
}

void SceneHand::forget() {
    if (observer_)
        for (const std::string& port : {frame_port_, scale_port_})
            if (!port.empty()) observer_->watch(port, observe::Watch::nothing, this);
    observer_.reset();
    frame_port_.clear();
    scale_port_.clear();
}

HandPlace SceneHand::place() const {
    HandPlace place{{1.0, 0.0, 0.0, 0.0}, 1.0, felt_.pose.position};
    if (!observer_ || frame_port_.empty()) return place;
    if (const auto frame = observer_->latest<Pose>(frame_port_); frame && is_valid(frame->value)) {
        place.to_scene = glm::normalize(frame->value.orientation);
        place.handle = frame->value.position;
    }
    if (const auto scale = observer_->latest<double>(scale_port_); scale && scale->value > 0.0)
        place.scale = scale->value;
    return place;
}

void SceneHand::tools() {
    if (!is_there_) {
        if (offer) offer();
        return;
    }
    if (ImGui::SmallButton(is_on_ ? "mouse: hand (H)" : "mouse: view (H)")) is_on_ = !is_on_;
    mark_spot("mouse");
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
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
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("press: stays held until pressed again; the key: while it is held");
    }
    if (offer) offer();
}

void SceneHand::hold(std::size_t button, bool wanted) {
    if (wanted) latched_ |= 1u << button;
    else latched_ &= ~(1u << button);
}

void SceneHand::go_to(const Vec3& in_scene) {
    if (!is_there_) return;
    const HandPlace place = this->place();
    cursor_.move(in_scene - cursor_.in_scene(felt_.pose, place), place);
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
    const HandPlace place = this->place();
    const Vec3 right = camera.orientation * Vec3(1.0, 0.0, 0.0), up = camera.orientation * Vec3(0.0, 1.0, 0.0),
               forward = camera.orientation * Vec3(0.0, 0.0, -1.0);
    step_by_keys(right, up, forward, place);
    if (!is_hovered_) return false;
    // A pixel at the depth of the hand.
    const double depth = std::max(glm::dot(place.handle - camera.eye(), forward), 1e-3);
    const double per_pixel = 2.0 * depth * std::tan(0.5 * camera.vertical_field_of_view_rad) / std::max(height, 1);
    const Point by = point(io.MouseDelta);
    if (!ImGui::IsItemActive()) is_drag_stale_ = false;
    const bool drags = ImGui::IsItemActive() && !is_drag_stale_;
    if (drags && ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        if (io.KeyShift) cursor_.move(forward * (-by.y * per_pixel), place);
        else cursor_.move((right * by.x - up * by.y) * per_pixel, place);
    } else if (drags && ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
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

void SceneHand::draw(const Painter& paint, const Box& picture,
                     const std::function<std::optional<Point>(const Vec3&)>& seen, double limit_N) const {
    if (!is_there_) return;
    const HandPlace place = this->place();
    const auto hand = seen(place.handle), cursor = seen(cursor_.in_scene(felt_.pose, place));
    const double force = glm::length(felt_.force.force);
    const double share = std::clamp(force / std::max(limit_N, 0.1), 0.0, 1.0);
    const ImU32 ink = share > 0.8 ? tone::bad : share > 0.4 ? tone::warm : tone::good;
    // As the letters, so that a dense screen shows them in the same size.
    constexpr double usual_letters = 14.0;
    const double s = static_cast<double>(ImGui::GetFontSize()) / usual_letters;
    if (hand && cursor) {
        // A spring of eight turns, which its stretch makes flat.
        constexpr int turns = 16;
        const Point along = *cursor - *hand;
        const double length = std::hypot(along.x, along.y);
        Point before = *hand;
        for (int i = 1; i <= turns && length > 3.0 * s; ++i) {
            const double side = i == turns ? 0.0 : (i % 2 == 0 ? -4.0 : 4.0) * s;
            const Point at = *hand + along * (i / static_cast<double>(turns)) +
                             Point{-along.y / length * side, along.x / length * side};
            paint.line(before, at, ink, 2.0 * s);
            before = at;
        }
        paint.dot(*cursor, 6.0 * s, ink);
        paint.dot(*hand, 3.0 * s, colour(0x1e293b));
    }
    const double high = 0.4 * picture.height(), wide = 14.0 * s, right = picture.right - 14.0 * s;
    const Box bar{right - wide, picture.bottom - 34.0 * s - high, right, picture.bottom - 34.0 * s};
    paint.box({bar.left - 4.0 * s, bar.top - 4.0 * s, bar.right + 4.0 * s, picture.bottom - 8.0 * s},
              colour(0xffffff, 215), 4.0 * s);
    paint.frame(bar, colour(0x1e293b), 2.0 * s);
    paint.box({bar.left, bar.bottom - share * high, bar.right, bar.bottom}, ink, 2.0 * s);
    const double size = 0.85 * usual_letters * s;
    const std::string text = fmt::format("{:.1f} N", force);
    const double text_wide = paint.width_of(text, size);
    paint.box({right - text_wide - 6.0 * s, picture.bottom - 30.0 * s, right + 4.0 * s, picture.bottom - 8.0 * s},
              colour(0xffffff, 215), 4.0 * s);
    paint.text({right - text_wide, picture.bottom - 28.0 * s}, size, colour(0x1e293b), text);
    if (felt_.is_silent != 0)
        paint.text({picture.left + 12.0 * s, picture.top + 12.0 * s}, size, tone::bad,
                   "the hand was let go: pictures came too late");
}

}  // namespace tactus::view
