// SPDX-License-Identifier: Apache-2.0
#include "tools/window/slices/live_labels.hpp"

#include "dsp/segmentation/strokes.hpp"
#include "dsp/segmentation/uncertain.hpp"
#include "dsp/segmentation/watershed.hpp"
#include "tools/analysis/beside.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

namespace tactus::window {

namespace {

/// Why these seeds cannot be solved; empty: they can.
std::string problem_of(const std::vector<std::uint8_t>& seed, const std::vector<segmentation::SeedLabel>& labels) {
    std::vector<char> is_there(labels.size() + 1, 0);
    for (const std::uint8_t s : seed) is_there[s] = 1;
    std::size_t painted = 0;
    for (std::size_t l = 0; l < labels.size(); ++l) {
        painted += is_there[l + 1] != 0;
        if (is_there[l + 1] == 0 && !labels[l].strokes.empty())
            return fmt::format("later labels are painted over all strokes of '{}'", labels[l].name);
    }
    if (painted >= 2) return "";
    return painted == 0 ? "paint a place of each fragment" : "paint a place of a second fragment";
}

std::vector<std::size_t> voxels_of(const std::vector<std::uint8_t>& label, std::size_t labels) {
    std::vector<std::size_t> count(labels, 0);
    for (const std::uint8_t l : label)
        if (l != 0) ++count[l - 1u];
    return count;
}

}  // namespace

LiveLabelling live_labelling(const analysis::ScanGraph& scan, const std::vector<segmentation::SeedLabel>& labels,
                             std::optional<segmentation::Walks>& before, const RunJobs& run,
                             const std::function<void(LiveLabelling)>& preview) {
    const auto begin = std::chrono::steady_clock::now();
    const auto since = [begin] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    LiveLabelling out;
    out.seed.assign(scan.graph.nodes(), 0);
    for (std::size_t l = 0; l < labels.size(); ++l)
        for (std::size_t s = 0; s < labels[l].strokes.size(); ++s)
            if (segmentation::paint(scan.box, scan.node_of_voxel, labels[l].strokes[s],
                                    static_cast<std::uint8_t>(l + 1), out.seed) == 0 &&
                out.problem.empty())
                out.problem = fmt::format(
                    "stroke {} of '{}' touches no bone from {:g} on: erase it, or end and choose "
                    "another --threshold",
                    s + 1, labels[l].name, scan.threshold);
    if (out.problem.empty()) out.problem = problem_of(out.seed, labels);
    if (out.problem.empty()) {
        const int count = static_cast<int>(labels.size());
        const bool is_warm = before && before->labels == count;
        segmentation::GapLaw law;
        const std::unique_ptr<segmentation::VoxelGraph> own = analysis::graph_for_seeds(scan, out.seed, law);
        if (preview) {
            LiveLabelling first;
            first.is_preview = true;
            first.seed = out.seed;
            first.label = segmentation::watershed(own ? *own : scan.graph, out.seed);
            first.voxels = voxels_of(first.label, labels.size());
            first.seconds = since();
            preview(std::move(first));
        }
        before =
            segmentation::random_walks(own ? *own : scan.graph, out.seed, count, {}, is_warm ? &*before : nullptr, run);
        out.residual = before->residual;
        out.iterations = before->iterations;
        out.label = segmentation::labels_of(*before);
        out.certainty = segmentation::certainty_of(*before);
        out.voxels = voxels_of(out.label, labels.size());
        std::vector<float> of_labelled = out.certainty;
        for (std::size_t n = 0; n < out.label.size(); ++n)
            if (out.label[n] == 0) of_labelled[n] = 1.0f;
        out.islands = analysis::islands_of(scan, out.label);
        for (const segmentation::UncertainRegion& region : segmentation::uncertain_regions(scan.graph, of_labelled))
            out.uncertain.push_back(
                {region.nodes, scan.box.position(region.deepest[0], region.deepest[1], region.deepest[2])});
    }
    out.seconds = since();
    return out;
}

LiveLabels::LiveLabels(const analysis::ScanGraph& scan, RunJobs run)
    : scan_(scan), run_(std::move(run)), thread_([this] { work(); }) {}

LiveLabels::~LiveLabels() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void LiveLabels::ask(int version, std::vector<segmentation::SeedLabel> labels) {
    {
        const std::lock_guard lock(mutex_);
        waiting_ = Question{version, std::move(labels)};
    }
    wake_.notify_one();
}

std::shared_ptr<const LiveLabelling> LiveLabels::latest() const {
    const std::lock_guard lock(mutex_);
    return latest_;
}

bool LiveLabels::is_busy() const {
    const std::lock_guard lock(mutex_);
    return is_working_ || waiting_;
}

void LiveLabels::show(LiveLabelling answer) {
    answer.number = ++shown_;
    const std::lock_guard lock(mutex_);
    latest_ = std::make_shared<const LiveLabelling>(std::move(answer));
}

void LiveLabels::work() {
    analysis::let_others_go_first();
    constexpr double slow = 0.4;  // s; a hand does not wait for less
    std::optional<segmentation::Walks> before;
    double last = 0.0;
    for (;;) {
        Question question;
        {
            std::unique_lock lock(mutex_);
            is_working_ = false;
            wake_.wait(lock, [&] { return ends_ || waiting_; });
            if (ends_) return;
            question = std::move(*waiting_);
            waiting_.reset();
            is_working_ = true;
        }
        LiveLabelling answer;
        try {
            const bool is_warm = before && before->labels == static_cast<int>(question.labels.size());
            std::function<void(LiveLabelling)> preview;
            if (!is_warm || last > slow)
                preview = [&](LiveLabelling labels) {
                    labels.version = question.version;
                    show(std::move(labels));
                };
            answer = live_labelling(scan_, question.labels, before, run_, preview);
            last = answer.seconds;
        } catch (const std::exception& failure) {
            before.reset();
            answer.problem = failure.what();
        }
        answer.version = question.version;
        show(std::move(answer));
    }
}

}  // namespace tactus::window
