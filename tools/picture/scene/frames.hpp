// SPDX-License-Identifier: Apache-2.0
// Pictures of a scene at even steps of time while a patch is rendered: frame_0001.png, frame_0002.png, …
#pragma once

#include "engine/observe/observer.hpp"
#include "tools/picture/scene/frame_choice.hpp"
#include "tools/picture/scene/scene_outline.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tactus::picture {

class FrameWriter {
public:
    /// Before the run. Throws Error for a choice that makes no sense, a patch with nothing to see, and when there is no
    /// OpenGL.
    FrameWriter(const FrameChoice& choice, SceneOutline outline, double seconds, std::filesystem::path folder);
    ~FrameWriter();
    FrameWriter(const FrameWriter&) = delete;
    FrameWriter& operator=(const FrameWriter&) = delete;

    /// For EngineOptions: sees everything.
    observe::Observer& observer();
    /// Draws the frames up to this logical time, s: all groups have come so far. Always on one thread.
    void advance(double seconds);
    /// Names of what was written.
    const std::vector<std::string>& files() const;
    /// Why a picture could not be written, which it names.
    const std::vector<std::string>& losses() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tactus::picture
