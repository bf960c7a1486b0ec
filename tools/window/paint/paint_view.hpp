// SPDX-License-Identifier: Apache-2.0
// The window in which a scan is painted.
#pragma once

#include "tools/analysis/segmentation/segment_scan.hpp"

#include <atomic>
#include <filesystem>
#include <string>

namespace tactus::window {

struct PaintViewChoice {
    std::filesystem::path seeds;   ///< continued when it exists; written after every stroke
    std::filesystem::path hand;    ///< a patch whose brushes paint, too; empty: none
    std::filesystem::path script;  ///< file of commands, see PaintScript
    double scale = 0.0;            ///< of the content, 0: that of the screen
};

struct PaintViewEnd {
    std::string lost;          ///< why the last strokes could not be written; empty: they are in the file
    std::string hand_summary;  ///< of the hand's run
    std::string hand_failure;  ///< why that run ended early; empty: it did not
};

/// Runs until the window is closed. Throws Error when no window can be opened, or the seeds cannot be read.
PaintViewEnd paint_view(const analysis::ScanGraph& scan, const analysis::SegmentSettings& settings,
                        const PaintViewChoice& choice, const std::atomic<bool>& interrupted);

}  // namespace tactus::window
