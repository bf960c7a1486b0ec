// SPDX-License-Identifier: Apache-2.0
// ITK's transforms in HDF5 (.h5), the format in which 3D Slicer and ANTs save transforms.
//
// The layout is that of ITK's itkHDF5TransformIO: a group `/TransformGroup/N` per transform with the datasets
// `TransformType` (a string of variable length), `TransformParameters` and `TransformFixedParameters` (lists of floats).
// ITK before version 5 spells the latter two `TranformParameters` and `TranformFixedParameters` and reads no other
// spelling. Files that are written here contain both names for the same data, so that old and new versions read them.
#pragma once

#include "assets/transform/transform_file.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::transform {

/// Reads in a process of its own, with limits of time and memory, because the HDF5 library ends its program on some damaged
/// files. Throws Error for a missing or damaged file and for one that is no file of transforms.
std::vector<ItkTransform> read_h5(const std::filesystem::path& path);

/// Throws Error if the file cannot be written.
void write_h5(const std::filesystem::path& path, const ItkTransform& transform);

/// Implemented by a module, because the HDF5 library of Debian loads libraries for networks.
class H5Codec {
public:
    virtual ~H5Codec() = default;
    virtual std::vector<ItkTransform> read(const std::filesystem::path& path) const = 0;
    virtual std::string bytes_of(const ItkTransform& transform) const = 0;
};

inline constexpr const char* h5_module = "tactus-hdf5.so";
inline constexpr const char* h5_codec_symbol = "tactus_h5_codec";

}  // namespace tactus::transform
