// SPDX-License-Identifier: Apache-2.0
// A take that is looked at, at any instant: its values from its recordings, its bones from one repetition of the run, of
// which all that changed is kept.
#pragma once

#include "engine/observe/observer.hpp"
#include "engine/take/take_reader.hpp"
#include "graph/compile/load_assets.hpp"
#include "tools/view/signal/feed.hpp"

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>

namespace tactus::view {

class TakeBench {
public:
    /// Throws Error when the folder is no take.
    explicit TakeBench(const std::filesystem::path& folder);
    ~TakeBench();

    const take::Take& take() const { return take_; }
    TakeFeed& feed() { return feed_; }
    double time() const { return feed_.now(); }
    double length() const { return feed_.length(); }
    void go_to(double seconds);
    void play(bool wanted) { is_playing_ = wanted; }
    bool is_playing() const { return is_playing_; }
    /// Once per picture: `elapsed` s of real time since the last.
    void tend(double elapsed);

    /// What the run had made of the scene by then, null before it is there at all.
    std::shared_ptr<observe::Observer> scene() const;
    /// The run was repeated up to here, s; beyond, the scene stands still.
    double repeated() const;
    bool scene_is_there() const;  ///< of the time that is shown
    std::string scene_note() const;

private:
    void work();
    void show_scene();

    take::Take take_;
    TakeFeed feed_;
    compile::AssetCache assets_;
    const std::set<std::string> scene_ports_;
    bool is_playing_ = false;
    mutable std::mutex lock_;
    double repeated_ = -1.0;
    bool is_whole_ = false;
    std::shared_ptr<observe::Observer> scene_;
    std::string problem_, doubt_;
    std::atomic<bool> ends_{false};
    std::jthread thread_;
};

}  // namespace tactus::view
