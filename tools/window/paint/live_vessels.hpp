// SPDX-License-Identifier: Apache-2.0
// Vessels that are followed from a click, on a thread of their own. No user interface.
#pragma once

#include "dsp/vessel/tracker.hpp"

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tactus::window {

struct LiveVessel {
    Vec3 seed{0.0};
    vessel::Track track;       ///< without branches when nothing was found
    std::string words;         ///< what was found, or why not; one line
    std::vector<std::filesystem::path> files;
    int number = 0;            ///< of its files; 0: there are none
    bool is_from_before = false;  ///< its main branch was read from the file of an earlier session
};

class LiveVessels {
public:
    /// `grid` must outlive it. `stem`: results are written as STEM-vessel-1.csv and .mrk.json, and on; numbers of files that
    /// exist are left out. Vessels in such tables are the first answers.
    LiveVessels(const volume::Grid& grid, vessel::TrackSettings settings, std::filesystem::path stem);
    /// Follows what was asked for, so that its files are there.
    ~LiveVessels();
    LiveVessels(const LiveVessels&) = delete;
    LiveVessels& operator=(const LiveVessels&) = delete;

    void ask(const Vec3& seed);
    bool is_busy() const;
    /// All answers so far, in the order of the questions.
    std::vector<std::shared_ptr<const LiveVessel>> found() const;

private:
    void work();
    LiveVessel followed(const Vec3& seed) const;
    LiveVessel read(int number) const;
    std::filesystem::path file_of(int number, const char* ending) const;

    const volume::Grid& grid_;
    vessel::TrackSettings settings_;
    std::filesystem::path stem_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<Vec3> waiting_;
    bool is_working_ = false, ends_ = false;
    std::vector<std::shared_ptr<const LiveVessel>> found_;
    std::thread thread_;
};

}  // namespace tactus::window
