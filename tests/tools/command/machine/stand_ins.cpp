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

/// Saw training for 1 s with that driver, and its take again: the tool has moved, and the results are the same.
void saws_with(const std::string& driver, bool has_motors) {
    const Folder folder;
    ::setenv("XDG_CONFIG_HOME", (folder.path / "config").c_str(), 1);
    // A busy machine makes ticks late; such a run ends with a fault, and is made again.
    Outcome run;
    fs::path take;
    for (int attempt = 0; attempt < 3 && run.code != 0; ++attempt) {
        take = folder.path / ("take" + std::to_string(attempt));
        // Away from the bone: there a fault ends as soon as samples are back.
        run = folder.tactus("run saw-training --set hand.device=" + driver +
                            " --set place.clearance=100mm --audio none --seconds 1 --record " + take.string() +
                            " --out " + take.string() + "-out");
    }
    ::unsetenv("XDG_CONFIG_HOME");
    INFO(run.out << run.err);
    REQUIRE(run.code == 0);
    CHECK(farthest(fs::path(take.string() + "-out") / "pose.csv") > 2e-3);
    CHECK((run.err.find("untested on hardware: at most 0.5 N") != std::string::npos) == has_motors);
    const Outcome replay = folder.tactus("replay " + take.string() + " --json");
    INFO(replay.out << replay.err);
    REQUIRE(replay.code == 0);
    CHECK(json::parse(replay.out)["identical"] == true);
}

}  // namespace

TEST_CASE("saw training runs with a 2diy, and its take repeats it", "[live]") {
    const auto board = make_diy_peer();
    const Every moves([&](double t) { board->place(place_at(t), {1.0, 0.0, 0.0, 0.0}); });
    ::setenv("TACTUS_BOARD_PORT", line_of(*board).c_str(), 1);
    saws_with("haply_2diy", true);
    ::unsetenv("TACTUS_BOARD_PORT");
}

TEST_CASE("saw training runs with an Inverse3, and its take repeats it", "[live]") {
    std::optional<HaplyService> service;
    try {
        service.emplace(10001);  // where the driver looks
    } catch (const std::runtime_error& error) {
        return skip(error.what());
    }
    const Every moves([&](double t) { service->move(place_at(t), {1.0, 0.0, 0.0, 0.0}); });
    saws_with("haply", true);
    CHECK(service->texts > 100);
}

TEST_CASE("saw training runs with a 3D mouse, and its take repeats it", "[live]") {
    SpaceDaemon daemon;
    ::setenv("SPNAV_SOCKET", daemon.path.c_str(), 1);
    {
        const Every steers([&](double t) {
            daemon.accept_now();
            daemon.send(motion(static_cast<int>(200.0 * std::sin(6.283 * t)), 0, 0, 0, 0, 0));
        });
        saws_with("space_mouse", false);
    }
    ::unsetenv("SPNAV_SOCKET");
}

TEST_CASE("saw training runs with a tracked tool, and its take repeats it", "[live]") {
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
    saws_with("openigtlink", false);
}
