// SPDX-License-Identifier: Apache-2.0
#include "dsp/carve/carver.hpp"

#include "dsp/core/error.hpp"
#include "tests/dsp/carve/saw.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <memory>

using namespace tactus;
using namespace tactus::test;

namespace {

const Vec3 above{0, 0.0006, 0};

std::unique_ptr<volume::BoneEditor> bone_of(double density, int max_dirty = 512) {
    const DenseField field = block();
    volume::Grid rho = field.grid;
    std::ranges::fill(rho.values, static_cast<float>(density));
    return std::make_unique<volume::BoneEditor>(
        field.grid, rho, volume::BoneEditorOptions{.band = 0.003, .max_dirty = max_dirty, .max_versions = 4});
}

/// Cuts and publishes after every call, as a node does; versions are given back at once.
carve::CarveResult saw_through(carve::Carver& carver, volume::BoneEditor& editor,
                               std::span<const carve::CarveSample> samples, std::size_t per_call) {
    carve::CarveResult sum;
    for (std::size_t n = 0; n < samples.size(); n += per_call) {
        const auto part = carver.update(editor, samples.subspan(n, std::min(per_call, samples.size() - n)));
        sum.removed_m3 += part.removed_m3;
        sum.budget_hit |= part.budget_hit;
        editor.reclaim(editor.publish().version);
    }
    return sum;
}

}  // namespace

TEST_CASE("a saw cuts bricks as it cuts a dense grid") {
    const auto path = stroke(above, {0, -0.010, 0}, 1.0);
    DenseField field = block(Vec3(0.0), 600.0);
    carve::CarveCore dense({}, Vec3(voxel));
    const double volume = carve_through(dense, field, path).removed_m3;
    const auto editor = bone_of(600.0);
    carve::Carver carver;
    carver.prepare(*editor, {});
    const carve::CarveResult result = saw_through(carver, *editor, path, 17);
    CHECK(result.removed_m3 == Approx(volume).epsilon(1e-4));
    CHECK(carver.removed_m3() == Approx(result.removed_m3).epsilon(1e-12));
    CHECK_FALSE(result.budget_hit);
    const volume::Grid cut = volume::to_grid(editor->current());
    double worst = 0.0;
    for (std::size_t n = 0; n < cut.values.size(); ++n) {
        if (field.grid.values[n] > 0.0025f) continue;  // near the band bricks may not be stored
        worst =
            std::max(worst, std::abs(static_cast<double>(cut.values[n]) - static_cast<double>(field.grid.values[n])));
    }
    CHECK(worst < 1e-6);
}

TEST_CASE("the same path gives the same bits, and the same volume in other portions") {
    const auto path = stroke(above, {0.002, -0.004, 0.0003}, 0.8);
    std::vector<std::uint64_t> hashes;
    std::vector<double> volumes;
    for (const std::size_t per_call : {17, 17, 8, 33, 1}) {
        const auto editor = bone_of(400.0);
        carve::Carver carver;
        carver.prepare(*editor, {});
        volumes.push_back(saw_through(carver, *editor, path, per_call).removed_m3);
        hashes.push_back(editor->current().content_hash);
    }
    CHECK(hashes[0] == hashes[1]);
    for (const double volume : volumes) CHECK(volume == Approx(volumes[0]).epsilon(0.01));
}

TEST_CASE("a cut that exceeds the budget of bricks is completed by the updates that follow") {
    auto path = stroke(above, {0, -0.010, 0}, 0.8);
    const auto rest = stroke(path.back().pose.position + Vec3(0, 0.0005, 0), Vec3(0.0), 0.2);
    path.insert(path.end(), rest.begin(), rest.end());
    const auto wide = bone_of(400.0), narrow = bone_of(400.0, 30);
    carve::Carver a, b;
    a.prepare(*wide, {});
    b.prepare(*narrow, {});
    const carve::CarveResult whole = saw_through(a, *wide, path, 17);
    const carve::CarveResult parts = saw_through(b, *narrow, path, 17);
    CHECK_FALSE(whole.budget_hit);
    CHECK(parts.budget_hit);
    CHECK(parts.removed_m3 == Approx(whole.removed_m3).epsilon(0.01));
}

TEST_CASE("bricks away from the cut keep their bits") {
    const auto editor = bone_of(600.0);
    carve::Carver carver;
    carver.prepare(*editor, {});
    const volume::Grid before = volume::to_grid(editor->current());
    saw_through(carver, *editor, stroke(above, {0, -0.010, 0}, 1.0), 17);
    const volume::Grid after = volume::to_grid(editor->current());
    std::size_t changed = 0, far = 0;
    for (int k = 0; k < after.size[2]; ++k) {
        for (int j = 0; j < after.size[1]; ++j) {
            for (int i = 0; i < after.size[0]; ++i) {
                const Vec3 p = after.position(i, j, k);
                const bool differs = after.at(i, j, k) != before.at(i, j, k);
                changed += differs;
                far += differs && (std::abs(p.z) > 0.0036 || p.y > 0.001);
            }
        }
    }
    CHECK(changed > 1000);
    CHECK(far == 0);
}

TEST_CASE("cutting allocates nothing and waits for nobody") {
    const auto editor = bone_of(600.0);
    carve::Carver carver;
    carver.prepare(*editor, {});
    const auto path = stroke(above, {0, -0.010, 0}, 0.3);
    const auto violations = watch_scopes([&] {
        const RealtimeScope scope;
        for (std::size_t n = 0; n + 20 <= path.size(); n += 20) {
            carver.update(*editor, std::span(path).subspan(n, 20));
            editor->reclaim(editor->publish().version);
        }
    });
    INFO(violations.describe());
    CHECK(violations.none());
}

TEST_CASE("a kerf of less than three voxels is told") {
    const auto editor = bone_of(600.0);
    carve::Carver carver;
    carver.prepare(*editor, {});
    CHECK(carver.kerf_voxels() == Approx(0.001 / voxel));
    carve::CarveSettings thin;
    thin.kerf = 0.0008;
    carver.prepare(*editor, thin);
    CHECK(carver.kerf_voxels() < 3.0);
}

TEST_CASE("a new law of advance holds from the next update on") {
    const auto editor = bone_of(1800.0);
    carve::Carver carver;
    carver.prepare(*editor, {});
    const auto path = stroke({0, -0.0001, 0}, {0, -0.010, 0}, 1.0);
    const auto middle = [&] { return -carver.edge()[carver.edge().size() / 2].at.y; };
    saw_through(carver, *editor, path, 17);
    const double first = middle();
    carve::CarveSettings law;
    law.speed *= 2.0;
    carver.set_law(law);
    saw_through(carver, *editor, stroke({0, -0.0101, 0}, Vec3(0.0), 1.0), 17);
    const double second = middle();
    CHECK(second - first == Approx(2.0 * 0.67e-3).epsilon(0.02));
    law.reference_rate = 0.0;
    carver.set_law(law);
    saw_through(carver, *editor, stroke({0, -0.0101, 0}, Vec3(0.0), 0.5), 17);
    CHECK(middle() == Approx(second).margin(1e-9));
}

TEST_CASE("settings that make no saw are refused") {
    const auto editor = bone_of(600.0);
    carve::Carver carver;
    carve::CarveSettings settings;
    settings.stroke = 0.0005;
    CHECK_THROWS_WITH(carver.prepare(*editor, settings), Catch::Matchers::ContainsSubstring("tooth pitch"));
    settings = {};
    settings.kerf = -1.0;
    CHECK_THROWS_WITH(carver.prepare(*editor, settings), Catch::Matchers::ContainsSubstring("kerf"));
    settings = {};
    settings.kerf = 0.007;
    CHECK_THROWS_WITH(carver.prepare(*editor, settings), Catch::Matchers::ContainsSubstring("band"));
    settings = {};
    settings.tooth_pitch = 1e-9;
    CHECK_THROWS_WITH(carver.prepare(*editor, settings), Catch::Matchers::ContainsSubstring("teeth"));
}
