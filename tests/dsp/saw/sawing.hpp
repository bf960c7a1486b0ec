// SPDX-License-Identifier: Apache-2.0
// A saw in a bone, both sides of the loop: the blade at the force's rate, the carver at 60 Hz.
#pragma once

#include "dsp/carve/carver.hpp"
#include "dsp/saw/saw_blade.hpp"
#include "dsp/volume/bricks.hpp"

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

namespace tactus::test {

/// Blade with its teeth down: y of the blade is −z.
inline const Quat teeth_down = glm::angleAxis(-0.5 * std::numbers::pi, Vec3(1.0, 0.0, 0.0));

struct BoneBox {
    Vec3 low{-0.006, -0.004, -0.008}, high{0.006, 0.004, 0.0};  ///< m, of the sampled box
    double voxel = 0.33e-3, density = 1800.0;
    double margin = 0.004;
};

/// A bone of the given distance, m, sampled around a box.
inline std::unique_ptr<volume::BoneEditor> bone_where(const BoneBox& box,
                                                      const std::function<double(const Vec3&)>& distance,
                                                      int versions = 3) {
    volume::Grid grid;
    grid.spacing = Vec3(box.voxel);
    grid.origin = box.low - Vec3(box.margin);
    const Vec3 size = (box.high - box.low + Vec3(2.0 * box.margin)) / box.voxel;
    grid.size = {static_cast<int>(size.x) + 2, static_cast<int>(size.y) + 2, static_cast<int>(size.z) + 2};
    grid.values.resize(grid.count());
    volume::Grid density = grid;
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                grid.at(i, j, k) = static_cast<float>(distance(grid.position(i, j, k)));
                density.at(i, j, k) = static_cast<float>(box.density);
            }
    return std::make_unique<volume::BoneEditor>(
        grid, density,
        volume::BoneEditorOptions{.band = 4.0 * box.voxel + 2e-3, .max_dirty = 600, .max_versions = versions});
}

inline std::unique_ptr<volume::BoneEditor> bone_block(const BoneBox& box) {
    return bone_where(box, [box](const Vec3& p) {
        const Vec3 q = glm::max(box.low - p, p - box.high);
        return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
    });
}

struct Sawing {
    volume::BoneEditor& bone;
    double rate = 1000.0;  ///< Hz of the blade
    double stiffness = 20e3;
    saw::SawShape shape;
    saw::CuttingLaw law;
    saw::Drive drive{true, 228.0, 1.0 / rate};
    saw::SawBlade blade{shape, stiffness};
    carve::Carver carver;
    std::vector<carve::CutFront> path;
    volume::BoneSnapshot read = bone.current();  ///< what the blade sees: one carving tick old
    const volume::BoneSnapshot* guide = nullptr;  ///< that nothing cuts
    double removed = 0.0;  ///< m³
    std::int64_t ticks = 0, carved = 0;

    explicit Sawing(volume::BoneEditor& bone_, double rate_ = 1000.0, double stiffness_ = 20e3,
                    const saw::SawShape& shape_ = {})
        : bone(bone_), rate(rate_), stiffness(stiffness_), shape(shape_) {
        carve::CarveSettings settings;
        settings.kerf = shape.kerf;
        settings.tooth_pitch = shape.pitch;
        settings.blade_length = (carve::CutFront::max_nodes - 1) * shape.pitch - settings.stroke;
        carver.prepare(bone, settings);
    }

    saw::SawContact step(const Pose& pose) {
        const saw::PlacedSolid placed{.solid = guide, .pose = {}};
        const saw::SawContact contact = blade.step(read, pose, drive, law, guide ? &placed : nullptr);
        carve::CutFront front;
        blade.teeth().fill(front, pose, drive.running);
        path.push_back(front);
        ++ticks;
        if (static_cast<double>(ticks) * 60.0 >= static_cast<double>(carved + 1) * rate) {
            ++carved;
            read = bone.publish();  // of the last carving tick
            bone.reclaim(read.version);
            removed += carver.update(bone, path).removed_m3;
            path.clear();
        }
        return contact;
    }
};

/// A hand without mass that pushes with a force, against a damper.
struct Pushing {
    Vec3 position{0.0, 0.0, 0.3e-3};
    double damping = 300.0;  // N·s/m

    void push(Sawing& sawing, double thrust, double seconds,
              const std::function<void(const saw::SawContact&)>& each = {}) {
        const auto ticks = static_cast<int>(std::lround(seconds * sawing.rate));
        for (int n = 0; n < ticks; ++n) {
            const saw::SawContact contact = sawing.step({position, teeth_down});
            if (each) each(contact);
            position.z -= (thrust - contact.thrust) / damping / sawing.rate;
        }
    }
};

}  // namespace tactus::test
