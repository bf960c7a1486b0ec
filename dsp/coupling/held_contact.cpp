// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/held_contact.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::coupling {

namespace {

// A tree with four children per node has a third more nodes than leaves; some leaves are not full.
std::size_t nodes_of(std::size_t points) { return 2 * (points / contact::chunk_points + 1) + 64; }

/// Distance that every point of the shell can move without touching the map; computed from the upper levels of its
/// tree.
double clearance_of(const contact::ContactPair& pair, double enough) noexcept {
    constexpr std::size_t max_nodes = 96;
    const Pose into_map = pair.map_pose.inverse() * pair.shell_pose;
    const auto& nodes = pair.shell->nodes;
    const std::size_t count = std::min(nodes.size(), max_nodes);
    double least = enough;
    for (std::size_t n = 0; n < count && least > 0.0; ++n) {
        const contact::ShellNode& node = nodes[n];
        if (node.children > 0 && node.first_child + node.children <= count) continue;
        least = std::min(least, pair.map->min_within(into_map.apply(node.centre), node.radius) / pair.map->steepness);
    }
    return std::max(least, 0.0);
}

/// Greatest distance of a body's surface from its origin; without points the corners of its field count.
double extent_of(const Body& body) noexcept {
    if (body.shell) return body.shell->reach;
    if (!body.map) return 0.0;
    const volume::Grid& grid = body.map->grid;
    double most = 0.0;
    for (int corner = 0; corner < 8; ++corner)
        most = std::max(
            most, glm::length(grid.position((corner & 1) ? grid.size[0] - 1 : 0, (corner & 2) ? grid.size[1] - 1 : 0,
                                            (corner & 4) ? grid.size[2] - 1 : 0)));
    return most;
}

}  // namespace

HeldContact::HeldContact(std::size_t max_points) : kernel_(nodes_of(max_points)) {}

void HeldContact::set(const Scene& scene, int held, const Pose& grip, const contact::ContactLaw& law, bool both_ways,
                      std::size_t budget) noexcept {
    law_ = law;
    budget_ = budget;
    grip_ = grip;
    count_ = 0;
    reach_ = gyration2_ = measured_ = 0.0;
    safe_step_ = std::numeric_limits<double>::infinity();
    if (held < 0 || static_cast<std::size_t>(held) >= scene.count) return;
    const SceneObject& grasped = scene.objects[static_cast<std::size_t>(held)];
    const auto moves_along = [&](std::size_t i) {
        return i == static_cast<std::size_t>(held) || (grasped.unit >= 0 && scene.objects[i].unit == grasped.unit);
    };
    const Pose from_held = is_valid(grasped.pose) ? grasped.pose.inverse() : Pose{};
    for (std::size_t m = 0; m < scene.count; ++m) {
        const SceneObject& mine = scene.objects[m];
        if (!moves_along(m) || (m != static_cast<std::size_t>(held) && !is_valid(mine.pose))) continue;
        const Pose beside = m == static_cast<std::size_t>(held) ? Pose{} : from_held * mine.pose;
        measure(mine.body, grip * beside);
        for (std::size_t i = 0; i < scene.count; ++i)
            if (!moves_along(i) && is_valid(scene.objects[i].pose)) add(mine, beside, scene.objects[i], both_ways);
    }
}

void HeldContact::add(const SceneObject& mine, const Pose& beside, const SceneObject& other, bool both_ways) noexcept {
    const auto put = [&](const contact::ContactPair& pair) {
        beside_[count_] = beside;
        pairs_[count_++] = pair;
        const Vec3& voxel = pair.map->grid.spacing;
        safe_step_ = std::min(safe_step_, 0.5 * std::min({voxel.x, voxel.y, voxel.z}));
    };
    if (mine.body.shell && other.body.map) put({mine.body.shell, {}, other.body.map, other.pose, true});
    if (both_ways && other.body.shell && mine.body.map) put({other.body.shell, other.pose, mine.body.map, {}, false});
}

std::span<const contact::ContactPair> HeldContact::place(const Pose& handle) noexcept {
    const Pose body = handle * grip_;
    for (std::size_t i = 0; i < count_; ++i)
        (pairs_[i].shell_moves ? pairs_[i].shell_pose : pairs_[i].map_pose) = body * beside_[i];
    return std::span(pairs_).first(count_);
}

contact::ContactSum HeldContact::operator()(const Pose& handle, contact::ContactParts parts) noexcept {
    return kernel_(place(handle), handle.position, law_, budget_, parts);
}

double HeldContact::clearance(const Pose& handle) const noexcept {
    const Pose body = handle * grip_;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count_; ++i) {
        contact::ContactPair pair = pairs_[i];
        (pair.shell_moves ? pair.shell_pose : pair.map_pose) = body * beside_[i];
        least = std::min(least, clearance_of(pair, least));
        if (!(least > 0.0)) return 0.0;
    }
    return least;
}

void HeldContact::measure(const Body& body, const Pose& in_hand) noexcept {
    reach_ = std::max(reach_, extent_of(body) + glm::length(in_hand.position));
    if (!body.shell || body.shell->empty()) return;
    const Vec3 arm = in_hand.apply(body.shell->centroid);
    const double own = body.shell->gyration * body.shell->gyration + glm::dot(arm, arm);
    const auto points = static_cast<double>(body.shell->size());
    measured_ += points;
    gyration2_ += (own - gyration2_) * (points / measured_);
}

}  // namespace tactus::coupling
