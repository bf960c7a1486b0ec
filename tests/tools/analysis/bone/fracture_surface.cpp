// SPDX-License-Identifier: Apache-2.0
// Which area the unbroken bone proposes, on a phantom whose break is known.
#include "tools/analysis/bone/fracture_surface.hpp"

#include "assets/bone/bone.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/kept_cache.hpp"
#include "tests/tools/bar.hpp"
#include "tests/tools/run_command.hpp"

#include <algorithm>
#include <filesystem>

using namespace tactus;

namespace {

using Points = std::vector<contact::SurfacePoint>;

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::recursive_directory_iterator(folder), {}));
}

double painted(const Points& points) {
    double area = 0.0;
    for (const contact::SurfacePoint& p : points)
        if (p.label == contact::surface_label::fracture) area += p.area;
    return area;
}

bool same_paint(const Points& a, const Points& b) {
    return std::ranges::equal(a, b, {}, &contact::SurfacePoint::label, &contact::SurfacePoint::label);
}

/// A bar in two pieces, with the true paint of both in their files.
struct BrokenBar {
    test::Folder folder;
    analysis::FractureSurfaceSettings settings;
    Points truth;

    BrokenBar() {
        bone::save_bone(test::bar(), folder.path / "bar.vdb");
        const test::Outcome broken = folder.tactus("fracture " + (folder.path / "bar.vdb").string() + " -o " +
                                                   folder.path.string() + "/a --seed 4 --spread 4 --turn 5");
        REQUIRE(broken.code == 0);
        settings.bone = folder.path / "a/fragment_02.vdb";
        settings.main = folder.path / "a/fragment_01.vdb";
        settings.intact = folder.path / "bar.vdb";
        settings.whole = false;
        truth = bone::load_bone(settings.bone).points;
        REQUIRE(painted(truth) > 150e-6);
    }
    Points proposed() const { return analysis::propose_fracture_surface(settings).bone.points; }
};

}  // namespace

TEST_CASE("what the unbroken bone proposes is the break, and a second painting is what a first one would be",
          "[slow]") {
    BrokenBar bar;
    const test::KeptCache cache;
    const Points first = bar.proposed();
    REQUIRE(first.size() == bar.truth.size());
    double both = 0.0;
    for (std::size_t n = 0; n < first.size(); ++n)
        if (first[n].label == contact::surface_label::fracture && bar.truth[n].label == first[n].label)
            both += first[n].area;
    CHECK(both > 0.84 * painted(bar.truth));
    CHECK(both > 0.85 * painted(first));
    // Nothing but the painted area depends on these: all else was kept.
    const std::size_t kept = files_in(cache.path);
    bar.settings.min_area = 0.0;
    const Points again = bar.proposed();
    bar.settings.facing = {bar.settings.main};
    const Points near = bar.proposed();
    CHECK(files_in(cache.path) - kept <= 1);  // the neighbour, when it was not needed before
    CHECK(painted(again) >= painted(first));
    const test::KeptCache empty;
    CHECK(same_paint(bar.proposed(), near));
    bar.settings.facing.clear();
    CHECK(same_paint(bar.proposed(), again));
    bar.settings.min_area.reset();
    bar.settings.whole = true;
    CHECK(same_paint(bar.proposed(), first));
}
