// SPDX-License-Identifier: Apache-2.0
// Cost of remeshing a bone while it is sawn (only changed bricks, compared with OpenVDB's volumeToMesh of the whole
// bone; processor time), and of drawing a large bone.
#include "assets/file/json.hpp"
#include "dsp/carve/carver.hpp"
#include "dsp/core/error.hpp"
#include "dsp/geometry/brick_surface.hpp"
#include "dsp/geometry/coarse_surface.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/window/large_bone.hpp"
#include "tools/bench/window/peer.hpp"
#include "tools/bench/window/quantile.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <time.h>
#include <algorithm>
#include <cmath>
#include <optional>

namespace tactus::bench {

namespace {

using file::Json;

/// Processor time of all threads, ms; other load on the machine does not count.
double now_ms() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// A shaft of 24 mm with a cortex of 3 mm around a porous core, along z. `fineness` 2: voxels half as large.
void make_shaft(volume::Grid& distance, volume::Grid& density, double fineness) {
    const double voxel = 0.3e-3 / fineness;
    const auto samples = [&](double cells) { return static_cast<int>(std::lround(cells * fineness)) + 1; };
    distance = {{samples(96), samples(96), samples(256)}, Vec3(-14.4e-3, -14.4e-3, -38.4e-3), Vec3(voxel), {}};
    distance.values.resize(distance.count());
    density = distance;
    for (int k = 0; k < distance.size[2]; ++k)
        for (int j = 0; j < distance.size[1]; ++j)
            for (int i = 0; i < distance.size[0]; ++i) {
                const Vec3 at = distance.position(i, j, k);
                const double across = std::hypot(at.x, at.y) - 12e-3 - 0.4e-3 * std::sin(300.0 * at.z),
                             end = std::abs(at.z) - 36e-3;
                distance.at(i, j, k) = static_cast<float>(std::max(across, end));
                density.at(i, j, k) = across < -3e-3 ? 400.0f : 1800.0f;
            }
}

}  // namespace

int bench_view(const BenchChoice& choice) {
    volume::Grid distance, density;
    make_shaft(distance, density, 1.0);
    std::vector<double> cuts_ms, bricks, peer_ms, whole_ms;
    std::size_t triangles = 0, peer_triangles = 0;
    for (int round = 0; round < choice.rounds; ++round) {
        volume::BoneEditor editor(distance, density, {.band = 2.2e-3});
        carve::Carver carver;
        carve::CarveSettings settings;
        settings.speed = 5e-3;
        carver.prepare(editor, settings);
        geometry::BrickSurface mesher;
        geometry::CoarseSurface coarse;
        const geometry::SurfaceGrid grid{editor.layout().origin, editor.layout().spacing, volume::brick_cells};
        std::vector<geometry::SurfacePatch> surface(static_cast<std::size_t>(editor.layout().brick_count()));
        double begin = now_ms();
        for (std::uint32_t b = 0; b < surface.size(); ++b) mesher.make(editor.current(), b, surface[b]);
        whole_ms.push_back(now_ms() - begin);
        constexpr int ticks = 120, poses = 17;  // 2 s at 60 Hz, the blade at 1 kHz
        for (int tick = 0; tick < ticks; ++tick) {
            std::vector<carve::CarveSample> path;
            for (int n = 0; n < poses; ++n) {
                const double depth = -12.5e-3 + 5e-3 * (tick + n / double(poses)) / 60.0;
                // The blade's y axis points into the bone, along the scene's y; x is across the shaft.
                path.push_back({{{0.0, depth, 0.0}, {1.0, 0.0, 0.0, 0.0}}, 1e-3, 7.0, 228.0, true});
            }
            carver.update(editor, path);
            const volume::BoneSnapshot bone = editor.publish();
            begin = now_ms();
            for (const std::uint32_t b : editor.changed_bricks()) {
                mesher.make(bone, b, surface[b]);
                coarse.make(surface[b], grid);
            }
            if (!editor.changed_bricks().empty()) {
                cuts_ms.push_back(now_ms() - begin);
                bricks.push_back(static_cast<double>(editor.changed_bricks().size()));
            }
            editor.reclaim(bone.version);
        }
        triangles = 0;
        for (const geometry::SurfacePatch& patch : surface) triangles += patch.triangles.size() / 3;
        const ViewGridPeer peer(volume::to_grid(editor.current()));
        begin = now_ms();
        peer_triangles = peer.triangles();
        peer_ms.push_back(now_ms() - begin);
    }
    if (cuts_ms.empty()) throw Error("the saw of the benchmark did not cut");
    std::optional<PictureCosts> pictures;
    try {
        make_shaft(distance, density, 1.43);
        pictures = picture_costs(distance, density, choice.rounds);
    } catch (const Error& error) {
        fmt::print(stderr, "tactus: pictures are not measured: {}\n", error.what());
    }
    Json result{{"remesh_median_ms", quantile(cuts_ms, 0.5)},
                {"remesh_p99_ms", quantile(cuts_ms, 0.99)},
                {"remesh_worst_ms", quantile(cuts_ms, 1.0)},
                {"bricks_median", quantile(bricks, 0.5)},
                {"bricks_most", quantile(bricks, 1.0)},
                {"whole_ms", quantile(whole_ms, 0.0)},
                {"triangles", triangles},
                {"openvdb_volume_to_mesh_ms", quantile(peer_ms, 0.0)},
                {"openvdb_triangles", peer_triangles}};
    if (pictures) {
        result["picture_bone_triangles"] = pictures->triangles;
        for (const PictureCost& cost : pictures->pictures)
            result["pictures"].push_back({{"what", cost.what}, {"ms", cost.ms}, {"triangles", cost.triangles}});
    }
    if (choice.json) {
        fmt::print("{}\n", result.dump(2));
        return done;
    }
    fmt::print(
        "remesh of what a 60 Hz cut changed   {:7.2f} ms median, {:.2f} ms p99, {:.2f} ms worst; {:.0f} bricks, {:.0f} "
        "at "
        "most\n",
        quantile(cuts_ms, 0.5), quantile(cuts_ms, 0.99), quantile(cuts_ms, 1.0), quantile(bricks, 0.5),
        quantile(bricks, 1.0));
    fmt::print("all bricks                           {:7.2f} ms, {} triangles with normals and colours\n",
               quantile(whole_ms, 0.0), triangles);
    fmt::print("OpenVDB volumeToMesh of the whole    {:7.2f} ms, {} triangles, no normals\n", quantile(peer_ms, 0.0),
               peer_triangles);
    if (!pictures) return done;
    fmt::print("\npictures of a bone of {} triangles, {} x {}\n", pictures->triangles, pictures->width,
               pictures->height);
    for (const PictureCost& cost : pictures->pictures)
        fmt::print("  {:<18} {:7.1f} ms, {} triangles\n", cost.what, cost.ms, cost.triangles);
    return done;
}

Verb view_verb() {
    return {"view", "time to remesh the changed bricks of a bone, compared with OpenVDB's volumeToMesh",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<BenchChoice>();
                verb.add("--rounds", choice->rounds, "number of rounds; more rounds reduce scatter")
                    .shows_default()
                    .range(1, 100);
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_view(*choice); };
            }};
}

}  // namespace tactus::bench
