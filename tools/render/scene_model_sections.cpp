// SPDX-License-Identifier: Apache-2.0
// What sections of bones and bodies show: their density.
#include "tools/analysis/leaving.hpp"
#include "tools/render/scene_model.hpp"
#include "tools/render/section_grey.hpp"

#include <algorithm>
#include <utility>

namespace tactus::render {

void SceneModel::show_density(bool wanted, bool waits) {
    has_density_ = wanted;
    waits_for_files_ = waits;
}

bool SceneModel::is_reading_density() const {
    return has_density_ && (is_making_scan_ ||
                            std::ranges::any_of(densities_, [](const auto& known) { return !known.second.is_read; }));
}

std::span<const display::GreyImage> SceneModel::densities_of(const std::string& path) {
    Densities& known = densities_[path];
    if (known.is_read) return known.images;
    if (!known.reading.is_busy())
        known.reading.begin(analysis::Lane::scene, analysis::leaving([path] {
                                std::vector<display::GreyImage> images;
                                for (const volume::Grid& grid : read_densities(path))
                                    images.push_back(display::grey_image(grid, section_grey));
                                return images;
                            }));
    if (!waits_for_files_ && !known.reading.is_ready()) return {};
    // Not again with each picture, where it fails.
    known.is_read = true;
    known.images = known.reading.take();
    return known.images;
}

/// The graphics card copies it, which takes as long as a picture may.
bool SceneModel::make_scan(int& scan, const display::GreyImage& image) {
    if (image.empty()) return true;
    if (is_spread_ && has_made_scan_) {
        is_making_scan_ = true;
        return false;
    }
    scan = renderer_.scans().make(image);
    has_made_scan_ = true;
    return true;
}

/// A bone that is carved changes between two pictures: it is copied in pictures, and made grey beside them.
void SceneModel::find_scan(BoneMesh& bone, const observe::SeenBone& seen) {
    if (!has_density_ || bone.scan >= 0) return;
    is_making_scan_ = is_making_scan_ || is_spread_;
    if (bone.greying.is_ready()) {
        if (!has_made_scan_) make_scan(bone.scan, bone.greying.take());
        return;
    }
    if (bone.greying.is_busy()) return;
    while (!bone.density.add_layer(seen.snapshot()))
        if (!has_time()) return;
    auto grey = [copy = std::exchange(bone.density, {})] { return display::grey_image(copy.grid, section_grey); };
    if (is_spread_) bone.greying.begin(analysis::Lane::scene, analysis::leaving(std::move(grey)));
    else make_scan(bone.scan, grey());
}

/// The scan that a node declares for the scene, or for the output that is wired to the slot of the body.
void SceneModel::find_scan(BodyMesh& mesh, const SceneOutline::Bodies& scene, std::size_t place) {
    if (!has_density_ || mesh.has_scan) return;
    for (const SceneOutline::Scan& scan : outline_.scans) {
        const bool is_scene = scan.port == scene.port,
                   is_slot = place < scene.bodies.size() && scan.port == scene.bodies[place];
        if (!is_scene && !is_slot) continue;
        const std::span<const display::GreyImage> images = densities_of(scan.path);
        if (!densities_.at(scan.path).is_read) return;
        const std::size_t number = is_slot ? 0 : place;
        if (number < images.size() && !make_scan(mesh.scan, images[number])) return;
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

}  // namespace tactus::render
