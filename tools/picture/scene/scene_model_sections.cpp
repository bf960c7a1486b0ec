// SPDX-License-Identifier: Apache-2.0
// What sections of bones and bodies show: their density.
#include "tools/picture/scene/scene_model.hpp"
#include "tools/picture/scene/section_grey.hpp"

#include <algorithm>

namespace tactus::picture {

void SceneModel::show_density(bool wanted, bool waits) {
    has_density_ = wanted;
    waits_for_files_ = waits;
}

bool SceneModel::is_reading_density() const {
    return std::ranges::any_of(densities_, [](const auto& known) { return !known.second.is_read; });
}

std::span<const volume::Grid> SceneModel::densities_of(const std::string& path) {
    Densities& known = densities_[path];
    if (known.is_read) return known.grids;
    if (!known.reading.is_busy()) known.reading.begin(study::Lane::scene, [path] { return read_densities(path); });
    if (!waits_for_files_ && !known.reading.is_ready()) return {};
    known.grids = known.reading.take();
    known.is_read = true;
    return known.grids;
}

/// The scan that a node declares for the scene, or for the output that is wired to the slot of the body.
void SceneModel::find_scan(BodyMesh& mesh, const SceneOutline::Bodies& scene, std::size_t place) {
    if (!has_density_ || mesh.has_scan) return;
    for (const SceneOutline::Scan& scan : outline_.scans) {
        const bool is_scene = scan.port == scene.port,
                   is_slot = place < scene.bodies.size() && scan.port == scene.bodies[place];
        if (!is_scene && !is_slot) continue;
        const std::span<const volume::Grid> grids = densities_of(scan.path);
        if (!densities_.at(scan.path).is_read) return;
        const std::size_t number = is_slot ? 0 : place;
        if (number < grids.size()) mesh.scan = renderer_.scans().make(grids[number], section_grey);
        break;
    }
    mesh.has_scan = true;
}

/// Of the mesh that was shown last.
void SceneModel::show_scan(int scan, const Pose& to_scan) {
    if (!has_density_ || scan < 0) return;
    picture_.meshes.back().scan = scan;
    picture_.meshes.back().to_scan = to_scan;
    shows_grey_ = true;
}

}  // namespace tactus::picture
