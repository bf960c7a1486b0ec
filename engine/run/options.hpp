// SPDX-License-Identifier: Apache-2.0
// Options of a run, and the result of an edit.
#pragma once

#include "engine/io/frames.hpp"
#include "engine/io/host.hpp"
#include "engine/take/take_writer.hpp"
#include "graph/compile/schedule.hpp"

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

/// Returns the destination for every value of a group's outputs, as frames of that layout, or null.
using TapMaker = std::function<std::unique_ptr<io::Sink>(const io::FrameLayout&, const GroupRuntime&)>;

/// The values in a take. Its decisions repeat them to the bit.
enum class TakeValues : std::uint8_t {
    all,  ///< from the begin, up to the end that TakeWriter::limit_values sets
    on_request,  ///< none until `Engine::record`; the take is not wanted before that, and may be given up until then
};

struct EngineOptions {
    double seconds = 1.0;
    int block = 0;               ///< most samples per call of an audio group, 0: the patch's quantum
    bool random_blocks = false;  ///< calls of random length up to `block`, for tests
    std::optional<std::filesystem::path> folder;  ///< folder of the recordings; empty: nothing is recorded
    const take::TimingLog* replay = nullptr;      ///< repeats the timing decisions of a live run
    const std::vector<io::RecordedDevice>* devices =
        nullptr;  ///< stand-ins for the devices of the run that is replayed
    take::TakeWriter* take = nullptr;                          ///< records the run
    TakeValues take_values = TakeValues::all;
    std::uint64_t longest_journal = std::uint64_t{4}
                                    << 30;  ///< maximum bytes of decisions of a take that is not wanted yet
    observe::Observer* observer = nullptr;  ///< receives copies of values; does not affect the run
    /// For `check`: builds the plan without running it. Hardware is not opened, and a plan that is too stiff is not
    /// rejected.
    bool only_checked = false;
    bool live = false;
    io::AudioChoice audio;  ///< live only
    bool hash = true;  ///< keep `output_hash`; costs about as much per sample of a signal as a trivial node
    bool time_nodes = true;  ///< keep the time of each node, from one call in 64
    TapMaker tap;  ///< where every value of the outputs goes, after the take: replay compares, experiments measure
};

struct LiveOptions {
    double dilate = 1.0;  ///< real seconds per logical second
    std::optional<std::filesystem::path> log;  ///< file for timing decisions
    const std::atomic<bool>* stop = nullptr;  ///< set by another thread to end the run early
    std::function<void()> watch;  ///< called about every 20 ms by the control thread
};

/// The result of an edit.
struct EditOutcome {
    std::optional<std::string> error;  ///< reason why the old plan continues
    std::int64_t generation = 0;
    Flicks when = 0;  ///< logical time of the switch
    std::size_t kept = 0, nodes = 0;  ///< surviving nodes, and all nodes
};

using PortHashes = std::vector<std::pair<std::string, std::uint64_t>>;

}  // namespace tactus::run
