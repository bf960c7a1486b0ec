// SPDX-License-Identifier: Apache-2.0
#include "dsp/carve/redistance.hpp"

#include "tests/dsp/carve/saw.hpp"
#include "tests/support/catch.hpp"

#include <memory>
#include <numeric>

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr double radius = 0.006, reach = 0.0015;

std::unique_ptr<volume::BoneEditor> bone_of(const std::function<double(double)>& distorted) {
    const volume::Grid grid = sampled(Vec3(-0.009), Vec3(0.009), Vec3(voxel),
                                      [&](const Vec3& p) { return distorted(glm::length(p) - radius); });
    return std::make_unique<volume::BoneEditor>(
        grid, grid, volume::BoneEditorOptions{.band = 0.1, .max_dirty = 400, .max_versions = 3});
}

int settle(volume::BoneEditor& editor) {
    carve::Redistance redistance;
    redistance.prepare(editor, reach);
    std::vector<std::uint32_t> all(static_cast<std::size_t>(editor.layout().brick_count()));
    std::iota(all.begin(), all.end(), 0u);
    redistance.add(all);
    int ticks = 0;
    while (redistance.tick(editor, 8) > 0 && ticks < 2000) {
        ++ticks;
        editor.reclaim(editor.publish().version);
    }
    editor.reclaim(editor.publish().version);
    return ticks;
}

}  // namespace

TEST_CASE("re-distancing leaves an exact distance as it is, to the last bit") {
    const auto editor = bone_of([](double d) { return d; });
    const auto before = editor->current().content_hash;
    settle(*editor);
    CHECK(editor->current().content_hash == before);
}

TEST_CASE("re-distancing makes a field three times too steep a distance, and keeps every sign") {
    const auto editor = bone_of([](double d) { return 3.0 * d; });
    const volume::Grid before = volume::to_grid(editor->current());
    CHECK(settle(*editor) < 2000);
    const volume::Grid once = volume::to_grid(editor->current());
    double sum = 0.0, worst = 0.0;
    int count = 0, flipped = 0;
    for (int k = 0; k < once.size[2]; ++k) {
        for (int j = 0; j < once.size[1]; ++j) {
            for (int i = 0; i < once.size[0]; ++i) {
                flipped += (once.at(i, j, k) <= 0.0f) != (before.at(i, j, k) <= 0.0f);
                const double exact = glm::length(once.position(i, j, k)) - radius;
                if (std::abs(exact) > reach / 3.0 - voxel) continue;
                const double error = std::abs(static_cast<double>(once.at(i, j, k)) - exact);
                sum += error;
                worst = std::max(worst, error);
                ++count;
            }
        }
    }
    CHECK(flipped == 0);
    CHECK(sum / count < 0.00003);
    CHECK(worst < 0.00008);

    settle(*editor);
    const volume::Grid twice = volume::to_grid(editor->current());
    double change = 0.0;
    for (std::size_t n = 0; n < once.values.size(); ++n) {
        change = std::max(change, std::abs(static_cast<double>(twice.values[n]) - static_cast<double>(once.values[n])));
    }
    CHECK(change < 0.00002);
}
