// SPDX-License-Identifier: Apache-2.0
// Labels that follow what is painted: random walks on a thread of their own. No user interface.
#pragma once

#include "assets/segmentation/seeds_file.hpp"
#include "dsp/segmentation/random_walk.hpp"
#include "tools/analysis/segmentation/segment_scan.hpp"

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace tactus::window {

/// What the walks found for one version of the painting. Per node of the graph.
struct LiveLabelling {
    int version = 0;
    int number = 0;           ///< of all answers of a LiveLabels, from 1
    bool is_preview = false;  ///< labels by a watershed, without certainty; those of the walks follow
    std::vector<std::uint8_t> seed;   ///< 0: none
    std::vector<std::uint8_t> label;  ///< 0: none; empty when there is a problem
    std::vector<float> certainty;
    std::vector<std::size_t> voxels;  ///< of each label
    std::vector<analysis::UncertainPlace> uncertain;  ///< below 0.4, largest first
    std::vector<analysis::UnseededIsland> islands;    ///< that no seed reaches, largest first
    double residual = 0.0;
    int iterations = 0;
    double seconds = 0.0;  ///< from the start of the work to its end
    std::string problem;   ///< why there are no labels; empty: there are
};

/// Labels of one painting: seeds, walks, certainty. `before`: the walks of an earlier painting of as many labels, which make
/// this one faster; set to those found. `preview`: called with labels by a watershed before the walks begin.
LiveLabelling live_labelling(const analysis::ScanGraph& scan, const std::vector<segmentation::SeedLabel>& labels,
                             std::optional<segmentation::Walks>& before, const RunJobs& run,
                             const std::function<void(LiveLabelling)>& preview = {});

/// Solves on a thread of its own, which lets others go first. `scan` must outlive it. The newest question replaces one that waits; nothing waits for the
/// solver but the destructor. A preview is shown where the walks have nothing to begin with, or took over 0.4 s before.
class LiveLabels {
public:
    explicit LiveLabels(const analysis::ScanGraph& scan, RunJobs run = run_in_turn);
    ~LiveLabels();
    LiveLabels(const LiveLabels&) = delete;
    LiveLabels& operator=(const LiveLabels&) = delete;

    void ask(int version, std::vector<segmentation::SeedLabel> labels);
    /// The newest answer; null before the first.
    std::shared_ptr<const LiveLabelling> latest() const;
    bool is_busy() const;

private:
    struct Question {
        int version;
        std::vector<segmentation::SeedLabel> labels;
    };
    void work();
    void show(LiveLabelling answer);

    const analysis::ScanGraph& scan_;
    RunJobs run_;
    int shown_ = 0;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::optional<Question> waiting_;
    bool is_working_ = false, ends_ = false;
    std::shared_ptr<const LiveLabelling> latest_;
    std::thread thread_;
};

}  // namespace tactus::window
