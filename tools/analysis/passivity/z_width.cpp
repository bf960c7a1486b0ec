// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/passivity/z_width.hpp"

#include "dsp/control/stated_hand.hpp"
#include "dsp/simulate/device_model.hpp"
#include "graph/analyse/stiffness.hpp"
#include "tools/analysis/workers.hpp"

#include <cstddef>
#include <mutex>

namespace tactus::analysis {

ZWidthDevice ideal_device(const std::string& name, const DeviceInfo& info) {
    control::SampledWall wall;
    wall.mass = 0.2;
    wall.viscous = analyse::damping_with_hand(info);
    wall.resolution = 0.0;
    wall.delay = info.delay;
    if (info.max_force > 0.0) wall.max_force = info.max_force;
    return {name, wall};
}

std::vector<ZWidthDevice> modelled_devices() {
    std::vector<ZWidthDevice> all;
    for (const simulate::DeviceModel& model : simulate::device_models()) {
        control::SampledWall wall;
        wall.mass = model.mass + control::StatedHand::mass;
        wall.viscous = model.viscous + control::StatedHand::damping;
        wall.friction = model.friction;
        wall.resolution = model.resolution;
        wall.delay = model.delay;
        wall.max_force = model.max_force;
        all.push_back({std::string(model.name), wall});
    }
    return all;
}

std::vector<ZWidthCurve> z_width(const std::vector<ZWidthDevice>& devices, const ZWidthGrid& grid,
                                 const std::function<void(std::size_t done, std::size_t all)>& tell) {
    std::vector<ZWidthCurve> curves;
    std::vector<control::SampledWall> walls;
    for (const ZWidthDevice& device : devices)
        for (const double rate : grid.rates)
            for (const double late : grid.periods_late) {
                control::SampledWall wall = device.wall;
                wall.period = 1.0 / rate;
                wall.delay = analyse::loop_delay(late * wall.period, wall.delay, wall.delay);
                curves.push_back({device.name, rate, wall.delay, std::vector<ZWidthPoint>(grid.dampings.size())});
                walls.push_back(wall);
            }
    const std::size_t points = grid.dampings.size();
    std::mutex telling;
    std::size_t done = 0;
    on_threads()(curves.size() * points, [&](std::size_t job) {
        control::SampledWall wall = walls[job / points];
        wall.damping = grid.dampings[job % points];
        curves[job / points].points[job % points] = {
            wall.damping, control::colgate_stiffness(wall), control::passive_stiffness(wall),
            control::friction_stiffness(wall), control::simulated_stiffness(wall, grid.most)};
        const std::lock_guard one(telling);
        ++done;
        if (tell) tell(done, curves.size() * points);
    });
    return curves;
}

}  // namespace tactus::analysis
