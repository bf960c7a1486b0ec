// SPDX-License-Identifier: Apache-2.0
// Rigid transforms in ITK's text format (.tfm) and its HDF5 format (.h5), as ITK, ANTs and 3D Slicer read and write them.
#pragma once

#include "dsp/core/types.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::transform {

/// A transform as ITK stores it. `fixed` are the numbers that an optimiser does not change: the centre first.
struct ItkTransform {
    std::string type;  ///< such as AffineTransform_double_3_3
    std::vector<double> parameters, fixed;  ///< mm
};

/// The transform that applies `motion`, as text_of writes it.
ItkTransform itk_transform_of(const Pose& motion);

/// Returns the text of a file that applies `motion` (p_after = motion.apply(p_before), LPS). ITK stores the map from
/// the space after the motion to the space before it, hence the inverse of the motion, in mm; Slicer inverts it when it
/// loads the file. One AffineTransform_double_3_3: nine numbers of the matrix, row by row, then the translation.
std::string text_of(const Pose& motion);

/// Returns the motion that a file describes. Reads one affine, matrix-offset, Euler, versor or quaternion transform of
/// three dimensions, double or float, with a centre. Throws Error for other and composite transforms, and for a matrix
/// that scales, shears or mirrors, since bones are rigid. `file` is the name in messages.
Pose motion_of_text(std::string_view text, const std::string& file);
/// The same from the transforms of an .h5 file.
Pose motion_of_transforms(const std::vector<ItkTransform>& transforms, const std::string& file);
/// Reads either format, by the extension: .h5 or .hdf5, otherwise text.
Pose read_motion(const std::filesystem::path& path);
/// Writes either format, by the extension.
void write_motion(const std::filesystem::path& path, const Pose& motion);

}  // namespace tactus::transform
