// SPDX-License-Identifier: Apache-2.0
// All bodies of a scene as one obstacle.
#pragma once

#include "dsp/coupling/scene.hpp"
#include "dsp/rope/bone_field.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace tactus::rope {

/// The union of up to sixteen distance fields. A field is used only at positions within its grid; where there is none,
/// the distance is `far`, without a normal. Nothing allocates.
class SceneBones final : public Obstacle {
public:
    void clear() noexcept { count_ = 0; }
    /// `map` must outlive its use here; `pose` is that of its frame.
    void add(const contact::Voxmap& map, const Pose& pose) noexcept {
        if (count_ == parts_.size()) return;
        Part& part = parts_[count_++];
        part.map = &map;
        part.pose = pose;
        part.back = pose.inverse();
        const auto& size = map.grid.size;
        part.low = map.grid.origin;
        part.high = map.grid.origin + Vec3(size[0] - 1, size[1] - 1, size[2] - 1) * map.grid.spacing;
    }

    double distance(const Vec3& place, Vec3& normal) const noexcept override {
        double least = far;
        normal = Vec3(0.0);
        for (std::size_t n = 0; n < count_; ++n) {
            const Part& part = parts_[n];
            const Vec3 local = part.back.apply(place);
            if (part.outside(local) > 0.0) continue;
            const volume::Sample at = part.map->smooth_sample(local);
            const double steep = glm::length(at.gradient);
            const double value = steep > 1e-6 ? at.value / steep : at.value;
            if (value >= least) continue;
            least = value;
            normal = steep > 1e-6 ? part.pose.rotate(at.gradient / steep) : Vec3(0.0);
        }
        return least;
    }

    double free_way(const Vec3& place, double /*now*/, double near) const noexcept override {
        double way = far;
        for (std::size_t n = 0; n < count_ && way > 0.0; ++n) {
            const Part& part = parts_[n];
            const Vec3 local = part.back.apply(place);
            const double outside = part.outside(local);
            if (outside >= way) continue;
            way = std::min(way, std::max(outside, way_in(part, local, near, way)));
        }
        return way;
    }

private:
    static constexpr double far = 10e-3;  // m: largest distance returned

    struct Part {
        const contact::Voxmap* map = nullptr;
        Pose pose, back;
        Vec3 low{0.0}, high{0.0};

        double outside(const Vec3& local) const noexcept { return glm::length(local - glm::clamp(local, low, high)); }
    };

    /// See BoneField::free_way.
    static double way_in(const Part& part, const Vec3& local, double near, double most) noexcept {
        const double least = std::max(near, 0.0) * std::numbers::sqrt3 * part.map->steepness;
        for (const double way : {8e-3, 4e-3, 2e-3, 1e-3, 0.5e-3})
            if (way <= most && part.map->min_within(local, way) > least) return way;
        return 0.0;
    }

    std::array<Part, coupling::Scene::max_objects> parts_;
    std::size_t count_ = 0;
};

}  // namespace tactus::rope
