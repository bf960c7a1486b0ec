// SPDX-License-Identifier: Apache-2.0
// The tasks of the library, and the bones and structures that they are about.
#include "assets/library/fibula.hpp"
#include "assets/library/mandible.hpp"
#include "assets/training/task_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/training/removed.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;

namespace {

training::TaskFile task(const char* name) {
    return training::load_task_file(test::source_folder() / "assets/library/tasks" / (std::string(name) + ".toml"));
}

/// Where the surface lies along the feed from 10 mm above the planned entry, m from the entry.
double surface_of(const bone::Bone& bone, const training::PlannedCut& cut) {
    const training::CutBone both{bone.distance, bone.distance};
    for (double d = -10 * mm; d < 20 * mm; d += 0.01 * mm)
        if (both.before_at(cut.position(0.0, d)) < 0.0) return d;
    return 1.0;
}

double depth_of(const volume::Grid& labels, const training::PlannedCut& cut, double half_kerf) {
    double least = 1.0;
    for (int k = 0; k < labels.size[2]; ++k)
        for (int j = 0; j < labels.size[1]; ++j)
            for (int i = 0; i < labels.size[0]; ++i) {
                if (labels.at(i, j, k) != 1.0f) continue;
                const Vec3 p = cut.coordinates(labels.position(i, j, k));
                if (std::abs(p.z) < half_kerf) least = std::min(least, p.y);
            }
    return least;
}

}  // namespace

TEST_CASE("a generated fibula has the size, the cortex and the open cavity of one") {
    const volume::Grid hu = library::fibula_hu();
    const auto at = [&](double x, double y, double z) {
        const Vec3 u = (Vec3(x, y, z) - hu.origin) / hu.spacing;
        return hu.at(static_cast<int>(std::lround(u.x)), static_cast<int>(std::lround(u.y)),
                     static_cast<int>(std::lround(u.z)));
    };
    for (const double z : {-20 * mm, 0.0, 20 * mm}) {
        const double bow = -z * z;
        double narrowest = 1.0, widest = 0.0;
        for (int n = 0; n < 36; ++n) {
            const double angle = n * M_PI / 36.0;
            double width = 0.0;
            for (double r = -9.5 * mm; r < 9.5 * mm; r += 0.1 * mm)
                if (std::abs(r) < 2.5 * mm || at(bow + r * std::cos(angle), r * std::sin(angle), z) > 300.0f)
                    width += 0.1 * mm;
            narrowest = std::min(narrowest, width);
            widest = std::max(widest, width);
        }
        INFO("z " << z << ": " << narrowest << " to " << widest);
        CHECK(narrowest > 10.5 * mm);
        CHECK(widest < 16 * mm);
        CHECK(widest > 1.08 * narrowest);
        CHECK(at(bow, 0.0, z) < 100.0f);
        double cortex = 0.0;
        for (double r = 0.0; r < 9 * mm; r += 0.1 * mm) cortex += at(bow + r, 0.0, z) > 700.0f ? 0.1 * mm : 0.0;
        CHECK(cortex > 2.5 * mm);
        CHECK(cortex < 4.5 * mm);
    }
}

TEST_CASE("library tasks enter at the surface of their bone and spare what lies behind") {
    const bone::Bone mandible = library::make_mandible(), fibula = library::make_fibula();
    const training::TaskFile canal = task("mandible-canal"), osteotomy = task("fibula-osteotomy");
    CHECK(std::abs(surface_of(mandible, canal.cuts[0])) < 0.3 * mm);
    CHECK(std::abs(surface_of(fibula, osteotomy.cuts[0])) < 0.3 * mm);
    // The depth stop, the round floor of the kerf and half a millimetre lie before the nerve.
    const double nerve = depth_of(library::mandible_canal(), canal.cuts[0], 1 * mm);
    CHECK(nerve > canal.cuts[0].depth + 0.5 * mm);
    CHECK(nerve < canal.cuts[0].depth + 2 * mm);
    // The bone ends before the depth stop, the vessels begin behind the bone.
    const training::CutBone both{fibula.distance, fibula.distance};
    double far_side = 0.0;
    for (double s = -10 * mm; s < 10 * mm; s += 0.2 * mm)
        for (double d = 0.0; d < 20 * mm; d += 0.1 * mm)
            if (both.before_at(osteotomy.cuts[0].position(s, d)) < 0.0) far_side = std::max(far_side, d);
    const double vessels = depth_of(library::fibula_vessels(), osteotomy.cuts[0], 1 * mm);
    INFO("far side " << far_side << ", vessels " << vessels);
    CHECK(far_side < osteotomy.cuts[0].depth);
    CHECK(vessels > far_side + 1 * mm);
    CHECK(vessels < far_side + 3.5 * mm);
}
