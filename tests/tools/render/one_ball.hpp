// SPDX-License-Identifier: Apache-2.0
// Scenes of one ball, for tests of what is drawn.
#pragma once

#include "dsp/contact/voxmap.hpp"
#include "dsp/core/time.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/volume/grid.hpp"

#include <glm/geometric.hpp>

#include <cstddef>

namespace tactus::test {

inline constexpr Flicks at_60_hz = flicks_per_second / 60;

template <class T>
const std::byte* bytes_of(const T& value) {
    return reinterpret_cast<const std::byte*>(&value);
}

inline volume::Grid ball(double radius) {
    volume::Grid grid{{49, 49, 49}, Vec3(-0.012), Vec3(0.0005), {}};
    for (int k = 0; k < 49; ++k)
        for (int j = 0; j < 49; ++j)
            for (int i = 0; i < 49; ++i)
                grid.values.push_back(static_cast<float>(glm::length(grid.position(i, j, k)) - radius));
    return grid;
}

/// A scene of one ball of 8 mm radius, which comes after the hand.
struct Ball {
    contact::Voxmap field = contact::make_voxmap(ball(0.008));
    coupling::Scene scene;

    Ball() {
        scene.count = 1;
        scene.objects[0].body.map = &field;
        scene.objects[0].body.content_hash = 7;
        scene.content_hash = coupling::hash_of(scene);
    }
};

}  // namespace tactus::test
