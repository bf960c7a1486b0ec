// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/burr.hpp"

#include "dsp/saw/hand_limits.hpp"
#include "dsp/saw/lag_norm.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace tactus::saw {

namespace {

constexpr int max_moves = 12;
constexpr std::size_t probes = 29;
constexpr double edge = 0.4e-3;  // m

/// The 26 directions of a cube's faces, edges and corners.
const std::array<Vec3, 26>& cube_directions() {
    static const std::array<Vec3, 26> all = [] {
        std::array<Vec3, 26> made;
        std::size_t n = 0;
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z)
                    if (x != 0 || y != 0 || z != 0) made[n++] = glm::normalize(Vec3(x, y, z));
        return made;
    }();
    return all;
}

constexpr std::size_t disc_count = 32;

/// Directions of a half ball about z that share its disc equally: a sunflower's spiral.
const std::array<Vec3, disc_count>& disc_directions() {
    static const std::array<Vec3, disc_count> all = [] {
        std::array<Vec3, disc_count> made;
        for (std::size_t n = 0; n < disc_count; ++n) {
            const double square = (static_cast<double>(n) + 0.5) / static_cast<double>(disc_count);
            const double angle = std::numbers::pi * (3.0 - std::sqrt(5.0)) * static_cast<double>(n);
            const double aside = std::sqrt(square);
            made[n] = {aside * std::cos(angle), aside * std::sin(angle), std::sqrt(1.0 - square)};
        }
        return made;
    }();
    return all;
}

}  // namespace

Burr::Burr(const BurrShape& shape, double stiffness)
    : shape_(shape),
      stiffness_(stiffness),
      shaft_(shape.shaft_radius > 0.0 ? shaft_body(shape.radius, shape.shaft_radius, shape.shaft_length)
                                      : std::vector<BodyPoint>{},
             stiffness) {}

/// Directions in which the ball touches bone, and the free distance otherwise.
struct Burr::Touch {
    std::array<Vec3, probes> towards;
    std::size_t count = 0;
    double density = 0.0, clear = 1.0;
};

Burr::Touch Burr::touch(const volume::BoneSnapshot& bone, const Vec3& lag, double ahead) const noexcept {
    Touch touch;
    std::array<Vec3, probes> looks;
    std::size_t count = 0;
    for (const Vec3& direction : cube_directions()) looks[count++] = direction;
    looks[count++] = glm::normalize(lag);
    const volume::Sample here = bone.sample(at_);
    const double slope = glm::length(here.gradient);
    if (slope > 0.1) looks[count++] = -here.gradient / slope;
    double sum = 0.0;
    const auto add = [&](const Vec3& direction, double density) {
        touch.towards[touch.count++] = direction;
        const double weight = std::max(glm::dot(direction, lag), 0.0);
        touch.density += weight * density;
        sum += weight;
    };
    for (std::size_t n = 0; n < count; ++n) {
        const Vec3 there = at_ + looks[n] * (shape_.radius + ahead);
        const double d = bone.value(there);
        touch.clear = std::min(touch.clear, d + ahead);
        if (d > -0.5 * ahead) continue;
        const double density = bone.density(there);
        if (!(density >= 1.0)) continue;  // bone without density does not resist, as for the teeth of a saw
        add(looks[n], density);
    }
    // An edge of bone between the places that were sampled, before it is deeper than a part of the tool may be.
    if (touch.count == 0 && slope > 0.1 && here.value < shape_.radius - std::max(edge, 2.0 * ahead)) {
        const Vec3 inwards = -here.gradient / slope;
        const double density = bone.density(at_ + inwards * (std::max(here.value, 0.0) + ahead));
        if (density >= 1.0) add(inwards, density);
    }
    touch.density = sum > 0.0 ? touch.density / sum : 0.0;
    return touch;
}

/// As far as bone allows, in a tick in which the hand moved by `moved` m; returns the density of the bone that stops it, 0: none.
double Burr::follow(const volume::BoneSnapshot& bone, bool running, double moved) noexcept {
    const Vec3& spacing = bone.layout().spacing;
    const double voxel = std::max({spacing.x, spacing.y, spacing.z, 1e-6}), ahead = 0.25 * voxel;
    double density = 0.0;
    // The moves below end after some voxels: too few for a fast hand.
    if (moved > voxel && is_way_free(bone, at_, target_, shape_.radius, ahead)) {
        at_ = target_;
        return 0.0;
    }
    for (int move = 0; move < max_moves; ++move) {
        const Vec3 lag = target_ - at_;
        const double distance = glm::length(lag);
        if (distance < 1e-9) return 0.0;
        if (bone.value(at_) > shape_.radius + distance + voxel) {
            at_ = target_;
            return 0.0;
        }
        const Touch now = touch(bone, lag, ahead);
        Vec3 way = lag;
        for (int pass = 0; pass < 3; ++pass)
            for (std::size_t n = 0; n < now.count; ++n)
                way -= now.towards[n] * std::max(glm::dot(way, now.towards[n]), 0.0);
        const bool blocked = glm::dot(way - lag, way - lag) > 1e-18;
        density = blocked ? now.density : 0.0;
        const double length = glm::length(way);
        const double held = blocked && !running ? dry_friction * glm::length(lag - way) : 0.0;
        if (length - held < 1e-9) return density;
        const double step = std::min({length - held, blocked ? 0.5 * voxel : std::max(now.clear, 0.25 * voxel), 1e-3});
        const Vec3 next = at_ + way * (step / length);
        const Vec3 left = target_ - next;
        if (glm::dot(left, left) >= distance * distance) return density;
        at_ = next;
    }
    return density;
}

BurrContact Burr::step(const volume::BoneSnapshot& bone, const Pose& pose, const Drive& drive,
                       const CuttingLaw& law) noexcept {
    BurrContact contact;
    fresh_ = false;
    if (!is_valid(pose) || glm::length(pose.position) > 1e3 || !(drive.dt > 0.0)) {
        hold_.drop();
        stuck_ = false;
        return contact;
    }
    const bool was_waiting = hold_.state() == HoldState::waiting;
    const bool jumped = !was_waiting && is_jump(last_, pose, shape_.radius + shape_.shaft_length, drive.dt);
    if (jumped) {
        at_ += pose.position - target_;
        shaft_.carry(pose);
    }
    hold_.tick(drive.dt, drive.release || jumped, stuck_,
               [&] { return bone.value(pose.position) >= shape_.radius && shaft_.is_free(bone, pose); });
    last_ = pose;
    const double moved = glm::length(pose.position - target_);
    target_ = pose.position;
    contact.state = hold_.state();
    if (hold_.state() == HoldState::engaged) {
        if (was_waiting) {
            at_ = target_;
            fresh_ = true;
            shaft_.seat(pose);
        }
        cut(bone, drive, follow(bone, drive.running, moved), law, contact);
        shaft_.follow(bone, pose, drive.running);
    } else if (!was_waiting) {
        at_ = target_ + (at_ - target_) * hold_.kept();
        shaft_.release(pose, hold_.kept());
    } else {
        stuck_ = false;
        return contact;
    }
    const Vec3 lag = target_ - at_;
    const double distance = glm::length(lag);
    contact.wrench.force = lag * (-stiffness_ * saturation_share(distance * distance));
    contact.wrench.torque = glm::cross(at_ - pose.position, contact.wrench.force);
    contact.load = glm::length(contact.wrench.force);
    const ToolBody::Sum shaft = shaft_.push(pose.position);
    contact.wrench = contact.wrench + shaft.wrench;
    contact.magnitudes = contact.load + shaft.magnitudes;
    contact.lag = std::max(distance, shaft.lag);
    contact.touches = contact.magnitudes > 0.0;
    stuck_ = contact.lag >= max_lag || glm::dot(contact.wrench.force, pose.rotate({0, 1, 0})) > 0.0 ||
             (contact.touches && drive.rendered < 1.0);
    return contact;
}

/// Of the circle in which the ball, seen along its force, is in bone: the chord of a flute that passes through its middle.
double Burr::width_in(const volume::BoneSnapshot& bone) const noexcept {
    const Vec3 ahead = glm::normalize(target_ - at_), size = glm::abs(ahead);
    const Vec3 axis = size.x <= size.y && size.x <= size.z ? Vec3(1.0, 0.0, 0.0)
                      : size.y <= size.z                   ? Vec3(0.0, 1.0, 0.0)
                                                           : Vec3(0.0, 0.0, 1.0);
    const Vec3 u = glm::normalize(glm::cross(ahead, axis)), v = glm::cross(ahead, u);
    const Vec3& spacing = bone.layout().spacing;
    const double reach = 0.25 * std::max({spacing.x, spacing.y, spacing.z, 1e-6});
    double inside = 0.0;
    for (const Vec3& d : disc_directions())
        if (bone.value(at_ + (u * d.x + v * d.y + ahead * d.z) * (shape_.radius + reach)) < -0.5 * reach) ++inside;
    return 2.0 * shape_.radius * std::sqrt(std::max(inside, 1.0) / static_cast<double>(disc_count));
}

/// The ball advances in bone of that density, which stops it; 0: none does.
void Burr::cut(const volume::BoneSnapshot& bone, const Drive& drive, double density, const CuttingLaw& law_of_edge,
               BurrContact& into) noexcept {
    const Vec3 lag = target_ - at_;
    const double distance = glm::length(lag);
    // What rounding leaves of a lag is no contact.
    if (!(density > 0.0) && distance < 1e-8) at_ = target_;
    if (!drive.running || !(drive.rate > 0.0) || !(drive.rendered > 0.0)) return;
    if (!(density >= 1.0) || !(distance > 1e-12)) return;
    into.width = width_in(bone);
    const CuttingLaw law = law_of_edge.with_edge(into.width);
    const double scale = law.reference_density / density;
    const double left = left_after_cut(law, distance, shape_.flutes * drive.rate * drive.dt, [&](double stretch) {
        const double stiff = drive.rendered * stiffness_ * scale * saturation_share(stretch * stretch);
        return std::pair{stiff * stretch, stiff};
    });
    into.feed = (distance - left) / drive.dt;
    at_ += lag * ((distance - left) / distance);
    into.along = law.along(stiffness_ * left * saturation_share(left * left) * scale) / scale;
}

void Burr::fill(carve::CutFront& front, const Pose& pose, bool running) const noexcept {
    front.pose = pose;
    front.kerf = 2.0 * shape_.radius;
    front.pitch = shape_.radius;
    front.count = 2;
    front.running = running ? 1 : 0;
    front.seated = hold_.state() == HoldState::engaged ? 3u : 0u;
    front.fresh = fresh_ ? 3u : 0u;
    front.place(0, at_);
    front.place(1, at_);
}

}  // namespace tactus::saw
