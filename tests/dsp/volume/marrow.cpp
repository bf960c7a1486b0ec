// SPDX-License-Identifier: Apache-2.0
// Marrow is filled behind a shell that leaks, and nothing else is: cranium, spinal canal, joint spaces, sinuses.
#include "dsp/volume/marrow.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace tactus;
using volume::RunRows;

namespace {

/// Samples of 0.5 mm for which a function of their place in mm is true; the box begins at 0.
struct Phantom {
    std::array<int, 3> size{100, 100, 100};
    double h = 0.5;

    RunRows where(const std::function<bool(const Vec3&)>& is) const {
        volume::Grid grid{size, Vec3(0.0), Vec3(h * 1e-3), {}};
        grid.values.resize(grid.count());
        for (int k = 0; k < size[2]; ++k)
            for (int j = 0; j < size[1]; ++j)
                for (int i = 0; i < size[0]; ++i) grid.at(i, j, k) = is(h * Vec3(i, j, k)) ? 1.0f : 0.0f;
        RunRows rows{size, {0}, {}};
        volume::append_above(rows, grid, 0.5f, 0, size[2]);
        return rows;
    }
    /// mm³ of marrow.
    double marrow(const std::function<bool(const Vec3&)>& bone, const std::function<bool(const Vec3&)>& air,
                  int margin = 4) const {
        const volume::Components::Box inner{{margin, margin, margin},
                                            {size[0] - 1 - margin, size[1] - 1 - margin, size[2] - 1 - margin}};
        return static_cast<double>(count_of(volume::marrow_of(where(bone), where(air), inner, Vec3(h * 1e-3)))) * h *
               h * h;
    }
};

const auto no_air = [](const Vec3&) { return false; };
const Vec3 middle(25.0, 25.0, 25.0);

/// A shell between two radii, with a round hole of that width along +x.
auto leaky_shell(double inside, double outside, double hole) {
    return [=](const Vec3& p) {
        const double r = glm::length(p - middle);
        const bool is_hole = p.x > middle.x && std::hypot(p.y - middle.y, p.z - middle.z) < 0.5 * hole;
        return r >= inside && r <= outside && !is_hole;
    };
}

}  // namespace

TEST_CASE("marrow behind a shell that leaks is filled, nearly all of it") {
    // A plate of bone of 10 mm between two cortices of 2 mm, with a hole of 2 mm: a sternum.
    const auto plate = [](const Vec3& p) {
        const Vec3 from = glm::abs(p - middle);
        const bool in = from.x <= 16.0 && from.y <= 16.0 && from.z <= 7.0;
        const bool is_core = from.x < 14.0 && from.y < 14.0 && from.z < 5.0;
        const bool is_hole = p.z > middle.z && std::hypot(p.x - middle.x, p.y - middle.y) < 1.0;
        return in && !is_core && !is_hole;
    };
    const double core = 27.5 * 27.5 * 9.5;  // as the samples have it
    const double filled = Phantom{}.marrow(plate, no_air);
    CHECK(filled > 0.99 * core);
    CHECK(filled < 1.01 * core);
}

TEST_CASE("a hole wider than twice the closing leaves a cavity open") {
    CHECK(Phantom{}.marrow(leaky_shell(8.0, 10.0, 2.0), no_air) > 0.9 * 4.0 / 3.0 * 3.14159 * 512.0);
    CHECK(Phantom{}.marrow(leaky_shell(8.0, 10.0, 5.0), no_air) == 0.0);
}

TEST_CASE("a cranium is not filled, though its holes are as small as those of a sternum") {
    CHECK(Phantom{}.marrow(leaky_shell(16.0, 19.0, 2.0), no_air) == 0.0);
}

namespace {

/// A canal of 16 mm along an axis, from `low` to `high` mm, closed by bone at the ends where it is capped; of vertebrae
/// of 8 mm with gaps of that width between them.
struct Canal {
    int axis = 2;
    double low = 6.0, high = 44.0, gap = 0.0;
    bool is_capped_low = true, is_capped_high = true;

    bool operator()(const Vec3& p) const {
        const Vec3 from = p - middle;
        const double r = std::hypot(from[(axis + 1) % 3], from[(axis + 2) % 3]), along = p[axis];
        if (r > 11.0 || along < low || along > high) return false;
        if ((is_capped_low && along <= low + 3.0) || (is_capped_high && along >= high - 3.0)) return true;
        return r >= 8.0 && std::fmod(along - low, 8.0 + gap) <= 8.0;
    }
};

}  // namespace

TEST_CASE("a spinal canal is not filled, where it ends, where the scan ends and between vertebrae") {
    for (const int axis : {0, 1, 2}) {
        CAPTURE(axis);
        // One that is closed on all sides is filled, so that nothing else keeps the others empty.
        const double closed = Phantom{}.marrow(Canal{axis}, no_air);
        CHECK(closed == Approx(3.14159 * 64.0 * 32.0).epsilon(0.05));
        CHECK(Phantom{}.marrow(Canal{axis, 6.0, 44.0, 2.0}, no_air) > 0.9 * closed);
        CHECK(Phantom{}.marrow(Canal{axis, 6.0, 44.0, 4.5}, no_air) == 0.0);
        // It ends within the scan, at one end or both.
        CHECK(Phantom{}.marrow(Canal{axis, 6.0, 44.0, 0.0, true, false}, no_air) == 0.0);
        CHECK(Phantom{}.marrow(Canal{axis, 6.0, 44.0, 0.0, false, false}, no_air) == 0.0);
        // The scan ends, with or without samples around what was scanned.
        for (const int margin : {0, 4}) {
            const double first = 0.5 * margin, last = 49.5 - 0.5 * margin;
            CAPTURE(margin);
            CHECK(Phantom{}.marrow(Canal{axis, first, last, 0.0, false, false}, no_air, margin) == 0.0);
            CHECK(Phantom{}.marrow(Canal{axis, 6.0, last, 0.0, true, false}, no_air, margin) == 0.0);
            CHECK(Phantom{}.marrow(Canal{axis, first, 44.0, 0.0, false, true}, no_air, margin) == 0.0);
        }
    }
}

TEST_CASE("a joint space is not filled, however narrow") {
    // A ball in a socket of two thirds of a sphere.
    for (const double gap : {1.0, 2.0, 4.0, 6.0}) {
        const auto joint = [gap](const Vec3& p) {
            const double r = glm::length(p - middle);
            return r <= 9.0 || (r >= 9.0 + gap && r <= 12.0 + gap && p.z < middle.z + 4.0);
        };
        CAPTURE(gap);
        CHECK(Phantom{}.marrow(joint, no_air) < 5.0);
    }
}

TEST_CASE("a sinus is not filled: it holds air") {
    const auto air = [](const Vec3& p) { return glm::length(p - middle) < 7.0; };
    CHECK(Phantom{}.marrow(leaky_shell(8.0, 10.0, 2.0), air) == 0.0);
}
