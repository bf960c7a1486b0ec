// SPDX-License-Identifier: Apache-2.0
#include "tools/render/sight.hpp"

#include "dsp/core/error.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

namespace tactus::render {

namespace {

constexpr double plain_screen_height = 0.3;  // m, without a display file

}  // namespace

display::StereoMode parse_stereo(const std::string& text) {
    if (const auto mode = display::stereo_of_name(text)) return *mode;
    throw Error(fmt::format(
        "--stereo must be one of {}, not '{}'{}", fmt::join(display::stereo_names, ", "), text,
        did_you_mean(text, std::vector<std::string>(display::stereo_names.begin(), display::stereo_names.end()))));
}

Vec3 parse_offset(const std::string& text) {
    if (text == "none") return Vec3(0.0);
    if (text == "study") return {0.30, 0.0, 0.0};
    try {
        return display::parse_vector(text, "mm");
    } catch (const Error& error) {
        throw Error(fmt::format("an offset must be none, study or three lengths such as \"0 mm, 0 mm, 0 mm\": {}",
                                error.message()));
    }
}

Sight::Sight(const SightChoice& choice) : stereo(parse_stereo(choice.stereo)), head(choice.head) {
    if (!choice.display.empty()) use_display(choice.display);
    if (choice.offset.empty()) return;
    if (!file_) throw Error("--offset needs --display, because it shifts the picture against the haptic position");
    set_offset(parse_offset(choice.offset));
}

void Sight::use_display(const std::filesystem::path& path) {
    if (path.empty()) file_.reset();
    else file_ = display::load_display_file(run::find_display(path.string()));
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
    if (file_ && place_) ports.insert(ports.end(), {place_->device, place_->frame, place_->scale});
    return ports;
}

void Sight::update(const observe::Observer& observer) {
    warnings_.clear();
    if (!head.empty()) {
        const auto seen = observer.latest<Pose>(head);
        if (!seen) warnings_.push_back(fmt::format("there is no pose output '{}' for the head", head));
        else if (!is_valid(seen->value))
            warnings_.push_back(fmt::format("{} is not a valid pose: the head stays", head));
        else head_pose_ = seen->value * (file_ ? file_->eyes_in_head : Pose{});
    } else head_pose_.reset();
    if (!file_ || !place_) return;
    const auto hand = observer.latest<Pose>(place_->device), frame = observer.latest<Pose>(place_->frame);
    const auto scale = observer.latest<double>(place_->scale);
    // All values are of one instant: otherwise a moving hand would shake the whole scene.
    if (!hand || !frame || !scale || hand->when != frame->when || hand->when != scale->when) return;
    if (!is_valid(hand->value) || !is_valid(frame->value) || !(scale->value > 0.0)) return;
    to_device_ = Mat3(glm::mat3_cast(glm::conjugate(frame->value.orientation))) / scale->value;
    shift_to_device_ = hand->value.position - to_device_ * frame->value.position;
}

display::StereoMode Sight::mode_of(std::size_t screen) const {
    if (!file_) return stereo;
    const display::ScreenSettings& way = file_->screens[screen];
    if (way.eye || way.eyes != display::ScreenEyes::both) return display::StereoMode::mono;
    return way.stereo.value_or(stereo);
}

std::optional<double> Sight::aspect_of(std::size_t screen) const {
    if (!file_) return std::nullopt;
    const display::Screen& seen = file_->geometry.screens[screen];
    return glm::length(seen.right()) / glm::length(seen.up());
}

display::Flip Sight::text_of(std::size_t screen) const {
    if (!file_ || !file_->geometry.is_mirrored(screen)) return display::Flip::none;
    const Vec3 up = file_->geometry.screens[screen].up(), normal = file_->geometry.mirror->normal;
    const Pose head_now = head_pose_.value_or(file_->geometry.place_before(screen, file_->head_away));
    const double along = glm::dot(up - 2.0 * glm::dot(up, normal) * normal, head_now.rotate({0.0, 1.0, 0.0}));
    return along < 0.0 ? display::Flip::upside_down : display::Flip::left_right;
}

display::DisplayGeometry Sight::geometry_now() const {
    display::DisplayGeometry geometry = file_->geometry;
    if (offset_) geometry.visuo_haptic_offset = *offset_;
    const Mat3 device = Mat3(glm::mat3_cast(geometry.haptic_world.orientation)) * geometry.haptic_stretch;
    geometry.haptic_world = {geometry.haptic_world.position + device * shift_to_device_, {1.0, 0.0, 0.0, 0.0}};
    geometry.haptic_stretch = device * to_device_;
    return geometry;
}

std::vector<Vec3> Sight::eyes_for(std::size_t screen, const display::DisplayGeometry& geometry) const {
    const display::ScreenSettings& way = file_->screens[screen];
    if (way.eye) return {*way.eye};
    const Pose at = head_pose_.value_or(geometry.place_before(0, file_->head_away));
    const display::Eyes eyes = display::eyes_of(at, geometry.between_eyes);
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
    if (!file_ && (head.empty() || !head_pose_)) return display::views_of(camera, scene, width, height, mode);
    last_.resize(screens());
    std::vector<display::ScreenView> seen;
    try {
        if (file_) {
            const display::DisplayGeometry geometry = geometry_now();
            for (const Vec3& eye : eyes_for(screen, geometry)) seen.push_back(geometry.view(screen, eye, scene));
        } else {
            // The scene in true size, centred in the screen, with the camera's orientation.
            const double halves = mode == display::StereoMode::side_by_side ? 0.5 : 1.0;
            const double high = 0.5 * plain_screen_height, wide = high * halves * width / height;
            display::DisplayGeometry geometry;
            geometry.screens = {{{-wide, -high, 0.0}, {wide, -high, 0.0}, {-wide, high, 0.0}}};
            const Quat turned = glm::conjugate(camera.orientation);
            geometry.haptic_world = {-(turned * camera.target), turned};
            seen = geometry.views(*head_pose_, mode != display::StereoMode::mono, scene);
        }
        last_[screen] = seen;
    } catch (const Error& error) {
        const std::string name = file_ ? file_->screens[screen].name : "the screen";
        warnings_.push_back(fmt::format("{}: {}; its picture stays", name, error.message()));
        if (last_[screen].empty()) return display::views_of(camera, scene, width, height, mode);
    }
    return display::views_of(last_[screen], width, height, mode, text_of(screen));
}

void add_legend(display::Image& image, const display::Legend& legend, std::span<const display::DrawnView> views,
                display::Flip flip) {
    // Views that share a picture share the legend.
    for (std::size_t i = 0; i < views.size(); ++i) {
        const display::DrawnView& view = views[i];
        const bool is_drawn =
            std::ranges::any_of(views.first(i), [&](const display::DrawnView& v) { return v.x == view.x; });
        if (!is_drawn) display::add_legend(image, legend, view.x, view.width, flip);
    }
}

}  // namespace tactus::render
