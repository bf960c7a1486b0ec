// SPDX-License-Identifier: Apache-2.0
// From touches to what is seen: the command calibrates a display, and its file decides what every eye sees.
#include "tests/tools/run_command.hpp"

#include "assets/display/touch_file.hpp"
#include "dsp/core/random.hpp"
#include "dsp/coupling/placement.hpp"
#include "tests/support/catch.hpp"
#include "tools/render/sight.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

using namespace tactus;
using namespace tactus::render;
using namespace tactus::test;
using nlohmann::json;

namespace {

constexpr int width = 1920, height = 1080;

/// How a display really stands: a monitor above a half-transparent mirror, a device beneath it.
struct TrueDisplay {
    Pose device{{0.03, -0.24, -0.28}, coupling::rotation_xyz({0.2, -0.1, 0.4})};
    display::Plane mirror{{0.0, 0.0, 0.0}, glm::normalize(Vec3(0.0, -0.25, 0.97))};
    display::Screen image{{0.26, -0.14, -0.2}, {-0.26, -0.14, -0.2}, {0.26, 0.14, -0.12}};  // left and right swapped
    Vec3 work = image.low_left + 0.5 * (image.right() + image.up());

    Vec3 mark(double u, double v) const { return image.low_left + u * image.right() + v * image.up(); }
};

/// Normal noise of `sigma` on each axis.
struct Noise {
    double sigma;
    Random random{7};
    std::uint64_t draw = 0;

    Vec3 operator()() {
        Vec3 v;
        for (int axis = 0; axis < 3; ++axis) {
            double sum = -6.0;
            for (int n = 0; n < 12; ++n) sum += random.uniform(draw++);
            v[axis] = sigma * sum;
        }
        return v;
    }
};

std::vector<display::Touch> touches_of(const TrueDisplay& truth, Noise noise) {
    std::vector<display::Touch> touches;
    const auto add = [&](display::Touch touch, const Vec3& at) {
        touch.reading = truth.device.inverse().apply(at) + noise();
        touches.push_back(touch);
    };
    for (int n = 0; n < 12; ++n) {
        const Vec3 at = truth.work + 0.1 * (n < 8 ? Vec3((n & 1) * 2 - 1, (n & 2) - 1, (n >> 2) * 2 - 1)
                                                  : Vec3(n == 8 ? 1 : 0, n == 9 ? -1 : 0, n == 10 ? 1 : -0.5));
        add({display::Touch::Of::workspace, {}, {}, {}, at}, at);
    }
    const Vec3 along(1.0, 0.0, 0.0), across = glm::cross(truth.mirror.normal, along);
    for (int n = 0; n < 12; ++n)
        add({display::Touch::Of::mirror, {}, {}, {}, {}},
            truth.mirror.point + 0.15 * ((n % 4 - 1.5) * along + (n / 4 - 1.0) * across));
    for (int n = 0; n < 16; ++n) {
        const glm::dvec2 shown(0.05 + 0.3 * (n % 4), 0.05 + 0.3 * (n / 4));
        add({display::Touch::Of::image, "monitor", shown, {}, {}}, truth.mark(shown.x, shown.y));
    }
    return touches;
}

const std::byte* bytes_of(const Pose& pose) { return reinterpret_cast<const std::byte*>(&pose); }

/// A head before the display's file: what both eyes see.
class Beholder {
public:
    explicit Beholder(const fs::path& file) : sight_({"quad-buffer", "head.pose", file, {}}) {
        const Pose nowhere;
        port_ = observer_.open({"head.pose", flicks_per_second / 60, 1}, value::pose, bytes_of(nowhere));
        observer_.watch("head.pose", observe::Watch::latest);
    }
    std::vector<display::DrawnView> look(const Pose& head, const display::Bounds& scene) {
        port_->see(++ticks_, bytes_of(head), 1, 0);
        observer_.advance();
        sight_.update(observer_);
        auto views = sight_.views(0, {}, scene, width, height);
        CHECK(sight_.warnings().empty());
        REQUIRE(views.size() == 2);
        return views;
    }

private:
    observe::Observer observer_;
    Sight sight_;
    std::shared_ptr<observe::ObservedPort> port_;
    std::int64_t ticks_ = 0;
};

glm::dvec2 pixel(const display::DrawnView& view, const Vec3& scene) {
    const auto at = view.projection.seen(scene);
    REQUIRE(at);
    return {0.5 * (at->x + 1.0) * width, 0.5 * (at->y + 1.0) * height};
}

/// Where the lines from two eyes pass each other nearest.
Vec3 crossing(const Vec3& a, const Vec3& towards_a, const Vec3& b, const Vec3& towards_b) {
    const Vec3 u = glm::normalize(towards_a - a), v = glm::normalize(towards_b - b), w = a - b;
    const double uv = glm::dot(u, v), d = glm::dot(u, w), e = glm::dot(v, w), share = 1.0 - uv * uv;
    return 0.5 * (a + u * ((uv * e - d) / share) + b + v * ((e - uv * d) / share));
}

display::Bounds cube(const Vec3& middle) {
    display::Bounds box;
    box.add(middle - Vec3(0.12));
    box.add(middle + Vec3(0.12));
    return box;
}

Pose head_at(const TrueDisplay& truth, const Vec3& off) {
    return {truth.work + Vec3(0.0, -0.35, 0.45) + off, coupling::rotation_xyz({0.6, 0.1, -0.1})};
}

fs::path calibrated(const Folder& folder, const TrueDisplay& truth, double sigma, json* answer = nullptr) {
    folder.write("touches.csv", display::touches_text(touches_of(truth, {sigma})));
    const fs::path file = folder.path / "display.toml";
    const Outcome outcome = folder.tactus("calibrate --touches " + (folder.path / "touches.csv").string() + " -o " +
                                          file.string() + " --json");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    if (answer) *answer = json::parse(outcome.out);
    return file;
}

}  // namespace

TEST_CASE("after a calibration with noisy touches, a point is seen within 1 mm of where it is felt, in a 200 mm cube") {
    const TrueDisplay truth;
    const Folder folder;
    json answer;
    Beholder beholder(calibrated(folder, truth, 0.25e-3, &answer));
    CHECK(answer["rms_mm"].get<double>() < 1.0);
    CHECK(answer["display"] == (folder.path / "display.toml").string());
    CHECK(answer["rig"] == answer["display"]);  // the key before
    CHECK(answer["parts"].size() == 3);
    CHECK(answer["parts"][2]["touches"].size() == 16);
    double worst = 0.0;
    for (int n = 0; n < 5; ++n) {
        const Pose head = head_at(truth, Vec3(0.1 * (n - 2), 0.05 * (n % 2), 0.03 * n));
        const display::Eyes eyes = display::eyes_of(head, 0.063);
        // The scene is the device's own frame: no node places it elsewhere.
        const auto views = beholder.look(head, cube(truth.device.inverse().apply(truth.work)));
        for (int corner = 0; corner < 27; ++corner) {
            const Vec3 felt = truth.work + 0.1 * Vec3(corner % 3 - 1, corner / 3 % 3 - 1, corner / 9 - 1);
            const Vec3 read = truth.device.inverse().apply(felt);
            // The pixels light up on the true monitor, and are seen where the true mirror shows them.
            Vec3 shown[2];
            for (std::size_t eye = 0; eye < 2; ++eye) {
                const glm::dvec2 at = pixel(views[eye], read);
                shown[eye] = truth.mark(at.x / width, at.y / height);
            }
            worst = std::max(worst, glm::length(crossing(eyes.left, shown[0], eyes.right, shown[1]) - felt));
        }
    }
    CHECK(worst < 1e-3);
    CHECK(worst > 1e-6);  // the noise went somewhere
}

TEST_CASE(
    "through the file of a display, every pixel is within half a one of the analytic place, 200 mm of head travel") {
    const TrueDisplay truth;
    const Folder folder;
    Beholder beholder(calibrated(folder, truth, 0.0));
    const Random random{3};
    std::uint64_t draw = 0;
    const auto within = [&](double reach) {
        Vec3 v;
        for (int axis = 0; axis < 3; ++axis) v[axis] = reach * (2.0 * random.uniform(draw++) - 1.0);
        return v;
    };
    double worst = 0.0, parallax = 0.0;
    for (int n = 0; n < 200; ++n) {
        const Pose head = head_at(truth, within(0.2));
        const display::Eyes eyes = display::eyes_of(head, 0.063);
        const auto views = beholder.look(head, cube(truth.device.inverse().apply(truth.work)));
        const Vec3 felt = truth.work + within(0.1);
        const auto analytic = [&](const Vec3& eye) {
            const Vec3 normal = truth.image.normal(), way = felt - eye;
            const Vec3 at = eye + way * (glm::dot(truth.image.low_left - eye, normal) / glm::dot(way, normal)) -
                            truth.image.low_left;
            const auto share = [&](const Vec3& edge) { return glm::dot(at, edge) / glm::dot(edge, edge); };
            return glm::dvec2(share(truth.image.right()) * width, share(truth.image.up()) * height);
        };
        const Vec3 read = truth.device.inverse().apply(felt);
        worst = std::max({worst, glm::length(pixel(views[0], read) - analytic(eyes.left)),
                          glm::length(pixel(views[1], read) - analytic(eyes.right))});
        // A point that lies on the screen, as it is seen in the mirror, has one place for both eyes.
        const Vec3 flat = truth.device.inverse().apply(truth.mark(0.2 + 0.003 * n, 0.8 - 0.003 * n));
        parallax = std::max(parallax, glm::length(pixel(views[0], flat) - pixel(views[1], flat)));
        CHECK(views[0].projection.is_mirrored);
    }
    CHECK(worst < 0.5);
    CHECK(worst < 0.01);  // what the file's rounding leaves
    CHECK(parallax < 0.01);
}

TEST_CASE("a simulated hand touches the marks of a screen, and one that went wrong is asked for again") {
    const Folder folder;
    // A screen of 400 x 250 mm, upright; the second mark is missed by 30 mm, and touched right at the end.
    std::string script = "0 s: 0 0 0 mm |\n";
    auto press = [&, time = 1.0](double x, double z) mutable {
        script += fmt::format("{} s: {} 100 {} mm |\n{} s: {} 100 {} mm | trigger\n{} s: {} 100 {} mm |\n", time, x, z,
                              time + 0.8, x, z, time + 1.3, x, z);
        time += 2.3;
    };
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            press(-200.0 + 400.0 * (0.1 + 0.4 * column) + (row == 0 && column == 1 ? 30.0 : 0.0),
                  50.0 + 250.0 * (0.1 + 0.4 * row));
    press(-200.0 + 400.0 * 0.5, 50.0 + 250.0 * 0.1);
    const std::string file = folder.write("hand.txt", script).string(), out = (folder.path / "display.toml").string();
    const std::string command = "calibrate --device scripted --option file=" + file +
                                " --option \"stiffness=5 N/mm\" --option \"damping=60 N s/m\" --screen monitor -o " +
                                out;
    const Outcome outcome =
        folder.tactus(command + " --keep " + (folder.path / "touches.csv").string() + " </dev/null");
    INFO(outcome.err);
    INFO(outcome.out);
    REQUIRE(outcome.code == 0);
    CHECK(outcome.err.find("9 of 9") != std::string::npos);
    CHECK(outcome.err.find("touch 2, mark (0.5, 0.1) of screen 'monitor', is 30.0 mm off") != std::string::npos);
    const display::DisplayFile written = display::load_display_file(out);
    REQUIRE(written.screens.size() == 1);
    CHECK(written.screens[0].name == "monitor");
    CHECK(glm::length(written.geometry.screens[0].low_left - Vec3(-0.2, 0.1, 0.05)) < 0.2e-3);
    CHECK(glm::length(written.geometry.screens[0].low_right - Vec3(0.2, 0.1, 0.05)) < 0.2e-3);
    CHECK(display::load_touches(folder.path / "touches.csv").size() == 9);
    // The kept touches give the same display, and what is known of it otherwise stays.
    const Outcome again = folder.tactus("calibrate --touches " + (folder.path / "touches.csv").string() + " --base " +
                                        out + " -o " + (folder.path / "again.toml").string());
    CHECK(again.code == 0);
    CHECK(glm::length(display::load_display_file(folder.path / "again.toml").geometry.screens[0].high_left -
                      written.geometry.screens[0].high_left) < 1e-8);
}

TEST_CASE("a calibration that cannot be trusted writes nothing and says which touch, how far, what to do") {
    const TrueDisplay truth;
    const Folder folder;
    auto touches = touches_of(truth, {0.2e-3});
    touches[30].reading.x += 0.015;
    folder.write("touches.csv", display::touches_text(touches));
    const std::string out = (folder.path / "display.toml").string();
    const auto calibrate = [&] {
        return folder.tactus("calibrate --touches " + (folder.path / "touches.csv").string() + " -o " + out);
    };
    const Outcome bad = calibrate();
    CHECK(bad.code == 2);
    CHECK(bad.err.find("touch 31,") != std::string::npos);
    CHECK(bad.err.find("mm off") != std::string::npos);
    CHECK(bad.err.find("touch it again") != std::string::npos);
    CHECK_FALSE(fs::exists(out));
    CHECK_FALSE(fs::exists(out + ".part"));
    touches.resize(14);
    folder.write("touches.csv", display::touches_text(touches));
    CHECK(calibrate().err.find("mirror") != std::string::npos);
    CHECK(folder.tactus("calibrate -o " + out).err.find("--device") != std::string::npos);
    CHECK(folder.tactus("calibrate --device scripted -o " + out).err.find("nothing to touch") != std::string::npos);
    // Before the first touch, not after the last.
    CHECK(folder.tactus("calibrate --device scripted --mirror -o " + out + " </dev/null").err.find("needs a screen") !=
          std::string::npos);
    CHECK(folder.tactus("calibrate --device scripted --screen monitor -o " + out + " </dev/null")
              .err.find("did not press a button") != std::string::npos);
}

TEST_CASE("what a display has no place for is said before the run") {
    const Folder folder;
    const std::string render = "render touch-sphere --seconds 0.05 --frames 1 --out " + (folder.path / "out").string();
    CHECK(folder.tactus(render + " --display nowhere.toml").code == 2);
    CHECK(folder.tactus(render + " --offset study").err.find("--display") != std::string::npos);
    CHECK(folder.tactus(render + " --stereo quad-buffer").err.find("side-by-side") != std::string::npos);
}
