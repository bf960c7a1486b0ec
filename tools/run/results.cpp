// SPDX-License-Identifier: Apache-2.0
#include "tools/run/results.hpp"

#include "assets/bone/bone.hpp"
#include "assets/segmentation/seeds_file.hpp"
#include "devices/display/legend.hpp"
#include "devices/display/picture_maker.hpp"
#include "devices/display/png.hpp"
#include "dsp/core/error.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

namespace tactus::run {

namespace {

Vec3 vector_of(const Report& report, const char* key, const Vec3& otherwise) {
    const auto site = report.sections.find("site");
    if (site == report.sections.end() || !site->second.contains(key)) return otherwise;
    const auto* list = std::get_if<std::vector<double>>(&site->second.at(key));
    return list && list->size() == 3 ? Vec3((*list)[0], (*list)[1], (*list)[2]) : otherwise;
}

/// Camera in front of the cut and slightly to the side, so that the depth of the kerf is visible.
Vec3 towards_site(const Report& report) {
    const Vec3 normal = vector_of(report, "normal", Vec3(0.0, -1.0, 0.3));
    const Vec3 stroke = vector_of(report, "stroke", Vec3(1.0, 0.0, 0.0));
    return glm::normalize(-normal - 0.55 * glm::cross(normal, stroke) - 0.45 * stroke);
}

/// Box around the place of the cut; empty when the report names none.
display::Bounds site_box(const Report& report) {
    display::Bounds box;
    const double none = std::numeric_limits<double>::quiet_NaN();
    const Vec3 at = vector_of(report, "position_mm", Vec3(none)) * 1e-3;
    if (!is_finite(at)) return box;
    // The diagonal is 35 mm: a cut that is shorter is seen whole.
    constexpr double half = 10e-3;
    box.add(at - half);
    box.add(at + half);
    return box;
}

display::Image picture_of(const bone::Bone& bone, const std::string& name, const Vec3& towards,
                          const display::Bounds& site) {
    constexpr int width = 1280, height = 800;
    display::PictureMaker maker(width, height);
    display::MeshPool& meshes = maker.renderer().meshes();
    display::Picture picture;
    picture.meshes = {{meshes.make(), {}, 1.0, true}};
    const volume::BoneEditor editor(bone.distance, bone.density, {.max_dirty = 1, .max_versions = 1});
    geometry::BrickSurface mesher;
    geometry::SurfacePatch patch;
    for (int b = 0; b < editor.layout().brick_count(); ++b) {
        mesher.make(editor.current(), static_cast<std::uint32_t>(b), patch);
        meshes.set_part(picture.meshes.front().mesh, static_cast<std::uint32_t>(b), patch);
        picture.bounds.add(display::bounds_of(patch));
    }
    display::OrbitCamera camera;
    camera.look_along(towards, std::abs(towards.z) < 0.9 ? Vec3(0.0, 0.0, 1.0) : Vec3(0.0, -1.0, 0.0));
    const bool is_close = !site.empty() && site.radius() < picture.bounds.radius();
    camera.fit(is_close ? site : picture.bounds, static_cast<double>(width) / height, is_close ? 1.1 : 1.2);
    display::Image image =
        maker.draw(picture, display::views_of(camera, picture.bounds, width, height, display::StereoMode::mono));
    display::Legend legend;
    legend.title = is_close ? name + ", around the cut" : name;
    legend.scales.push_back(display::density_scale(mesher.colours));
    display::add_legend(image, legend);
    display::add_scale_bar(image, camera.metres_per_pixel(height));
    return image;
}

/// Strokes of all brushes; those of one name together.
std::vector<segmentation::SeedLabel> seeds_of(const Report& report) {
    std::vector<segmentation::SeedLabel> labels;
    for (const auto& [name, result] : report.results) {
        const auto* painted = std::any_cast<segmentation::SeedLabel>(&result);
        if (!painted || painted->strokes.empty()) continue;
        const auto known = std::ranges::find(labels, painted->name, &segmentation::SeedLabel::name);
        if (known == labels.end()) labels.push_back(*painted);
        else known->strokes.insert(known->strokes.end(), painted->strokes.begin(), painted->strokes.end());
    }
    return labels;
}

}  // namespace

WrittenFiles write_results(const Report& report, const std::filesystem::path& folder, bool with_pictures) {
    WrittenFiles written;
    std::vector<std::string> bones;
    const auto write = [&written](std::vector<std::string>& names, const std::string& name, const auto& how) {
        try {
            how();
            names.push_back(name);
        } catch (const Error& error) {
            written.losses.emplace_back(error.what());
        }
    };
    // The bone is written before its picture, which can be made again.
    for (const auto& [name, result] : report.results)
        if (const auto* bone = std::any_cast<std::shared_ptr<const bone::Bone>>(&result))
            write(bones, name + ".vdb", [&, file = folder / (name + ".vdb")] { bone::save_bone(**bone, file); });
    if (const std::vector<segmentation::SeedLabel> seeds = seeds_of(report); !seeds.empty())
        write(written.names, "seeds.json", [&] { segmentation::write_seeds(seeds, folder / "seeds.json"); });
    for (const auto& [name, result] : report.results) {
        const auto* bone = std::any_cast<std::shared_ptr<const bone::Bone>>(&result);
        if (!bone || !with_pictures) continue;
        display::Image picture;
        try {
            picture = picture_of(**bone, name, towards_site(report), site_box(report));
        } catch (const Error& error) {
            say(stderr, fmt::format("tactus: no picture of the {}: {}\n", name, error.what()));
            continue;
        }
        write(written.names, name + ".png", [&] { display::write_png(picture, (folder / (name + ".png")).string()); });
    }
    written.names.insert(written.names.end(), bones.begin(), bones.end());
    return written;
}

}  // namespace tactus::run
