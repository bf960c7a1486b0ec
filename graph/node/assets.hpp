// SPDX-License-Identifier: Apache-2.0
// The types of asset that a node may name in a patch, and their loaders. The loaders throw Error.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/plan/case_bones.hpp"
#include "assets/sound/equaliser_file.hpp"
#include "assets/sound/recording_set.hpp"
#include "assets/sound/response_file.hpp"
#include "assets/sound/sound.hpp"
#include "assets/table/deflection_file.hpp"
#include "graph/node/param.hpp"

namespace tactus {

template <>
struct AssetLoader<bone::Bone> {
    static constexpr std::string_view name = "bone";
    static bone::Bone load(const std::string& path) { return bone::load_bone(path); }
};

template <>
struct AssetLoader<plan::CaseBones> {
    static constexpr std::string_view name = "plan of a case";
    static plan::CaseBones load(const std::string& path) { return plan::load_case(path); }
};

template <>
struct AssetLoader<sound::RecordingSet> {
    static constexpr std::string_view name = "recording set";
    static sound::RecordingSet load(const std::string& path) { return sound::load_recording_set(path); }
};

template <>
struct AssetLoader<sound::ResponseFile> {
    static constexpr std::string_view name = "frequency response";
    static sound::ResponseFile load(const std::string& path) { return sound::load_response(path); }
};

template <>
struct AssetLoader<sound::Sound> {
    static constexpr std::string_view name = "sound";
    static sound::Sound load(const std::string& path) { return sound::load_sound(path); }
};

template <>
struct AssetLoader<vibration::Equaliser> {
    static constexpr std::string_view name = "equaliser";
    static vibration::Equaliser load(const std::string& path) { return sound::load_equaliser(path); }
};

template <>
struct AssetLoader<control::DeflectionTable> {
    static constexpr std::string_view name = "deflection table";
    static control::DeflectionTable load(const std::string& path) { return table::load_deflection_table(path); }
};

}  // namespace tactus
