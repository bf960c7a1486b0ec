// SPDX-License-Identifier: Apache-2.0
// Options of a run, and the outcome of an edit.
#pragma once

#include "engine/io/frames.hpp"
#include "engine/io/host.hpp"
#include "engine/take/take_writer.hpp"
#include "graph/compile/plan.hpp"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::observe {
class Observer;
}

namespace tactus::run {

class GroupRuntime;

/// Says where every value of the outputs of a group goes, as frames of that layout, or null.
using TapMaker = std::function<std::unique_ptr<io::Sink>(const io::FrameLayout&, const GroupRuntime&)>;

struct EngineOptions {
    double seconds = 1.0;
    int block = 0;               ///< most samples per call of an audio group, 0: the patch's quantum
    bool random_blocks = false;  ///< calls of random length up to `block`, for tests
    std::optional<std::filesystem::path> folder;  ///< where recordings go; none: they are not kept
    const take::TimingLog* replay = nullptr;      ///< repeat what timing decided in a live run
    const std::vector<io::RecordedDevice>* devices =
        nullptr;  ///< stand-ins for the devices of the run that is repeated
    take::TakeWriter* take = nullptr;                          ///< records the run
    bool record_values = true;  ///< the take has them from the beginning; else from `Engine::record` on
    std::uint64_t longest_journal = std::uint64_t{4} << 30;  ///< bytes of decisions kept while no values are recorded
    observe::Observer* observer = nullptr;  ///< reads copies; changes nothing
    /// For `check`: the plan is built and never runs. Hardware is not opened, and a plan that is too stiff is not refused.
    bool only_checked = false;
    bool live = false;
    io::AudioChoice audio;  ///< live only
    bool hash = true;  ///< keep `output_hash`; costs about as much per sample of a signal as a trivial node
    bool time_nodes = true;  ///< keep the time of each node, from one call in 64
    TapMaker tap;  ///< where every value of the outputs goes, after the take: replay compares, experiments measure
};

struct LiveOptions {
    double dilate = 1.0;  ///< real seconds per logical second
    std::optional<std::filesystem::path> log;  ///< where timing decisions are written
    const std::atomic<bool>* stop = nullptr;  ///< set by another thread to end the run early
    std::function<void()> watch;  ///< called about every 20 ms by the control thread
};

/// The result of an edit.
struct EditOutcome {
    std::optional<std::string> error;  ///< why the old plan runs on
    std::int64_t generation = 0;
    Flicks when = 0;  ///< logical time of the switch
    std::size_t kept = 0, nodes = 0;  ///< nodes that go on, of all
};

using PortHashes = std::vector<std::pair<std::string, std::uint64_t>>;

}  // namespace tactus::run
