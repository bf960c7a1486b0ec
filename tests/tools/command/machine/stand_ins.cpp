// SPDX-License-Identifier: Apache-2.0
// A library patch under the hand of boards, services and trackers, each played by a test.
#include "devices/openigtlink/message.hpp"
#include "devices/openigtlink/sender.hpp"
#include "tests/devices/driver/board_peer.hpp"
#include "tests/devices/driver/service_peer.hpp"
#include "tests/devices/driver/space_daemon.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace tactus;
using namespace tactus::test;
using nlohmann::json;

namespace {

/// Does something every 5 ms, with the time in s since it began.
class Every {
public:
    explicit Every(std::function<void(double)> what)
        : thread_([this, what = std::move(what)] {
              const auto begin = std::chrono::steady_clock::now();
              while (!ends_) {
                  what(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
                  std::this_thread::sleep_for(std::chrono::milliseconds(5));
              }
          }) {}
    ~Every() {
        ends_ = true;
        thread_.join();
    }

private:
    std::atomic<bool> ends_{false};
    std::thread thread_;
};

/// Where the hand is: 10 mm to and fro once a second.
Vec3 place_at(double t) { return {0.01 * std::sin(6.283 * t), -0.1, 0.0}; }

/// How far a recorded pose went from where it began, in m.
double farthest(const fs::path& csv) {
    std::istringstream rows(slurp(csv));
    std::string row;
    std::getline(rows, row);  // names
    std::optional<Vec3> first;
    double far = 0.0;
    while (std::getline(rows, row)) {
        double t = 0.0;
        Vec3 at(0.0);
        if (std::sscanf(row.c_str(), "%lf,%lf,%lf,%lf", &t, &at.x, &at.y, &at.z) != 4) continue;
        if (!first) first = at;
        far = std::max(far, glm::length(at - *first));
    }
    return far;
}

/// What a patch keeps of the hand, and what keeps it away from forces.
struct Scene {
    const char *patch, *pose, *rest;
    std::vector<const char*> hands;  ///< nodes that name its device
};
/// Away from the bone: there a fault ends as soon as samples are back.
const Scene sawing{"saw-training", "pose.csv", " --set place.clearance=100mm", {"hand"}};
const Scene planning{"planning-trauma", nullptr, "", {"hand"}};
const Scene gripping{"gripper-on-arm", nullptr, "", {"arm", "arm_out"}};

/// The scene for 1 s with that driver, and its take again: the tool has moved, and the results are the same.
void runs_with(const Scene& scene, const std::string& driver, bool has_motors, const std::string& before = {}) {
    const Folder folder;
    CAPTURE(scene.patch, driver);
    ::setenv("XDG_CONFIG_HOME", (folder.path / "config").c_str(), 1);
    if (!before.empty()) ::setenv("LD_PRELOAD", before.c_str(), 1);
    // A busy machine makes ticks late; such a run ends with a fault, and is made again.
    Outcome run;
    fs::path take;
    for (int attempt = 0; attempt < 3 && run.code != 0; ++attempt) {
        take = folder.path / ("take" + std::to_string(attempt));
        std::string hands;
        for (const char* node : scene.hands) hands += " --set " + std::string(node) + ".device=" + driver;
        run = folder.tactus("run " + std::string(scene.patch) + hands + scene.rest +
                            " --audio none --seconds 1 --record " + take.string() + " --out " + take.string() + "-out");
    }
    ::unsetenv("LD_PRELOAD");
    ::unsetenv("XDG_CONFIG_HOME");
    INFO(run.out << run.err);
    REQUIRE(run.code == 0);
    if (scene.pose) CHECK(farthest(fs::path(take.string() + "-out") / scene.pose) > 2e-3);
    CHECK((run.err.find("untested on hardware: at most 0.5 N") != std::string::npos) == has_motors);
    const Outcome replay = folder.tactus("replay " + take.string() + " --json");
    INFO(replay.out << replay.err);
    REQUIRE(replay.code == 0);
    CHECK(json::parse(replay.out)["identical"] == true);
}

using Scenes = std::vector<Scene>;

void run_all(const Scenes& scenes, const std::string& driver, bool has_motors, const std::string& before = {}) {
    for (const Scene& scene : scenes) runs_with(scene, driver, has_motors, before);
}

void run_with_2diy(const Scenes& scenes) {
    const auto board = make_diy_peer();
    const Every moves([&](double t) { board->place(place_at(t), {1.0, 0.0, 0.0, 0.0}); });
    ::setenv("TACTUS_BOARD_PORT", line_of(*board).c_str(), 1);
    run_all(scenes, "haply_2diy", true);
    ::unsetenv("TACTUS_BOARD_PORT");
}

void run_with_inverse3(const Scenes& scenes) {
    std::optional<HaplyService> service;
    try {
        service.emplace(10001);  // where the driver looks
    } catch (const std::runtime_error& error) {
        return skip(error.what());
    }
    const Every moves([&](double t) { service->move(place_at(t), {1.0, 0.0, 0.0, 0.0}); });
    run_all(scenes, "haply", true);
    CHECK(service->texts > 100);
}

void run_with_3d_mouse(const Scenes& scenes) {
    SpaceDaemon daemon;
    ::setenv("SPNAV_SOCKET", daemon.path.c_str(), 1);
    {
        const Every steers([&](double t) {
            daemon.accept_now();
            daemon.send(motion(static_cast<int>(200.0 * std::sin(6.283 * t)), 0, 0, 0, 0, 0));
        });
        run_all(scenes, "space_mouse", false);
    }
    ::unsetenv("SPNAV_SOCKET");
}

void run_with_tracked_tool(const Scenes& scenes) {
    std::shared_ptr<openigtlink::TransformServer> server;
    try {
        server = openigtlink::TransformServer::at("127.0.0.1", 18944);  // where the driver looks
    } catch (const Error& error) {
        return skip(error.message());
    }
    const Every sends([&](double t) {
        Pose pose;
        pose.position = place_at(t);
        server->send(openigtlink::transform_message("Stylus", pose, t));
    });
    const Outcome probe = Folder().tactus("devices --probe openigtlink");
    INFO(probe.out << probe.err);
    CHECK(probe.out.find("the device has no motors") != std::string::npos);
    CHECK(probe.out.find("--verify") == std::string::npos);
    run_all(scenes, "openigtlink", false);
}

void run_with_board(const Scenes& scenes) {
    const auto board = make_frame_board_peer();
    const Every moves([&](double t) { board->place(place_at(t), {1.0, 0.0, 0.0, 0.0}); });
    ::setenv("TACTUS_BOARD_PORT", line_of(*board).c_str(), 1);
    // A board is a sector with one motor until its options say else: the hand moves along x.
    run_all(scenes, "serial_board", true);
    ::unsetenv("TACTUS_BOARD_PORT");
}

/// `kind`: of the event device that the driver finds.
void run_with_event_device(const std::string& driver, const char* kind, const Scenes& scenes) {
    const fs::path library = fs::path(command()).parent_path() / "tests/libevent_device.so";
    const Folder devices;
    devices.write("event7", "");
    ::setenv("FAKE_EVENT_FOLDER", devices.path.c_str(), 1);
    ::setenv("FAKE_EVENT_DEVICE", kind, 1);
    run_all(scenes, driver, driver == "wheel", library.string());
    // At most 0.5 N of 30 N m at 140 mm, until somebody has confirmed it.
    if (fs::exists(devices.path / "strength") && driver == "wheel")
        CHECK(std::stoi(slurp(devices.path / "strength")) <= std::lround(32767.0 * 0.5 * 0.14 / 30.0));
    ::unsetenv("FAKE_EVENT_FOLDER");
    ::unsetenv("FAKE_EVENT_DEVICE");
}

}  // namespace

// Each driver once, each scene with two drivers or three.
// Costly: a live run and its replay for each driver.
TEST_CASE("a scene of the library runs with a board and a 2diy, and its take repeats it", "[live]") {
    run_with_board({planning});
    run_with_2diy({sawing});
}

TEST_CASE("a scene of the library runs with an Inverse3, and its take repeats it", "[live]") {
    run_with_inverse3({gripping});
}

// Costly: a live run and its replay for each driver.
TEST_CASE("a scene of the library runs with a 3D mouse, and its take repeats it", "[live]") {
    run_with_3d_mouse({planning});
}

// Costly: a live run and its replay for each driver.
TEST_CASE("a scene of the library runs with a tracked tool, and its take repeats it", "[live]") {
    run_with_tracked_tool({sawing});
}

// Costly: a live run and its replay for each driver.
TEST_CASE("a scene of the library runs with a wheel and with a gamepad, and its take repeats it", "[live]") {
    run_with_event_device("wheel", "wheel", {gripping});
    run_with_event_device("gamepad", "pad", {sawing});
}

TEST_CASE("every scene of the library runs with every device, and its take repeats it", "[long][kernel]") {
    const Scenes all{sawing, planning, gripping};
    run_with_board(all);
    run_with_2diy(all);
    run_with_inverse3(all);
    run_with_3d_mouse(all);
    run_with_tracked_tool(all);
    run_with_event_device("wheel", "wheel", all);
    run_with_event_device("gamepad", "pad", all);
}
