// SPDX-License-Identifier: Apache-2.0
// Seeds of a segmentation as brush strokes, in a file that can also be written by hand.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/segmentation/strokes.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::segmentation {

/// The strokes of one fragment.
struct SeedLabel {
    std::string name;              ///< unique in the file, not empty
    std::optional<Vec3> colour{};  ///< sRGB, 0 to 1; none: from the palette
    std::vector<Stroke> strokes;
};

inline constexpr std::size_t max_labels = 100;
inline constexpr double widest_brush = 0.1, farthest_seed = 100.0;  ///< m, limits of a file

/// Valid name of a label in a file: 1 to 200 bytes of UTF-8 on one line.
bool is_label_name(std::string_view name);
/// Finite, and nearer than farthest_seed along each axis.
bool is_seed_place(const Vec3& position);

/// Reads {"labels": [{"name": "main", "colour": "#d95f02", "strokes": [{"radius_mm": 3, "points_mm": [[x, y, z], ...]}]},
/// ...]}; positions in LPS. Throws Error that names the label and the stroke. For a segmentation it also throws for
/// fewer than two labels and for labels without strokes, which are valid in a draft.
enum class SeedsUse { segmentation, draft };
std::vector<SeedLabel> read_seeds(const std::filesystem::path& path, SeedsUse use = SeedsUse::segmentation);
/// The same from the text of a file; `file` is its name in messages.
std::vector<SeedLabel> seeds_of_text(std::string_view text, const std::string& file,
                                     SeedsUse use = SeedsUse::segmentation);

/// Writes such a file; lengths are rounded to 0.001 mm. Throws Error.
void write_seeds(std::span<const SeedLabel> labels, const std::filesystem::path& path);

}  // namespace tactus::segmentation
