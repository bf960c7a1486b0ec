// SPDX-License-Identifier: Apache-2.0
// Writes a reconstruction's cuts, vessels, plates, implants and sites for 3D Slicer and other programs.
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/flap.hpp"
#include "dsp/reconstruction/reach.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::analysis {

/// One file per markup, LPS, mm, schema 1.0.3: a Plane per cut of the jaw and per osteotomy of the donor (in the donor's
/// frame), a Curve per vessel as placed and as in the leg (in the donor's frame) and per plate, a Line per screw and
/// implant, and the sites. For each curve of a vessel also a tube (`mesh_type`: .stl or .ply) and a .vtp line. Returns
/// the names of the files. Throws Error.
std::vector<std::string> export_flap(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan,
                                     const reconstruction::Flap& flap, const reconstruction::FlapMeasures& measures,
                                     const std::filesystem::path& out, const std::string& mesh_type);

/// Returns the name with characters replaced that a file name must not contain.
std::string file_name_of(const std::string& name);

}  // namespace tactus::analysis
