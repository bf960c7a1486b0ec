// SPDX-License-Identifier: Apache-2.0
// Finds where a picture of the window differs from the one before, so that only this is drawn again. Without a graphics
// card the processor draws each pixel.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <vector>

namespace tactus::window {

/// Pixels of the window, from its upper left; right and bottom are outside.
struct PixelBox {
    int left = 0, top = 0, right = 0, bottom = 0;

    bool is_empty() const { return right <= left || bottom <= top; }
    friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

/// Says that a texture holds what it held when it last had this version. A texture whose version nobody says is taken
/// for changed in each picture. Only on the window's thread; lasts for one picture.
void say_version(std::uint32_t texture, std::uint64_t version);
void forget_versions();

class Damage {
public:
    Damage() : part_(ImGui::GetDrawListSharedData()) {}

    /// Compares a picture of `width` × `height` pixels with that of the last call. The result covers all pixels that
    /// differ, and no pixel twice; it is valid until the next call. `fonts`: the texture of letters.
    const std::vector<PixelBox>& find(const ImDrawData& picture, int width, int height, ImTextureID fonts);
    /// The next picture differs everywhere.
    void forget() { known_.clear(); }

    /// What has to be drawn of the picture that `find` was given last: inside of these boxes the same pixels as all of
    /// it, outside nothing. Valid until the next call.
    ImDrawData& part();

private:
    struct Triangle {
        std::uint64_t hash;
        PixelBox box;  // within its command's clip
    };
    struct Command {
        const ImDrawList* list;
        const ImDrawCmd* command;
        PixelBox clip;
        std::size_t first;  // in triangles_
    };

    void take(const ImDrawData& picture, ImTextureID fonts);
    void mark_tiles();
    void gather();
    void add(const Command& command, const PixelBox& box);

    int width_ = 0, height_ = 0, columns_ = 0, rows_ = 0;
    ImDrawData whole_{};
    std::vector<Triangle> triangles_;
    std::vector<Command> commands_;
    std::vector<std::uint64_t> tiles_, known_;  // hashes of what is drawn on each tile
    std::vector<PixelBox> boxes_;
    std::uint64_t unknown_ = 0;  // counts pictures
    ImDrawList part_;
    ImDrawList* part_lists_[1] = {};
    ImDrawData part_data_{};
    std::vector<int> place_of_;  // of a vertex in part_; −1: not yet
};

}  // namespace tactus::window
