// SPDX-License-Identifier: Apache-2.0
// What a trainee needs: the task, a large force meter with limits, depth, time, the score, and "again".
#pragma once

#include "assets/training/task_file.hpp"
#include "engine/observe/observer.hpp"
#include "tools/window/document/workbench.hpp"
#include "tools/window/widgets/painter.hpp"

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::window {

class TrainPanel {
public:
    explicit TrainPanel(Workbench& bench) : bench_(bench) {}
    ~TrainPanel();
    TrainPanel(const TrainPanel&) = delete;
    TrainPanel& operator=(const TrainPanel&) = delete;

    /// `has_mouse`: the mouse moves the hand, and the panel says how.
    void draw(const std::shared_ptr<observe::Observer>& observer, bool has_mouse, const Fonts& fonts);

private:
    void follow(const std::shared_ptr<observe::Observer>& observer);
    void meter(const Fonts& fonts, double force) const;
    void figures(const Fonts& fonts);
    void result();
    double number(const std::string& port) const;  ///< NaN: none
    bool flag(const std::string& port) const;

    Workbench& bench_;
    std::shared_ptr<observe::Observer> observer_;
    std::int64_t plan_version_ = -1;
    std::string node_, depth_;  ///< the task node; the port with the depth where there is none
    std::optional<training::TaskFile> task_;
    double limit_N_ = 0.0, max_N_ = 20.0;  ///< of the task, 0: none; of the device
    std::vector<std::string> watched_;
    double peak_N_ = 0.0;
    int scored_run_ = -1;
    std::future<std::string> scoring_;
    std::string score_;
};

}  // namespace tactus::window
