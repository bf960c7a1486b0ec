// SPDX-License-Identifier: Apache-2.0
// A whole reconstruction of a jaw, as stored in a plan.
#pragma once

#include "assets/file/json.hpp"
#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/flap.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tactus::reconstruction {

/// A mesh file that a plan refers to.
struct MeshFile {
    std::string file;  ///< relative to the plan's folder, or absolute
    std::uint64_t hash = 0;  ///< of the file's bytes
};

/// A cutting guide that was made of the plan: what it was made of, and its mesh.
struct KeptGuide {
    std::string name;
    bool is_of_jaw = false;  ///< else of the donor
    int cut = 0;  ///< of the jaw: 1 the first, 2 the last; 0: all
    int sides = 3;  ///< walls of its slots, 1 to 3
    double turn = 0.0;  ///< rad, of the approach
    std::string label;  ///< engraved; empty: the plan's title
    MeshFile mesh;  ///< in the frame of its bone
};

struct Reconstruction {
    FibulaInputs inputs;  ///< without surfaces, which are in the files
    Flap flap;
    MeshFile donor;
    std::optional<MeshFile> jaw, tumour;
    std::vector<KeptGuide> guides{};
};

/// Converts to JSON in m and rad; numbers read back to the same bits.
file::Json json_of(const Reconstruction& all);
/// `where` begins messages. Throws Error for content that json_of would not write: missing or unknown words, lists that
/// are too long, numbers that are not finite or beyond 100 m, directions without unit length, names that are empty or
/// taken.
Reconstruction reconstruction_of(const file::Json& json, const std::string& where);

/// Reads the flap from a file of inputs, in mm: the members "vessels", "perforators", "sites", "plates", "implants",
/// "paddle", "margin_mm", "limits", all of which are optional.
Flap flap_of_inputs(const file::Json& json, const std::string& where);

/// Throws Error for an invalid flap: names that are empty or not unique, a vessel of one point, a direction without
/// unit length, a size that is not positive, a number that is not finite or beyond 100 m.
void check(const Flap& flap, const std::string& where);

}  // namespace tactus::reconstruction
