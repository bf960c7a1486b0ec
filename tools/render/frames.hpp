// SPDX-License-Identifier: Apache-2.0
// Writes pictures of a scene at equal time steps during a rendering: frame_0001.png, frame_0002.png, …
#pragma once

#include "engine/observe/observer.hpp"
#include "tools/render/frame_choice.hpp"
#include "tools/render/scene_outline.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tactus::render {

class FrameWriter {
public:
    /// Called before the run. Throws Error for invalid settings, for a patch with nothing to draw, and without OpenGL.
    FrameWriter(const FrameChoice& choice, SceneOutline outline, double seconds, std::filesystem::path folder);
    ~FrameWriter();
    FrameWriter(const FrameWriter&) = delete;
    FrameWriter& operator=(const FrameWriter&) = delete;

    /// Observer for EngineOptions.
    observe::Observer& observer();
    /// Draws the frames up to this logical time, s, which all groups have reached. Always on one thread.
    void advance(double seconds);
    /// Names of the written files.
    const std::vector<std::string>& files() const;
    /// Reasons why pictures could not be written, with their names.
    const std::vector<std::string>& losses() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tactus::render
