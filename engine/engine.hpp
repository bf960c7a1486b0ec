// SPDX-License-Identifier: Apache-2.0
// Runs a plan: on a virtual clock as fast as it goes, or in real time. Both give the same output bits.
#pragma once

#include "engine/group_runtime.hpp"
#include "engine/outside.hpp"
#include "graph/plan.hpp"

#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tactus {

struct EngineOptions {
    double seconds = 1.0;
    int block = 0;                ///< most samples per call of an audio group, 0: the patch's quantum
    bool random_blocks = false;   ///< calls of random length up to `block`, for tests
    std::optional<std::filesystem::path> folder;  ///< where recordings go, none: nowhere
    const TimingLog* replay = nullptr;            ///< repeat what timing decided in a live run
    bool live = false;
    bool hash = true;  ///< keep `output_hash`; costs about as much per sample of a signal as a trivial node
};

struct LiveOptions {
    double dilate = 1.0;                             ///< real seconds per logical second
    std::optional<std::filesystem::path> log;        ///< where timing decisions are written
    const std::atomic<bool>* stop = nullptr;         ///< set from outside to end the run early
    std::function<void()> watch;                     ///< called about every 50 ms by the control thread
};

class Engine {
public:
    /// Takes the plan, prepares every node and lays out the wires. Assets must be loaded. Throws Error.
    Engine(Plan plan, const EngineOptions& options);
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    /// Runs to the end on `threads` threads; `progress` is told the fraction done. Throws Error.
    void render(int threads, const std::function<void(double)>& progress = {});
    /// Runs in real time, one thread per group. Throws Error. Engines run once.
    void run_live(const LiveOptions& options);

    /// Completes recordings. Throws Error.
    void finish();

    /// What the nodes report. After the run.
    Report report() const;
    /// Hash over every published value of every output, joined in name order. After the run.
    std::uint64_t output_hash() const;
    /// The same, per output ("node.port").
    std::vector<std::pair<std::string, std::uint64_t>> port_hashes() const;

    const Plan& plan() const { return plan_; }
    const std::vector<std::unique_ptr<GroupRuntime>>& groups() const { return groups_; }
    const EngineOutside& outside() const { return *outside_; }
    std::uint64_t plan_hash() const;
    /// Logical time that every group has reached, s.
    double progress_seconds() const;

private:
    void allocate_outputs();
    void prepare_nodes();
    void wire_group(const PlanWire& wire, std::vector<std::vector<Drive>>& drives);
    void load_constant(const PlanWire& wire);
    Link& link_for(const PlanWire& wire);
    void make_steps(std::vector<std::vector<Drive>>& drives);
    std::vector<bool> vary_within_call() const;
    void set_ends();
    void drain_streams();
    void offline_worker(const std::vector<GroupRuntime*>& mine, std::uint64_t seed);
    void live_worker(GroupRuntime& group, std::int64_t start_ns, double dilate);
    void fail(std::exception_ptr error);

    EngineOptions options_;
    Plan plan_;
    std::unique_ptr<EngineOutside> outside_;
    std::vector<std::vector<std::byte>> buffers_;  // values of outputs, defaults of inputs, constants
    std::vector<std::shared_ptr<const void>> owners_;
    std::vector<std::unique_ptr<GroupRuntime>> groups_;
    std::vector<std::unique_ptr<Link>> links_;
    std::atomic<std::uint32_t> generation_{0};  // rises after every offline call
    std::atomic<bool> stop_{false};
    std::mutex failure_lock_;
    std::exception_ptr failure_;
};

}  // namespace tactus
