// SPDX-License-Identifier: Apache-2.0
// The assets that a node may name in a patch, and how each is loaded.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/deflection/deflection_file.hpp"
#include "assets/equaliser/equaliser_file.hpp"
#include "assets/plan/case_bones.hpp"
#include "assets/recording/recording_set.hpp"
#include "graph/param.hpp"

namespace tactus {

template <>
struct AssetLoader<Bone> {
    static constexpr std::string_view name = "bone";
    static Bone load(const std::string& path) { return load_bone(path); }
};

template <>
struct AssetLoader<CaseBones> {
    static constexpr std::string_view name = "plan of a case";
    static CaseBones load(const std::string& path) { return load_case(path); }
};

template <>
struct AssetLoader<RecordingSet> {
    static constexpr std::string_view name = "recording set";
    static RecordingSet load(const std::string& path) { return load_recording_set(path); }
};

template <>
struct AssetLoader<Equaliser> {
    static constexpr std::string_view name = "equaliser";
    static Equaliser load(const std::string& path) { return load_equaliser(path); }
};

template <>
struct AssetLoader<DeflectionTable> {
    static constexpr std::string_view name = "deflection table";
    static DeflectionTable load(const std::string& path) { return load_deflection_table(path); }
};

}  // namespace tactus
