// SPDX-License-Identifier: Apache-2.0
#include "tools/window/paint/hand_paint.hpp"

#include "dsp/core/error.hpp"
#include "tools/run/patch_choice.hpp"
#include "tools/window/paint/paint_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

namespace tactus::window {

namespace {

run::RunChoice choice_of(const std::filesystem::path& patch) {
    run::RunChoice choice;
    choice.patch = patch.string();
    return choice;
}

/// The label of that name. A painting without it gets it: first in place of one that nobody has named or painted.
std::size_t label_named(Painting& painting, const std::string& name) {
    const auto find = [&] {
        return static_cast<std::size_t>(std::ranges::find(painting.labels(), name, &segmentation::SeedLabel::name) -
                                        painting.labels().begin());
    };
    if (const std::size_t found = find(); found < painting.labels().size()) return found;
    const auto unused = std::ranges::find_if(painting.labels(), [](const segmentation::SeedLabel& label) {
        return label.strokes.empty() && label.name.starts_with("fragment_");
    });
    const std::size_t active = painting.active;
    if (unused != painting.labels().end())
        painting.rename(static_cast<std::size_t>(unused - painting.labels().begin()), name);
    else if (painting.add_label(name)) painting.active = active;  // the mouse goes on with its own
    return find();
}

}  // namespace

void BrushStrokes::take(const Vec3& kept, double radius, double points, Painting& painting) {
    if (radius != radius_) {
        end(painting);
        radius_ = radius;
    }
    if (points != points_ && radius != 0.0) {
        stroke_.radius = std::abs(radius);
        stroke_.points.push_back(kept);
    }
    points_ = points;
}

void BrushStrokes::end(Painting& painting) {
    const segmentation::Stroke stroke = std::exchange(stroke_, {});
    if (stroke.points.empty()) return;
    const std::size_t label = label_named(painting, label_);
    if (radius_ < 0.0) painting.erase_of(label, stroke);
    else painting.paint(label, stroke);
}

HandPaint::HandPaint(const std::filesystem::path& patch) : run_(choice_of(patch), assets_, observer_) {
    patch::Problems problems;
    for (const patch::PatchNode& node : run::read_choice(choice_of(patch), problems).nodes) {
        if (node.type != "brush") continue;
        const auto label = std::ranges::find(node.settings, "label", &OptionText::name);
        const bool is_named = label != node.settings.end() && !label->text.empty();
        brushes_.try_emplace(node.name, Brush{BrushStrokes(is_named ? label->text : node.name), {}, {}, {}});
        for (const char* const port : {".kept", ".kept_radius", ".kept_points"})
            observer_.watch(node.name + port, observe::Watch::every, this);
    }
    if (brushes_.empty())
        throw Error(fmt::format("{}: the patch has no node 'brush': nothing of it paints", patch.string()));
}

void HandPaint::take_in(const std::string& node, Brush& brush, PaintBench& bench) {
    observer_.fetch(node + ".kept", brush.kept);
    observer_.fetch(node + ".kept_radius", brush.radius);
    observer_.fetch(node + ".kept_points", brush.points);
    // Of each output the values that no other one has yet wait for the next picture.
    std::size_t k = 0, r = 0, p = 0;
    while (k < brush.kept.when.size() && r < brush.radius.when.size() && p < brush.points.when.size()) {
        const Flicks latest = std::max({brush.kept.when[k], brush.radius.when[r], brush.points.when[p]});
        const bool are_one =
            brush.kept.when[k] == latest && brush.radius.when[r] == latest && brush.points.when[p] == latest;
        if (are_one) {
            const double* const at = &brush.kept.columns[3 * k];
            brush.strokes.take({at[0], at[1], at[2]}, brush.radius.columns[r], brush.points.columns[p],
                               bench.painting());
        }
        k += are_one || brush.kept.when[k] < latest;
        r += are_one || brush.radius.when[r] < latest;
        p += are_one || brush.points.when[p] < latest;
    }
    const auto forget = [](observe::SeenValues& values, std::size_t count) {
        values.when.erase(values.when.begin(), values.when.begin() + static_cast<std::ptrdiff_t>(count));
        values.columns.erase(values.columns.begin(),
                             values.columns.begin() + static_cast<std::ptrdiff_t>(count * values.per_value));
    };
    forget(brush.kept, k);
    forget(brush.radius, r);
    forget(brush.points, p);
    const std::uint64_t lost = observer_.lost(node + ".kept");
    if (std::exchange(brush.lost, lost) != lost)
        bench.tell(fmt::format("the window was too slow for the hand: strokes of '{}' may lack points; the run's "
                               "seeds.json has all",
                               node),
                   true);
}

void HandPaint::take_in(PaintBench& bench) {
    observer_.advance();
    bench.open_by_hand.clear();
    for (auto& [node, brush] : brushes_) {
        take_in(node, brush, bench);
        if (!brush.strokes.open()) continue;
        bench.move_cursor(brush.strokes.open()->points.back());
        bench.open_by_hand.push_back(*brush.strokes.open());
    }
}

void HandPaint::tend(PaintBench& bench) {
    take_in(bench);
    for (const std::string& said : run_.messages()) bench.tell(said);
    const std::shared_ptr<const RunStatus> status = run_.status();
    std::int64_t missed = 0;
    for (const GroupStatus& group : status->groups) missed += group.missed;
    if (run_.is_over()) bench.hand_words = "the hand's patch has ended";
    else if (status->state == RunStatus::State::loading) bench.hand_words = "the hand's patch is loading";
    else
        bench.hand_words =
            fmt::format("hand: {:.1f} N, {}", status->force,
                        missed == 0 ? std::string("no late tick") : fmt::format("{} late ticks", missed));
    if (!run_.is_over() || std::exchange(has_told_end_, true)) return;
    failure_ = status->failure;
    if (!failure_.empty()) bench.tell(failure_, true);
}

void HandPaint::end(PaintBench& bench) {
    run_.stop();
    while (!run_.is_over()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    take_in(bench);
    for (auto& [node, brush] : brushes_) brush.strokes.end(bench.painting());
    failure_ = run_.status()->failure;
}

}  // namespace tactus::window
