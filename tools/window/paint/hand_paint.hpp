// SPDX-License-Identifier: Apache-2.0
// A patch that runs beside the painting window: what its brushes paint becomes strokes of the painting.
#pragma once

#include "dsp/segmentation/strokes.hpp"
#include "engine/observe/observer.hpp"
#include "graph/compile/load_assets.hpp"
#include "tools/window/document/viewed_run.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace tactus::window {

class PaintBench;
class Painting;

/// Strokes of one brush, from what the outputs of its node say tick by tick. Each is added to the painting when it ends.
class BrushStrokes {
public:
    explicit BrushStrokes(std::string label) : label_(std::move(label)) {}

    /// One tick: outputs 'kept' (m), 'kept_radius' (m, negative: it erases, 0: it is lifted) and 'kept_points'.
    void take(const Vec3& kept, double radius, double points, Painting& painting);
    /// Adds the stroke that is open.
    void end(Painting& painting);
    /// Where it paints now; null when it does not.
    const segmentation::Stroke* open() const { return stroke_.points.empty() ? nullptr : &stroke_; }

private:
    std::string label_;
    segmentation::Stroke stroke_;
    double radius_ = 0.0, points_ = 0.0;
};

/// The run has threads of its own; the window reads copies and cannot delay it.
class HandPaint {
public:
    /// Starts the patch at once. Throws Error when it cannot be read.
    explicit HandPaint(const std::filesystem::path& patch);

    /// Once per picture: takes over new strokes, moves the slices to where a brush paints, and tells what went wrong.
    void tend(PaintBench& bench);
    /// Ends the run; strokes that are open are added.
    void end(PaintBench& bench);

    /// Of the run, after end(); empty for one that failed.
    std::string summary() const { return run_.summary_text(); }
    /// Why the run ended early; empty: it did not.
    const std::string& failure() const { return failure_; }

private:
    struct Brush {
        BrushStrokes strokes;
        observe::SeenValues kept, radius, points;
        std::uint64_t lost = 0;
    };
    void take_in(PaintBench& bench);
    void take_in(const std::string& node, Brush& brush, PaintBench& bench);

    compile::AssetCache assets_;
    observe::Observer observer_;
    std::map<std::string, Brush> brushes_;  // by node
    std::string failure_;
    bool has_told_end_ = false;
    ViewedRun run_;
};

}  // namespace tactus::window
