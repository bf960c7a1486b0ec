// SPDX-License-Identifier: Apache-2.0
#include "tools/study/bones/intact_side.hpp"

#include "dsp/contact/sample_surface.hpp"
#include "dsp/fit/mirror.hpp"
#include "dsp/volume/outer_shell.hpp"
#include "tools/study/bones/fragment_file.hpp"
#include "tools/study/bones/surface_file.hpp"
#include "tools/study/workers.hpp"

namespace tactus::study {

std::vector<contact::SurfacePoint> laid_target(const cases::MirrorTarget& target, const std::filesystem::path& folder) {
    return fit::mirrored(points_of_file(cases::file_of(target.file, folder)),
                         {target.plane_normal, target.plane_offset}, target.pose);
}

IntactSide lay_intact_side(const std::filesystem::path& file, bool mirror,
                           std::span<const contact::SurfacePoint> main) {
    // Half the width of the openings that connect marrow to the outside at a threshold for cortex.
    constexpr double closing = 3e-3;
    std::vector<contact::SurfacePoint> points =
        is_mesh(file)
            ? points_of_file(file)
            : contact::sample_surface(volume::outer_shell(bone_of_file(file).distance, closing, on_threads()), {});
    if (mirror) {
        const fit::MirrorFit fit = fit::fit_mirror(points, main);
        return {fit::mirrored(points, fit.plane, fit.pose), fit.registration};
    }
    const fit::Registration found = fit::register_from_anywhere(main, points, fit::RegistrationTarget(points));
    const Pose onto = found.pose.inverse();
    for (contact::SurfacePoint& p : points) p = {onto.apply(p.position), onto.rotate(p.normal), p.area, p.label};
    return {std::move(points), found};
}

}  // namespace tactus::study
