// SPDX-License-Identifier: Apache-2.0
// A patch inside another program, and one run of it. What tactus.h offers, for C++; a thin layer over the engine.
#pragma once

#include "engine/observe/observer.hpp"
#include "engine/run/engine.hpp"
#include "graph/compile/load_assets.hpp"
#include "tools/embed/host_hand.hpp"
#include "tools/run/output_folder.hpp"
#include "tools/run/patch_choice.hpp"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace tactus::embed {

class CallbackFailure;

/// Errors of a patch: the place and text of the first, and all of them.
class PatchErrors : public Error {
public:
    explicit PatchErrors(const patch::Problems& problems);
    const std::string& all() const { return all_; }  ///< one per line

private:
    std::string all_;
};

class Patch {
public:
    /// Reads and compiles it. Throws PatchErrors.
    explicit Patch(run::PatchChoice choice);

    /// "blade.stiffness=0.5 N/mm". Throws PatchErrors; then nothing has changed.
    void configure(const std::string& setting);
    /// "bone=jaw.vdb". Likewise.
    void use_asset(const std::string& asset);
    /// The program moves this device. Throws Error when the patch has none of that name.
    void attach_hand(const std::string& name, const DeviceInfo& info);

    struct Hand {
        std::string name;
        DeviceInfo info;
    };
    const std::vector<Hand>& hands() const { return hands_; }

    /// For one run: the hands' devices are those of `links`, in the order of `hands`. Assets are loaded once and kept.
    /// Throws PatchErrors.
    compile::Schedule plan(const std::vector<std::unique_ptr<HostHand>>& links, std::uint64_t seed);

private:
    void change(run::PatchChoice changed);

    run::PatchChoice choice_;
    std::vector<Hand> hands_;
    compile::AssetCache assets_;
};

struct RunOptions {
    double seconds = 0.0;  ///< of `render` and of a live run; 0: until `finish`
    std::uint64_t seed = 0;  ///< 0: the patch's
    std::optional<std::filesystem::path> folder;
    std::string audio = "none";
    bool live = false;
    int threads = 0;  ///< of `render`; 0: as many as the machine has
};

/// One thread at a time, but for what is said to be for any.
class Run {
public:
    /// Prepares all nodes; a live run begins. Throws Error.
    Run(Patch& patch, RunOptions options);
    ~Run();
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;

    /// See tactus.h. Throw Error; after a callback of the program failed, always that failure.
    void advance(double seconds);
    void render();
    void set(const std::string& node_and_parameter, const std::string& value);
    /// Ends the run and writes its results. Throws Error when something could not be written, or a live run failed.
    void finish();

    double time() const;
    int find_hand(const std::string& name) const;
    /// Any thread; null: no such hand.
    HostHand* hand(int number);

    struct Output {
        std::string port;
        const ValueType* type = nullptr;
        double rate = 0.0;  ///< Hz
        std::vector<std::string> names;  ///< of its columns
        bool every = false;
        observe::SeenValues values;  ///< fetched from the observer and not yet from here
        std::size_t taken = 0;  ///< of them
    };
    /// Of the outputs that have columns, in order; empty: there are fewer.
    std::string output_name(int index) const;
    int output(const std::string& port, bool every);
    /// Null: no such output. Valid as long as the run.
    Output* find_output(int number);
    /// Any thread.
    void newest(const Output& output, double* values);
    std::size_t available(Output& output);
    std::size_t fetch(Output& output, double* times, double* values, std::size_t max);

    bool is_finished() const { return is_finished_; }
    const std::string& summary() const { return summary_; }
    std::uint64_t hash() const { return engine_->output_hash(); }

private:
    enum class Way : std::uint8_t { none, advanced, rendered, live };
    void go(Way way);
    void run_live();
    void tend();
    void take_in(Output& output);
    /// Throws the failure of a callback of the program's own nodes; the run is then over.
    void check_callbacks();

    struct Task {
        std::function<void()> work;
        std::exception_ptr failure;
        bool is_done = false;
    };

    RunOptions options_;
    std::vector<std::string> hand_names_;
    std::vector<std::unique_ptr<HostHand>> hands_;
    std::optional<run::OutputFolder> folder_;
    observe::Observer observer_;
    std::unique_ptr<CallbackFailure> callbacks_;
    std::unique_ptr<run::Engine> engine_;
    std::deque<Output> outputs_;
    Way way_ = Way::none;
    Flicks now_ = 0;  // of `advance`
    double asked_s_ = 0.0;  // the sum of what `advance` was asked for
    bool is_finished_ = false;
    std::string summary_;

    std::atomic<bool> stop_{false};
    std::mutex lock_;  // of the three below
    std::condition_variable changed_;
    std::deque<std::shared_ptr<Task>> tasks_;
    bool is_over_ = false;
    std::exception_ptr failure_;  // of the live run, or of a callback
    std::thread thread_;
};

}  // namespace tactus::embed
