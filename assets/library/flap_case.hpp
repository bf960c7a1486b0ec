// SPDX-License-Identifier: Apache-2.0
// The synthetic flap: all inputs for a reconstruction of a jaw with a fibula, in the form of a user's files.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/vessel/track.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::library {

struct FlapOptions {
    std::optional<geometry::TriangleSurface> fibula;  ///< from a scan, m, LPS, closed; none: generated
    reconstruction::Leg fibula_leg = reconstruction::Leg::left;  ///< side of `fibula`
    /// Surfaces of the muscles beside `fibula` between which the vessels run: tibialis posterior and flexor hallucis
    /// longus. None or two; without them the vessels run behind and medial of the bone.
    std::vector<geometry::TriangleSurface> between;
    reconstruction::Leg leg = reconstruction::Leg::left;  ///< of the case; the fibula is mirrored if needed
    std::uint64_t seed = 1;  ///< of perforators
};

struct NamedPoint {
    std::string name;
    Vec3 position{0.0};  ///< m, LPS
};

/// Frame LPS, m. Jaw and sites share one frame; fibula, vessels and perforators another.
struct FlapCase {
    geometry::TriangleSurface jaw, fibula;
    geometry::TriangleSurface tumour;  ///< in the jaw, frame of the jaw
    vessel::Track artery;  ///< the fibular artery from proximal to distal; perforators are its side branches
    vessel::Track vein;
    std::vector<NamedPoint> perforators;  ///< points where they reach the skin
    std::vector<NamedPoint> sites;  ///< vessels of the neck to which the vessels of the flap can be joined
    reconstruction::FibulaInputs inputs;  ///< planes, line, roll; without jaw and donor
    std::vector<std::string> notes;  ///< the synthetic and the mirrored parts
};

/// A resection of the jaw from the left angle past the chin, bridged by three segments. The vessels run from 85 to 12 %
/// of the fibula's length beside the bone; five perforators lie at 18 to 84 % of it, one within 2 cm of the middle, the
/// marks 19 mm behind the bone (Heitmann 2003, Papadimas 2009, Beppu 1992). The donor is rolled so that its vessels face
/// the tongue. Deterministic. Throws Error if the fibula is not a long bone along z, or if only one muscle is given.
FlapCase make_flap(const FlapOptions& options = {});

/// Writes jaw.stl, fibula.stl, tumour.stl, artery.csv and vein.csv (as write_track), artery.mrk.json, perforators.mrk.json, sites.mrk.json
/// and INPUTS.json for `plan fibula` and `plan reconstruct`, into a folder that exists. mm, LPS. Throws Error.
void write_flap(const FlapCase& made, const std::filesystem::path& folder);

}  // namespace tactus::library
