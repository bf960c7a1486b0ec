// SPDX-License-Identifier: Apache-2.0
#include "tools/window/paint/paint_view.hpp"

#include "assets/plan/plan_lock.hpp"
#include "dsp/core/error.hpp"
#include "tools/window/paint/hand_paint.hpp"
#include "tools/window/paint/paint_desk.hpp"
#include "tools/window/paint/paint_script.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <thread>

namespace tactus::window {

PaintViewEnd paint_view(const analysis::ScanGraph& scan, const analysis::SegmentSettings& settings,
                        const PaintViewChoice& choice, const std::atomic<bool>& interrupted) {
    using Clock = std::chrono::steady_clock;
    constexpr auto picture_time = std::chrono::microseconds(16'667);
    std::optional<PaintScript> script;
    if (!choice.script.empty()) script.emplace(choice.script);
    // Two windows would write over each other's strokes.
    std::optional<plan::PlanLock> lock;
    try {
        lock.emplace(choice.seeds, std::chrono::milliseconds(0));
    } catch (const Error&) {
        throw Error(fmt::format("{}: another window paints these seeds, or the folder cannot be written",
                                choice.seeds.string()));
    }
    PaintBench bench(scan, settings, choice.seeds);
    Window window(fmt::format("{} - Tactus", settings.scan.filename().string()), 1600, 1000, choice.scale);
    PaintDesk desk(window, bench);
    std::optional<HandPaint> hand;
    if (!choice.hand.empty()) hand.emplace(choice.hand);
    // Whether the window may close; asks where strokes would be lost.
    const auto may_close = [&] {
        using Leaving = PaintDesk::Leaving;
        if (!window.wants_to_close() && desk.leaving != Leaving::leaves) return false;
        bench.painting().end();
        if (desk.leaving == Leaving::leaves || bench.painting().is_kept() || bench.painting().save()) return true;
        window.keep_open();
        desk.leaving = Leaving::asks;
        return false;
    };
    while (!interrupted && !(script && script->wants_to_close()) && !may_close()) {
        const auto begin = Clock::now();
        if (hand) hand->tend(bench);
        if (window.begin()) {
            if (script) script->move_mouse();
            desk.draw();
            window.end();
        } else bench.tend();
        if (script) script->step(desk, window);
        std::this_thread::sleep_until(begin + picture_time);
    }
    // A stroke that is being drawn while the window closes is kept, too.
    bench.painting().end();
    PaintViewEnd end;
    if (hand) {
        hand->end(bench);
        end.hand_summary = hand->summary();
        end.hand_failure = hand->failure();
    }
    if (!bench.painting().is_kept() && !bench.painting().save()) end.lost = bench.painting().problem();
    return end;
}

}  // namespace tactus::window
