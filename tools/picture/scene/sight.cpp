// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/scene/sight.hpp"

#include "dsp/core/error.hpp"
#include "tools/session/load_plan.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

namespace tactus::picture {

namespace {

constexpr double plain_screen_height = 0.3;  // m, where no rig says more

}  // namespace

display::StereoMode parse_stereo(const std::string& text) {
    if (const auto mode = display::stereo_of_name(text)) return *mode;
    throw Error(fmt::format(
        "stereo takes {}, not '{}'{}", fmt::join(display::stereo_names, ", "), text,
        did_you_mean(text, std::vector<std::string>(display::stereo_names.begin(), display::stereo_names.end()))));
}

Vec3 parse_offset(const std::string& text) {
    if (text == "none") return Vec3(0.0);
    if (text == "study") return {0.30, 0.0, 0.0};
    try {
        return display::parse_vector(text, "mm");
    } catch (const Error& error) {
        throw Error(fmt::format("an offset is none, study or \"0 mm, 0 mm, 0 mm\": {}", error.message()));
    }
}

Sight::Sight(const SightChoice& choice) : stereo(parse_stereo(choice.stereo)), head(choice.head) {
    if (!choice.rig.empty()) use_rig(choice.rig);
    if (choice.offset.empty()) return;
    if (!rig_)
        throw Error("--offset moves what is seen against what is felt: it needs a --display, which says where that is");
    set_offset(parse_offset(choice.offset));
}

void Sight::use_rig(const std::filesystem::path& path) {
    if (path.empty()) rig_.reset();
    else rig_ = display::load_rig_file(session::find_rig(path.string()));
    last_.clear();
}

void Sight::set_offset(const Vec3& offset) {
    offset_ = offset;
    last_.clear();
}

void Sight::follow(const SceneOutline& outline) {
    place_.reset();
    if (!outline.places.empty()) place_ = outline.places.front();
    to_device_ = Mat3(1.0);
    shift_to_device_ = Vec3(0.0);
    last_.clear();
}

std::vector<std::string> Sight::ports() const {
    std::vector<std::string> ports;
    if (!head.empty()) ports.push_back(head);
    if (rig_ && place_) ports.insert(ports.end(), {place_->device, place_->frame, place_->scale});
    return ports;
}

void Sight::update(const observe::Observer& observer) {
    warnings_.clear();
    if (!head.empty()) {
        const auto seen = observer.latest<Pose>(head);
        if (!seen) warnings_.push_back(fmt::format("there is no pose output '{}' for the head", head));
        else if (!is_valid(seen->value)) warnings_.push_back(fmt::format("{} is no valid pose: the head stays", head));
        else head_pose_ = seen->value * (rig_ ? rig_->eyes_in_head : Pose{});
    } else head_pose_.reset();
    if (!rig_ || !place_) return;
    const auto hand = observer.latest<Pose>(place_->device), frame = observer.latest<Pose>(place_->frame);
    const auto scale = observer.latest<double>(place_->scale);
    // Of one moment only: a hand that went on meanwhile would shake the whole scene.
    if (!hand || !frame || !scale || hand->when != frame->when || hand->when != scale->when) return;
    if (!is_valid(hand->value) || !is_valid(frame->value) || !(scale->value > 0.0)) return;
    to_device_ = Mat3(glm::mat3_cast(glm::conjugate(frame->value.orientation))) / scale->value;
    shift_to_device_ = hand->value.position - to_device_ * frame->value.position;
}

display::StereoMode Sight::mode_of(std::size_t screen) const {
    if (!rig_) return stereo;
    const display::RigScreen& way = rig_->screens[screen];
    if (way.eye || way.eyes != display::ScreenEyes::both) return display::StereoMode::mono;
    return way.stereo.value_or(stereo);
}

std::optional<double> Sight::aspect_of(std::size_t screen) const {
    if (!rig_) return std::nullopt;
    const display::Screen& seen = rig_->rig.screens[screen];
    return glm::length(seen.right()) / glm::length(seen.up());
}

display::Flip Sight::text_of(std::size_t screen) const {
    if (!rig_ || !rig_->rig.is_mirrored(screen)) return display::Flip::none;
    const Vec3 up = rig_->rig.screens[screen].up(), normal = rig_->rig.mirror->normal;
    const Pose head_now = head_pose_.value_or(rig_->rig.place_before(screen, rig_->head_away));
    const double along = glm::dot(up - 2.0 * glm::dot(up, normal) * normal, head_now.rotate({0.0, 1.0, 0.0}));
    return along < 0.0 ? display::Flip::upside_down : display::Flip::left_right;
}

display::DisplayRig Sight::rig_now() const {
    display::DisplayRig rig = rig_->rig;
    if (offset_) rig.visuo_haptic_offset = *offset_;
    const Mat3 device = Mat3(glm::mat3_cast(rig.haptic_world.orientation)) * rig.haptic_stretch;
    rig.haptic_world = {rig.haptic_world.position + device * shift_to_device_, {1.0, 0.0, 0.0, 0.0}};
    rig.haptic_stretch = device * to_device_;
    return rig;
}

std::vector<Vec3> Sight::eyes_for(std::size_t screen, const display::DisplayRig& rig) const {
    const display::RigScreen& way = rig_->screens[screen];
    if (way.eye) return {*way.eye};
    const Pose at = head_pose_.value_or(rig.place_before(0, rig_->head_away));
    const display::Eyes eyes = display::eyes_of(at, rig.between_eyes);
    switch (way.eyes) {
        case display::ScreenEyes::left: return {eyes.left};
        case display::ScreenEyes::right: return {eyes.right};
        case display::ScreenEyes::middle: return {at.position};
        case display::ScreenEyes::both: break;
    }
    if (mode_of(screen) == display::StereoMode::mono) return {at.position};
    return {eyes.left, eyes.right};
}

std::vector<display::DrawnView> Sight::views(std::size_t screen, const display::OrbitCamera& camera,
                                             const display::Bounds& scene, int width, int height) {
    const display::StereoMode mode = mode_of(screen);
    if (!rig_ && (head.empty() || !head_pose_)) return display::views_of(camera, scene, width, height, mode);
    last_.resize(screens());
    std::vector<display::RigView> seen;
    try {
        if (rig_) {
            const display::DisplayRig rig = rig_now();
            for (const Vec3& eye : eyes_for(screen, rig)) seen.push_back(rig.view(screen, eye, scene));
        } else {
            // The scene in its true size, its middle in the screen, turned as the camera has it.
            const double halves = mode == display::StereoMode::side_by_side ? 0.5 : 1.0;
            const double high = 0.5 * plain_screen_height, wide = high * halves * width / height;
            display::DisplayRig rig;
            rig.screens = {{{-wide, -high, 0.0}, {wide, -high, 0.0}, {-wide, high, 0.0}}};
            const Quat turned = glm::conjugate(camera.orientation);
            rig.haptic_world = {-(turned * camera.target), turned};
            seen = rig.views(*head_pose_, mode != display::StereoMode::mono, scene);
        }
        last_[screen] = seen;
    } catch (const Error& error) {
        const std::string name = rig_ ? rig_->screens[screen].name : "the screen";
        warnings_.push_back(fmt::format("{}: {}; its picture stays", name, error.message()));
        if (last_[screen].empty()) return display::views_of(camera, scene, width, height, mode);
    }
    return display::views_of(last_[screen], width, height, mode, text_of(screen));
}

void add_legend(display::Image& image, const display::Legend& legend, std::span<const display::DrawnView> views,
                display::Flip flip) {
    // Eyes that share the whole picture share the legend.
    for (std::size_t i = 0; i < views.size(); ++i) {
        const display::DrawnView& view = views[i];
        const bool is_drawn =
            std::ranges::any_of(views.first(i), [&](const display::DrawnView& v) { return v.x == view.x; });
        if (!is_drawn) display::add_legend(image, legend, view.x, view.width, flip);
    }
}

}  // namespace tactus::picture
