// SPDX-License-Identifier: Apache-2.0
#include "tools/view/paint/paint_view.hpp"

#include "assets/cases/plan_lock.hpp"
#include "dsp/core/error.hpp"
#include "tools/view/paint/paint_desk.hpp"
#include "tools/view/paint/paint_script.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <thread>

namespace tactus::view {

std::string paint_view(const study::ScanGraph& scan, const study::SegmentSettings& settings,
                       const PaintViewChoice& choice, const std::atomic<bool>& interrupted) {
    using Clock = std::chrono::steady_clock;
    constexpr auto picture_time = std::chrono::microseconds(16'667);
    std::optional<PaintScript> script;
    if (!choice.script.empty()) script.emplace(choice.script);
    // Two windows would write over each other's strokes.
    std::optional<cases::PlanLock> lock;
    try {
        lock.emplace(choice.seeds, std::chrono::milliseconds(0));
    } catch (const Error&) {
        throw Error(fmt::format("{}: another window paints these seeds, or the folder cannot be written",
                                choice.seeds.string()));
    }
    PaintBench bench(scan, settings, choice.seeds);
    Window window(fmt::format("{} - Tactus", settings.scan.filename().string()), 1600, 1000, choice.scale);
    PaintDesk desk(window, bench);
    while (!interrupted && !window.wants_to_close() && !(script && script->wants_to_close())) {
        const auto begin = Clock::now();
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
    return bench.painting().is_kept() || bench.painting().save() ? std::string() : bench.painting().problem();
}

}  // namespace tactus::view
