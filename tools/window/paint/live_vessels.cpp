// SPDX-License-Identifier: Apache-2.0
#include "tools/window/paint/live_vessels.hpp"

#include "assets/vessel/course_file.hpp"
#include "assets/vessel/track_file.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <exception>
#include <utility>

namespace tactus::window {

LiveVessels::LiveVessels(const volume::Grid& grid, vessel::TrackSettings settings, std::filesystem::path stem)
    : grid_(grid), settings_(std::move(settings)), stem_(std::move(stem)) {
    for (int number = 1; std::filesystem::exists(file_of(number, ".csv")); ++number)
        found_.push_back(std::make_shared<const LiveVessel>(read(number)));
    thread_ = std::thread([this] { work(); });
}

std::filesystem::path LiveVessels::file_of(int number, const char* ending) const {
    return fmt::format("{}-vessel-{}{}", stem_.string(), number, ending);
}

LiveVessel LiveVessels::read(int number) const {
    LiveVessel out;
    out.number = number;
    out.is_from_before = true;
    const std::filesystem::path file = file_of(number, ".csv");
    try {
        const vessel::Course course = vessel::load_course(file);
        vessel::Branch branch;
        for (std::size_t n = 0; n < course.points.size(); ++n) {
            vessel::Node node;
            node.position = course.points[n];
            node.radius = course.radius[n];
            if (n > 0) node.along = branch.nodes[n - 1].along + glm::length(course.points[n] - course.points[n - 1]);
            branch.nodes.push_back(node);
        }
        out.seed = course.points.front();
        out.track.branches.push_back(std::move(branch));
        out.files.push_back(file);
        out.words = fmt::format("{} is continued", file.string());
    } catch (const std::exception& failure) {
        out.words = failure.what();
    }
    return out;
}

LiveVessels::~LiveVessels() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void LiveVessels::ask(const Vec3& seed) {
    {
        const std::lock_guard lock(mutex_);
        waiting_.push_back(seed);
    }
    wake_.notify_one();
}

bool LiveVessels::is_busy() const {
    const std::lock_guard lock(mutex_);
    return is_working_ || !waiting_.empty();
}

std::vector<std::shared_ptr<const LiveVessel>> LiveVessels::found() const {
    const std::lock_guard lock(mutex_);
    return found_;
}

LiveVessel LiveVessels::followed(const Vec3& seed) const {
    LiveVessel out;
    out.seed = seed;
    try {
        vessel::Followed result = vessel::follow(grid_, seed, settings_);
        if (result.track.branches.empty()) {
            out.words = result.why;
            return out;
        }
        out.track = std::move(result.track);
        out.words = fmt::format("{} branch{}, {:.1f} mm in all", out.track.branches.size(),
                                out.track.branches.size() == 1 ? "" : "es", out.track.length() * 1e3);
        int number = 1;
        while (std::filesystem::exists(file_of(number, ".csv")) ||
               std::filesystem::exists(file_of(number, ".mrk.json")))
            ++number;
        for (const char* const ending : {".csv", ".mrk.json"}) {
            vessel::write_track(out.track, file_of(number, ending));
            out.files.push_back(file_of(number, ending));
        }
        out.number = number;
        out.words += fmt::format("; written to {}", out.files.front().string());
    } catch (const std::exception& failure) {
        out.words = failure.what();
    }
    return out;
}

void LiveVessels::work() {
    for (;;) {
        Vec3 seed;
        {
            std::unique_lock lock(mutex_);
            is_working_ = false;
            wake_.wait(lock, [&] { return ends_ || !waiting_.empty(); });
            if (waiting_.empty()) return;
            seed = waiting_.front();
            waiting_.pop_front();
            is_working_ = true;
        }
        auto answer = std::make_shared<const LiveVessel>(followed(seed));
        const std::lock_guard lock(mutex_);
        found_.push_back(std::move(answer));
    }
}

}  // namespace tactus::window
