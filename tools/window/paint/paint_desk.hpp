// SPDX-License-Identifier: Apache-2.0
// The layout of the painting window: three slices, the bone, tools and labels.
#pragma once

#include "tools/window/frame/window.hpp"
#include "tools/window/paint/bone_panel.hpp"
#include "tools/window/paint/slice_panel.hpp"

#include <array>

namespace tactus::window {

class PaintDesk {
public:
    PaintDesk(Window& window, PaintBench& bench);

    /// Draws one frame, between Window::begin and Window::end.
    void draw();

    /// The question whether to close while strokes are in no file.
    enum class Leaving { none, asks, leaves } leaving = Leaving::none;

    PaintBench& bench() { return bench_; }
    BonePanel& bone() { return bone_; }
    SliceSight& sight() { return sight_; }
    const SlicePanel& slice(Slice which) const { return slices_[static_cast<std::size_t>(which)]; }

private:
    void shortcuts();
    void draw_tools();
    void draw_labels();
    void draw_vessels();
    void draw_window();
    void ask_leaving();
    bool button(const char* label, bool is_on = false);

    Window& window_;
    PaintBench& bench_;
    SliceSight sight_;
    std::array<SlicePanel, 3> slices_;
    BonePanel bone_;
    Fonts fonts_;
    int renamed_ = -1;
    std::array<char, 201> name_{};
};

}  // namespace tactus::window
