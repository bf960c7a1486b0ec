// SPDX-License-Identifier: Apache-2.0
// What a trainee needs: the task, a large force meter with limits, depth, time, the score, and "again".
#pragma once

#include "assets/training/task_file.hpp"
#include "engine/observe/observer.hpp"
#include "tools/window/document/workbench.hpp"
#include "tools/window/training/score_card.hpp"
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

    /// Where the planned cut begins and leads, m, until the blade has touched the bone for a while; none: no task runs.
    struct FirstCut {
        Vec3 entry, within;
    };
    std::optional<FirstCut> first_cut() const;

private:
    void follow(const std::shared_ptr<observe::Observer>& observer);
    void meter(const Fonts& fonts, double force) const;
    void figures(const Fonts& fonts);
    void result(const Fonts& fonts);
    void score_table(const Fonts& fonts) const;
    double number(const std::string& port) const;  ///< NaN: none
    bool flag(const std::string& port) const;

    Workbench& bench_;
    std::shared_ptr<observe::Observer> observer_;
    std::int64_t plan_version_ = -1;
    std::string node_, depth_;  ///< the task node; the port with the depth where there is none
    std::string wrench_;  ///< the port with the force of the tool
    std::optional<training::TaskFile> task_;
    double limit_N_ = 0.0, max_N_ = 20.0;  ///< of the task, 0: none; of the device
    std::vector<std::string> watched_;
    double peak_N_ = 0.0;
    int scored_run_ = -1;
    std::future<ScoreCard> scoring_;
    std::optional<ScoreCard> score_;
    std::string said_;  ///< in place of a score
    std::vector<ScoreCard> earlier_;  ///< scores of attempts in this window
};

}  // namespace tactus::window
