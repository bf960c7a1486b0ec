// SPDX-License-Identifier: Apache-2.0
#include "dsp/carve/carver.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace tactus::carve {

namespace {

/// Adapts the edited bone to the Field of CarveCore.
struct EditedBone {
    volume::BoneEditor& bone;
    volume::BoneSnapshot now;

    double value(const Vec3& p) const noexcept { return now.value(p); }
    double density(const Vec3& p) const noexcept { return now.density(p); }
    // As BoneEditor::get, but inline: a stamp reads a sample in a few nanoseconds, and most samples need no more.
    float get(int i, int j, int k) const noexcept {
        const volume::BrickLayout& layout = now.layout();
        const int bx = std::min(i >> 3, layout.bricks[0] - 1), by = std::min(j >> 3, layout.bricks[1] - 1),
                  bz = std::min(k >> 3, layout.bricks[2] - 1);
        const float* const brick = now.root->distance[static_cast<std::size_t>(layout.brick_index(bx, by, bz))];
        return brick ? brick[volume::BrickLayout::sample_index(i - 8 * bx, j - 8 * by, k - 8 * bz)]
                     : static_cast<float>(layout.far);
    }
    bool set(int i, int j, int k, float d) noexcept { return bone.set(i, j, k, d); }
    std::array<int, 3> size() const noexcept { return bone.layout().size; }
    Vec3 origin() const noexcept { return bone.layout().origin; }
    Vec3 spacing() const noexcept { return bone.layout().spacing; }
};

constexpr double max_nodes = 4096.0;

void check(const CarveSettings& s) {
    const std::pair<std::string_view, double> positive[] = {{"blade length", s.blade_length},
                                                            {"kerf", s.kerf},
                                                            {"tooth pitch", s.tooth_pitch},
                                                            {"stroke", s.stroke},
                                                            {"reference force", s.reference_force},
                                                            {"reference rate", s.reference_rate},
                                                            {"reference density", s.reference_density},
                                                            {"depth of the distance field", s.depth}};
    for (const auto& [name, value] : positive) {
        if (!(value > 0.0) || !std::isfinite(value)) {
            throw Error(fmt::format("saw: {} is {}; give a positive number", name, value));
        }
    }
    if (!(s.speed >= 0.0) || !std::isfinite(s.speed)) {
        throw Error(fmt::format("saw: the speed of advance is {} m/s; give 0 or more", s.speed));
    }
    if (!std::isfinite(s.force_exponent) || s.force_exponent < 0.0) {
        throw Error(fmt::format("saw: the force exponent is {}; give 0 or more", s.force_exponent));
    }
    if (s.stroke < s.tooth_pitch) {
        throw Error(
            fmt::format("saw: a stroke of {:.3g} mm is shorter than the tooth pitch of {:.3g} mm and would leave "
                        "ridges; lengthen the stroke",
                        1e3 * s.stroke, 1e3 * s.tooth_pitch));
    }
    if ((s.blade_length + s.stroke) / s.tooth_pitch > max_nodes) {
        throw Error(fmt::format("saw: more than {} teeth; enlarge the tooth pitch", max_nodes));
    }
}

}  // namespace

void Carver::prepare(const volume::BoneEditor& bone, const CarveSettings& settings) {
    check(settings);
    if (bone.layout().far <= 0.5 * settings.kerf) {
        throw Error(
            fmt::format("saw: half the kerf, {:.3g} mm, exceeds the {:.3g} mm around the bone that are kept; use a "
                        "wider band",
                        500.0 * settings.kerf, 1e3 * bone.layout().far));
    }
    core_ = CarveCore(settings, bone.layout().spacing);
    removed_m3_ = 0.0;
    by_density_ = {};
}

CarveResult Carver::add(volume::BoneEditor& bone, CarveResult result) noexcept {
    result.dirty_bricks = bone.dirty();
    removed_m3_ += result.removed_m3;
    for (std::size_t n = 0; n < by_density_.size(); ++n) by_density_[n] += result.removed_by_density[n];
    return result;
}

CarveResult Carver::update(volume::BoneEditor& bone, std::span<const CarveSample> samples) noexcept {
    EditedBone field{bone, bone.working()};
    return add(bone, core_.update(field, samples));
}

CarveResult Carver::update(volume::BoneEditor& bone, std::span<const CutFront> fronts) noexcept {
    EditedBone field{bone, bone.working()};
    return add(bone, core_.update(field, fronts));
}

}  // namespace tactus::carve
