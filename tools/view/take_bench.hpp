// SPDX-License-Identifier: Apache-2.0
// A take that is looked at, at any instant: its values from its recordings, its bones by running it again up to there.
#pragma once

#include "engine/observer.hpp"
#include "engine/take_reader.hpp"
#include "graph/load_assets.hpp"
#include "tools/view/feed.hpp"

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

namespace tactus::view {

class TakeBench {
public:
    /// Throws Error when the folder is no take.
    explicit TakeBench(const std::filesystem::path& folder);
    ~TakeBench();

    const Take& take() const { return take_; }
    TakeFeed& feed() { return feed_; }
    double time() const { return feed_.now(); }
    double length() const { return feed_.length(); }
    void go_to(double seconds);
    void play(bool wanted) { is_playing_ = wanted; }
    bool is_playing() const { return is_playing_; }
    /// Once per picture: `elapsed` s of real time since the last.
    void tend(double elapsed);

    /// What the run had made of the scene by the time of `scene_time`, null before it was there once.
    std::shared_ptr<Observer> scene() const;
    double scene_time() const;
    bool scene_is_there() const;  ///< of the time that is shown
    std::string scene_note() const;

private:
    void work();
    void repeat_until(double seconds);

    Take take_;
    TakeFeed feed_;
    AssetCache assets_;
    const std::set<std::string> scene_ports_;
    bool is_playing_ = false;
    mutable std::mutex lock_;
    double wanted_ = 0.0, made_ = -1.0;
    std::shared_ptr<Observer> made_scene_;
    std::string problem_;
    std::atomic<bool> ends_{false};
    std::jthread thread_;
};

}  // namespace tactus::view
