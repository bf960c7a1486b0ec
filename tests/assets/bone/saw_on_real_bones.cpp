// SPDX-License-Identifier: Apache-2.0
// A saw and a burr on scans and meshes of real bones: whatever they cut through, they give the hand no energy.
#include "assets/bone/import.hpp"
#include "dsp/saw/burr.hpp"
#include "dsp/volume/site.hpp"
#include "tests/dsp/saw/sawing.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

using namespace tactus;
using namespace tactus::test;

namespace {

struct RealBone {
    const char* file;
    double threshold;  // HU; 0: a mesh
};

constexpr RealBone real_bones[] = {{"ct/head_phantom.nrrd", 300.0},
                                   {"ct/skull_sawn_calotte.nrrd", 300.0},
                                   {"fragments/hip003_intact_side_ct.nrrd", 250.0},
                                   {"mesh/fibula_left_vhf.stl", 0.0},
                                   {"mesh/mandible.stl", 0.0}};

/// A bone around the place where the saw starts, in voxels that resolve a kerf of 1 mm.
struct Place {
    std::string name;
    volume::SawSite site;
    volume::SiteVolume grids;
};

const std::vector<Place>& places() {
    static const std::vector<Place> all = [] {
        std::vector<Place> made;
        const char* const folder = std::getenv("TACTUS_SHARED_DATA");
        if (!folder) return made;
        for (const RealBone& real : real_bones) {
            const std::filesystem::path file = std::filesystem::path(folder) / real.file;
            if (!std::filesystem::exists(file)) continue;
            bone::ImportOptions options;
            options.input = file;
            if (real.threshold > 0.0) options.threshold = real.threshold;
            else options.spacing = 1e-3;
            const bone::Bone bone = bone::import_bone(options);
            const auto site = volume::find_saw_site(bone.distance, bone.density);
            CAPTURE(real.file);
            REQUIRE(site);
            volume::SiteRequest request;
            request.travel = 2e-3;
            made.push_back(
                {real.file, *site, volume::refine_at(*site, bone.distance, bone.density, 1e-3 / 3.05, request)});
        }
        return made;
    }();
    return all;
}

struct Cycle {
    double work = 0.0, bound = 0.0, pull = 0.0, most = 0.0, removed = 0.0, deepest = 0.0, last = 0.0;
};

constexpr double stiffness = 20e3;  // N/m

/// Work on a hand that moves as it is told and comes back.
class Ledger {
public:
    explicit Ledger(Cycle& cycle, const Vec3& feed) : cycle_(cycle), feed_(feed) {}
    void add(const Vec3& at, const Vec3& force) {
        if (has_last_) {
            const Vec3 move = at - at_;
            cycle_.work += glm::dot(force_, move);
            cycle_.bound += 0.5 * std::min(std::abs(glm::dot(force - force_, move)), stiffness * glm::dot(move, move));
        }
        cycle_.pull = std::max(cycle_.pull, glm::dot(force, feed_));
        cycle_.most = std::max(cycle_.most, glm::length(force));
        cycle_.last = glm::length(force);
        at_ = at;
        force_ = force;
        has_last_ = true;
    }

private:
    Cycle& cycle_;
    Vec3 feed_, at_{0.0}, force_{0.0};
    bool has_last_ = false;
};

double eased(double s, double a, double b) {
    const double u = std::clamp((s - a) / (b - a), 0.0, 1.0);
    return u * u * (3.0 - 2.0 * u);
}

/// From 2 mm above the bone `depth` into it, a little along the blade and to its side, and back.
Vec3 place_at(const volume::SawSite& site, double s, double depth, double above, const Vec3& aside) {
    return site.point + site.feed * (-above + (above + depth) * (eased(s, 0.0, 0.6) - eased(s, 0.85, 1.0))) +
           aside * (eased(s, 0.6, 0.7) - eased(s, 0.75, 0.85));
}

Cycle saw_cycle(const Place& place, bool running, double depth, const Vec3& aside, double seconds) {
    volume::BoneEditor bone(place.grids.distance, place.grids.density,
                            {.band = 4e-3, .max_dirty = 900, .max_versions = 3});
    Sawing sawing(bone, 1000.0, stiffness);
    sawing.law = saw::CuttingLaw{}.sharpened(4.0);  // through a whole bone in seconds
    sawing.drive.running = running;
    const volume::SawSite& site = place.site;
    const Quat stand = glm::normalize(glm::quat_cast(Mat3(site.stroke, site.feed, glm::cross(site.stroke, site.feed))));
    Cycle cycle;
    Ledger ledger(cycle, site.feed);
    const auto ticks = static_cast<int>(seconds * 1000.0);
    for (int n = 0; n <= ticks; ++n) {
        const Vec3 at = place_at(site, static_cast<double>(n) / ticks, depth, 2e-3, aside);
        ledger.add(at, sawing.step({at, stand}).wrench.force);
    }
    cycle.removed = sawing.removed;
    return cycle;
}

Cycle burr_cycle(const Place& place, bool running, double depth, const Vec3& aside, double seconds) {
    volume::BoneEditor bone(place.grids.distance, place.grids.density,
                            {.band = 6e-3, .max_dirty = 900, .max_versions = 3});
    saw::Burr burr({0.002, 8.0}, stiffness);
    carve::Carver carver;
    carve::CarveSettings settings;
    settings.kerf = 4e-3;
    settings.tooth_pitch = saw::tooth_pitch;
    settings.blade_length = (carve::CutFront::max_nodes - 1) * settings.tooth_pitch - settings.stroke;
    carver.prepare(bone, settings);
    std::vector<carve::CutFront> path;
    volume::BoneSnapshot read = bone.current();
    Cycle cycle;
    Ledger ledger(cycle, place.site.feed);
    const auto ticks = static_cast<int>(seconds * 1000.0);
    for (int n = 0; n <= ticks; ++n) {
        const Pose pose{place_at(place.site, static_cast<double>(n) / ticks, depth, 4e-3, aside), teeth_down};
        ledger.add(pose.position, burr.step(read, pose, {running, 1000.0, 1e-3}, {}).wrench.force);
        burr.fill(path.emplace_back(), pose, running);
        if (n % 17 != 16) continue;
        read = bone.publish();
        bone.reclaim(read.version);
        cycle.removed += carver.update(bone, path).removed_m3;
        path.clear();
    }
    return cycle;
}

bool are_there() {
    if (places().size() == std::size(real_bones)) return true;
    skip("TACTUS_SHARED_DATA does not name a folder with ct, fragments and mesh");
    return false;
}

void check(const Cycle& cycle, bool running) {
    CHECK(cycle.work <= 1.02 * cycle.bound + 1e-9);  // 2 %: kinks where points touch
    CHECK(cycle.most > 0.5);
    CHECK(cycle.last == 0.0);
    CHECK((cycle.removed > 0.0) == running);
}

}  // namespace

TEST_CASE("a saw gives the hand no energy and does not pull on real bones", "[slow]") {
    if (!are_there()) return;
    for (const Place& place : places())
        for (const bool running : {false, true}) {
            const Vec3 across = glm::cross(place.site.stroke, place.site.feed);
            for (const Vec3& aside : {place.site.stroke * 4e-3, across * 1.5e-3}) {
                const Cycle cycle = saw_cycle(place, running, 1.5e-3, aside, 1.2);
                CAPTURE(place.name, running, cycle.work, cycle.bound, cycle.pull, cycle.most, cycle.removed * 1e9);
                check(cycle, running);
                CHECK(cycle.pull <= 1e-9);
            }
        }
}

TEST_CASE("a saw that breaks through a real bone is let go without a pull", "[slow]") {
    if (!are_there()) return;
    for (const Place& place : places()) {
        // Down through all of it in the first 60 %.
        const double depth = std::min(place.site.thickness, 8e-3) + 2e-3;
        const Cycle cycle = saw_cycle(place, true, depth, Vec3(0.0), 4.0);
        CAPTURE(place.name, place.site.thickness * 1e3, cycle.work, cycle.bound, cycle.pull, cycle.most,
                cycle.removed * 1e9);
        check(cycle, true);
        CHECK(cycle.pull <= 1e-9);
    }
}

TEST_CASE("a burr gives the hand no energy on real bones", "[slow]") {
    if (!are_there()) return;
    for (const Place& place : places())
        for (const bool running : {false, true}) {
            const Vec3 across = glm::cross(place.site.stroke, place.site.feed);
            for (const Vec3& aside : {place.site.stroke * 4e-3, across * 3e-3}) {
                const Cycle cycle = burr_cycle(place, running, -1e-3, aside, 1.2);
                CAPTURE(place.name, running, cycle.work, cycle.bound, cycle.pull, cycle.most, cycle.removed * 1e9);
                check(cycle, running);
            }
        }
}
