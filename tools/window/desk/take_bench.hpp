// SPDX-License-Identifier: Apache-2.0
// Random access to a take: values come from its recordings, bones from one repetition of the run with a history of all
// changes.
#pragma once

#include "engine/observe/observer.hpp"
#include "engine/take/take_reader.hpp"
#include "graph/compile/load_assets.hpp"
#include "tools/run/run_choice.hpp"
#include "tools/window/signal/feed.hpp"

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>

namespace tactus::window {

/// Opens the patch of a take. Its text lies in the folder of the take, but its relative paths start at the patch that was
/// recorded: so do the assets, the task among them.
run::RunChoice choice_of(const take::Take& take);

class TakeBench {
public:
    /// Throws Error when the folder is not a take.
    explicit TakeBench(const std::filesystem::path& folder);
    ~TakeBench();

    const take::Take& take() const { return take_; }
    TakeFeed& feed() { return feed_; }
    double time() const { return feed_.now(); }
    double length() const { return feed_.length(); }
    void go_to(double seconds);
    void play(bool wanted) { is_playing_ = wanted; }
    bool is_playing() const { return is_playing_; }
    /// Called once per frame; `elapsed`: real time since the last call, s.
    void tend(double elapsed);

    /// The scene at the current time; null before the repetition has started.
    std::shared_ptr<observe::Observer> scene() const;
    /// The run is repeated up to this time, s; later the scene does not change.
    double repeated() const;
    bool scene_is_there() const;  ///< true when the scene of the shown time is complete
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

}  // namespace tactus::window
