// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/damage.hpp"

#include "dsp/core/hash.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace tactus::window {

namespace {

// Small enough for a number that changes, large enough for few boxes.
constexpr int tile_width = 64, tile_height = 16;

std::unordered_map<std::uintptr_t, std::uint64_t>& versions() {
    static std::unordered_map<std::uintptr_t, std::uint64_t> said;
    return said;
}

PixelBox common(const PixelBox& a, const PixelBox& b) {
    return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

/// What is not finite counts as far away.
float near(float at) {
    constexpr float far = 1e6f;
    return at > -far ? (at < far ? at : far) : -far;
}
int pixel_from(float at) { return static_cast<int>(std::floor(near(at))); }
int pixel_behind(float at) { return static_cast<int>(std::ceil(near(at))); }

/// The pixels that ImGui's OpenGL backend lets a command draw on: its glScissor, which cuts off fractions.
PixelBox pixels_of(const ImVec4& clip, int width, int height) {
    if (clip.z <= clip.x || clip.w <= clip.y) return {};
    const auto whole = [](float v) { return static_cast<int>(near(v)); };
    const int left = whole(clip.x), low = whole(static_cast<float>(height) - clip.w);
    const int wide = whole(clip.z - clip.x), high = whole(clip.w - clip.y);
    return common({left, height - low - high, left + wide, height - low}, {0, 0, width, height});
}

}  // namespace

void say_version(std::uint32_t texture, std::uint64_t version) { versions()[texture] = version; }
void forget_versions() { versions().clear(); }

void Damage::take(const ImDrawData& picture, ImTextureID fonts) {
    triangles_.clear();
    commands_.clear();
    ++unknown_;
    for (int l = 0; l < picture.CmdListsCount; ++l) {
        const ImDrawList& list = *picture.CmdLists[l];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const PixelBox clip = pixels_of(command.ClipRect, width_, height_);
            if (command.UserCallback || clip.is_empty()) continue;
            commands_.push_back({&list, &command, clip, triangles_.size()});
            Hash base;
            base.add_bytes(&clip, sizeof clip);
            const ImTextureID texture = command.GetTexID();
            base.add_word(reinterpret_cast<std::uintptr_t>(texture));
            if (texture != fonts) {
                const auto said = versions().find(reinterpret_cast<std::uintptr_t>(texture));
                base.add_word(said != versions().end() ? said->second : ~unknown_);
            }
            const ImDrawIdx* const index = list.IdxBuffer.Data + command.IdxOffset;
            const ImDrawVert* const vertices = list.VtxBuffer.Data + command.VtxOffset;
            for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
                const ImDrawVert *const a = vertices + index[i], *const b = vertices + index[i + 1],
                                        *const c = vertices + index[i + 2];
                const PixelBox box{pixel_from(std::min({a->pos.x, b->pos.x, c->pos.x})),
                                   pixel_from(std::min({a->pos.y, b->pos.y, c->pos.y})),
                                   pixel_behind(std::max({a->pos.x, b->pos.x, c->pos.x})),
                                   pixel_behind(std::max({a->pos.y, b->pos.y, c->pos.y}))};
                Hash hash = base;
                for (const ImDrawVert* vertex : {a, b, c}) hash.add_bytes(vertex, sizeof *vertex);
                triangles_.push_back({hash.state, common(box, clip)});
            }
        }
    }
}

/// The order of triangles on a tile counts.
void Damage::mark_tiles() {
    tiles_.assign(static_cast<std::size_t>(columns_ * rows_), 0);
    for (const Triangle& triangle : triangles_) {
        const PixelBox& box = triangle.box;
        if (box.is_empty()) continue;
        for (int row = box.top / tile_height; row <= (box.bottom - 1) / tile_height; ++row)
            for (int column = box.left / tile_width; column <= (box.right - 1) / tile_width; ++column) {
                Hash tile{tiles_[static_cast<std::size_t>(row * columns_ + column)]};
                tile.add_word(triangle.hash);
                tiles_[static_cast<std::size_t>(row * columns_ + column)] = tile.state;
            }
    }
}

/// Runs of tiles that differ, joined with equal runs above them.
void Damage::gather() {
    boxes_.clear();
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column) {
            const auto differs = [&](int c) {
                const auto tile = static_cast<std::size_t>(row * columns_ + c);
                return known_.empty() || tiles_[tile] != known_[tile];
            };
            if (!differs(column)) continue;
            const int first = column;
            while (column < columns_ && differs(column)) ++column;
            const PixelBox run{first * tile_width, row * tile_height, std::min(column * tile_width, width_),
                               std::min((row + 1) * tile_height, height_)};
            const auto above = std::ranges::find_if(boxes_, [&](const PixelBox& box) {
                return box.bottom == run.top && box.left == run.left && box.right == run.right;
            });
            if (above != boxes_.end()) above->bottom = run.bottom;
            else boxes_.push_back(run);
        }
}

const std::vector<PixelBox>& Damage::find(const ImDrawData& picture, int width, int height, ImTextureID fonts) {
    if (width != width_ || height != height_) {
        width_ = width;
        height_ = height;
        columns_ = (width + tile_width - 1) / tile_width;
        rows_ = (height + tile_height - 1) / tile_height;
        known_.clear();
    }
    whole_ = picture;
    take(picture, fonts);
    mark_tiles();
    gather();
    std::swap(tiles_, known_);
    return boxes_;
}

void Damage::add(const Command& command, const PixelBox& box) {
    const ImDrawIdx* const index = command.list->IdxBuffer.Data + command.command->IdxOffset;
    const ImDrawVert* const vertices = command.list->VtxBuffer.Data + command.command->VtxOffset;
    ImDrawCmd drawn = *command.command;
    drawn.ClipRect = {static_cast<float>(box.left), static_cast<float>(box.top), static_cast<float>(box.right),
                      static_cast<float>(box.bottom)};
    drawn.VtxOffset = static_cast<unsigned>(part_.VtxBuffer.Size);
    drawn.IdxOffset = static_cast<unsigned>(part_.IdxBuffer.Size);
    place_of_.clear();
    for (unsigned i = 0; i + 2 < drawn.ElemCount; i += 3) {
        if (common(triangles_[command.first + i / 3].box, box).is_empty()) continue;
        for (unsigned corner = i; corner < i + 3; ++corner) {
            const std::size_t vertex = index[corner];
            if (vertex >= place_of_.size()) place_of_.resize(vertex + 1, -1);
            int& place = place_of_[vertex];
            if (place < 0) {
                place = part_.VtxBuffer.Size - static_cast<int>(drawn.VtxOffset);
                part_.VtxBuffer.push_back(vertices[vertex]);
            }
            part_.IdxBuffer.push_back(static_cast<ImDrawIdx>(place));
        }
    }
    drawn.ElemCount = static_cast<unsigned>(part_.IdxBuffer.Size) - drawn.IdxOffset;
    if (drawn.ElemCount > 0) part_.CmdBuffer.push_back(drawn);
}

ImDrawData& Damage::part() {
    part_.CmdBuffer.resize(0);
    part_.IdxBuffer.resize(0);
    part_.VtxBuffer.resize(0);
    for (const Command& command : commands_)
        for (const PixelBox& box : boxes_)
            if (const PixelBox inside = common(command.clip, box); !inside.is_empty()) add(command, inside);
    part_data_ = whole_;
    part_lists_[0] = &part_;
    part_data_.CmdLists = part_lists_;
    part_data_.CmdListsCount = 1;
    part_data_.TotalIdxCount = part_.IdxBuffer.Size;
    part_data_.TotalVtxCount = part_.VtxBuffer.Size;
    return part_data_;
}

}  // namespace tactus::window
