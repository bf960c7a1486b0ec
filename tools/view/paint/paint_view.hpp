// SPDX-License-Identifier: Apache-2.0
// The window in which a scan is painted.
#pragma once

#include "tools/study/segment/segment_scan.hpp"

#include <atomic>
#include <filesystem>

namespace tactus::view {

struct PaintViewChoice {
    std::filesystem::path seeds;   ///< continued when it exists; written after every stroke
    std::filesystem::path script;  ///< file of commands, see PaintScript
    double scale = 0.0;            ///< of the content, 0: that of the screen
};

/// Runs until the window is closed. Returns why the last strokes could not be written; empty: they are in the file. Throws
/// Error when no window can be opened, or the seeds cannot be read.
std::string paint_view(const study::ScanGraph& scan, const study::SegmentSettings& settings,
                       const PaintViewChoice& choice, const std::atomic<bool>& interrupted);

}  // namespace tactus::view
