// SPDX-License-Identifier: Apache-2.0
// What the hand feels while a fragment is led to its place over the teeth of its break: before any limiter nothing comes
// or goes in a step, whatever the break.
#include "assets/library/fragments.hpp"
#include "dsp/contact/pointshell.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/coupling/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

using namespace tactus;
using test::NodeHarness;

namespace {

/// A break with teeth, coarse, and where a hand stops 5 mm and 10 degrees beside its place.
struct Broken {
    std::shared_ptr<const bone::Bone> left, right;
    contact::Pointshell shells[2];
    contact::Voxmap maps[2];
    coupling::Scene scene;
    Pose beside;  ///< of the right half

    explicit Broken(std::uint64_t seed) {
        auto bones =
            library::make_fragments({.voxel = 0.6 * mm, .spacing = 0.8 * mm, .roughness = 1.0 * mm, .seed = seed});
        left = std::make_shared<const bone::Bone>(std::move(bones[0]));
        right = std::make_shared<const bone::Bone>(std::move(bones[1]));
        scene.count = 2;
        for (std::size_t n = 0; n < 2; ++n) {
            const bone::Bone& bone = n == 0 ? *left : *right;
            shells[n] = contact::make_pointshell(bone.points);
            maps[n] = contact::make_voxmap(bone.distance);
            scene.objects[n] = {{&shells[n], &maps[n], nullptr, {}, 1, n + 1}, {}};
        }
        scene.version = 1;
        scene.content_hash = coupling::hash_of(scene);
        const Random random{seed};
        const auto direction = [&](std::uint64_t n) {
            return glm::normalize(Vec3(random.normal(n), random.normal(n + 1), random.normal(n + 2)));
        };
        beside = {5.0 * mm * direction(0), rotation_by(0.1745 * direction(3))};
    }
};

/// Held two centimetres from its break.
const Pose grip{Vec3(-20.0 * mm, 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}};

/// The hand brings the half in from 20 mm before its place within half a second, and stays there.
Pose brought(const Pose& beside, std::int64_t k) {
    const double away = std::clamp(20.0 - 0.04 * static_cast<double>(k), 0.0, 20.0) * mm;
    return Pose{beside.position + Vec3(away, 0.0, 0.0), beside.orientation} * grip.inverse();
}

/// What one run was like: the hand's force, and where the half was in the frame where it fits at its own frame.
struct Felt {
    std::vector<Wrench> wrench;
    std::vector<Pose> pose;

    /// N from one tick to the next, at most, from the tick `from` on.
    double step(std::size_t from) const {
        double most = 0.0;
        for (std::size_t k = from; k < wrench.size(); ++k)
            most = std::max(most, glm::length(wrench[k].force - wrench[k - 1].force));
        return most;
    }
    double greatest() const {
        double most = 0.0;
        for (const Wrench& w : wrench) most = std::max(most, glm::length(w.force));
        return most;
    }
    /// N, over the tenth of a second before `until`.
    double ripple(std::size_t until) const {
        double most = 0.0;
        for (std::size_t k = until - 100; k < until; ++k)
            most = std::max(most, glm::length(wrench[k].force - wrench[until - 1].force));
        return most;
    }
};

/// Ticks of a run: led from the first on, settling between two others, let go at the last.
struct Times {
    std::int64_t led = 700, settles = 1800, back = 2200, unled = 2700, let_go = 3000, end = 3100;
    std::int64_t lost = 1'000'000;  ///< there is no target for this tick
};

/// `kind`: of the node. The hand pulls along x from tick `pull` on, at 100 mm/s.
Felt felt_by(const char* kind, const Broken& broken, const Times& at, std::int64_t pull = 1'000'000) {
    NodeHarness node(kind, test::servo);
    const bool by_target = std::string_view(kind) == "quasi_static_coupling";
    node.set("held", "1");
    if (by_target) {
        node.feed<bool>("has_target", [at](std::int64_t k) { return k != at.lost; }).feed<double>("target_of", 1.0);
        // For a while the target is another one, as a matcher may change its mind.
        node.feed<Pose>("target", [](std::int64_t k) {
            return k >= 1250 && k < 1500 ? Pose{Vec3(0.0, 3.0, 1.0) * mm, rotation_by({0.08, 0.0, 0.0})} : Pose{};
        });
    } else node.set("target", "0").asset("moving", broken.right).asset("fixed", broken.left);
    node.feed("scene", broken.scene).feed("grip", grip);
    node.feed<Pose>("device", [&](std::int64_t k) {
        const double pulled = k > pull ? 0.1 * mm * static_cast<double>(k - pull) : 0.0;
        const Pose there = brought(broken.beside, k);
        return Pose{there.position + Vec3(pulled, 0.0, 0.0), there.orientation};
    });
    node.feed<bool>(by_target ? "guided" : "engaged", [at](std::int64_t k) { return k >= at.led && k < at.unled; });
    node.feed<bool>("settle", [at](std::int64_t k) { return k >= at.settles && k < at.back; });
    node.feed<bool>("holding", [at](std::int64_t k) { return k < at.let_go; });
    node.feed<double>("strength", [at](std::int64_t k) {
        return std::clamp(1.0 - static_cast<double>(k - at.let_go) / 50.0, 0.0, 1.0);
    });
    node.prepare();
    node.run(at.end);
    return {node.values<Wrench>("wrench"), node.values<Pose>("pose")};
}

}  // namespace

TEST_CASE("a fragment that is led over the teeth of any break and settles there is felt without a step", "[slow]") {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Broken broken(seed);
        for (const char* kind : {"quasi_static_coupling", "snap_to_fit"}) {
            CAPTURE(seed, kind);
            const Times at;
            const Felt felt = felt_by(kind, broken, at);
            // Where a tooth was jumped within a tick it was up to two.
            CHECK(felt.step(static_cast<std::size_t>(at.led)) < 0.15);
            CHECK(felt.greatest() < 10.0);
            CHECK(felt.ripple(1250) < 5e-3);
            CHECK(felt.ripple(static_cast<std::size_t>(at.settles)) < 5e-3);
            CHECK(felt.ripple(static_cast<std::size_t>(at.back)) < 5e-3);
            // Nothing of it is felt once the springs have given way.
            CHECK(glm::length(felt.wrench[static_cast<std::size_t>(at.back) - 10].force) < 1e-6);
        }
    }
}

TEST_CASE("a fragment that is led or settles comes along within 50 ms of being pulled away, at any time", "[slow]") {
    const Broken broken(1);
    for (const char* kind : {"quasi_static_coupling", "snap_to_fit"})
        for (const std::int64_t pull : {720, 900, 1200, 1760, 1820, 1900, 2100, 2230, 2400}) {
            CAPTURE(kind, pull);
            Times at;
            at.unled = at.let_go = 4000;
            at.end = 3400;
            // It settles until it is pulled out.
            if (pull > at.settles && pull < at.back) at.back = 4000;
            const Felt felt = felt_by(kind, broken, at, pull);
            CHECK(felt.greatest() < 10.01);
            CHECK(felt.step(static_cast<std::size_t>(at.led)) < 0.3);
            // From when the hand has gone 10 mm: then the springs would pull harder than the fit may.
            const auto gone = static_cast<std::size_t>(pull) + 100;
            CHECK(glm::length(felt.pose[gone + 50].position - felt.pose[gone].position) > 0.8 * mm);
            CHECK(felt.pose.back().position.x > 80.0 * mm);
        }
}

TEST_CASE(
    "a fragment that was pulled away stays in the hand when the target fails for a tick while settle is pressed") {
    const Broken broken(1);
    Times at;
    at.unled = at.back = at.let_go = 4000;
    at.end = 3400;
    const std::int64_t pull = 1900;
    for (const std::int64_t lost : {pull + 50, pull + 200, pull + 600}) {
        CAPTURE(lost);
        at.lost = lost;
        const Felt felt = felt_by("quasi_static_coupling", broken, at, pull);
        CHECK(felt.step(static_cast<std::size_t>(at.led)) < 0.3);
        // 80 mm behind the hand it would be drawn back; it has its springs and follows within them.
        CHECK(felt.pose.back().position.x > 80.0 * mm);
        for (std::size_t k = static_cast<std::size_t>(pull) + 300; k + 1 < felt.pose.size(); ++k)
            REQUIRE(felt.pose[k + 1].position.x > felt.pose[k].position.x);
    }
}
