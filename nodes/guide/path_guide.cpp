// SPDX-License-Identifier: Apache-2.0
#include "dsp/guide/path.hpp"
#include "dsp/guide/turning_pull.hpp"

#include "dsp/core/number_list.hpp"
#include "dsp/core/units.hpp"
#include "nodes/guide/guide_parameters.hpp"

namespace tactus::nodes {

struct PathGuide {
    static constexpr auto about =
        "Pulls the hand to the nearest place of a path through points, along which it is free. Where another part of "
        "the "
        "path becomes nearer, the pull turns there within 50 ms." TACTUS_GUIDE_ABOUT;

    In<Pose> pose{"of the hand", "m"};
    In<Twist> twist{optional, "of the hand; open: no damping", "m/s, rad/s"};
    In<Pose> frame{optional, "the guide's frame; open: the world. A frame that moves does work on the hand", "m"};
    Out<Wrench> wrench{"on the hand, about its origin", "N, N m"};
    Out<double> distance{"from the path", "m"};
    Out<double> along{"of the nearest place, from the first point on", "m"};
    Text points{"-20 0 0, 0 0 5, 20 0 0 mm", "the points, with one unit at the end: \"0 0 0, 10 0 5 mm\""};
    Choice shape{{"smooth", "straight"},
                 "smooth: a curve through the points (Catmull–Rom); straight: lines between them"};
    Flag closed{false, "the path goes from the last point to the first again"};
    Param reach{"0 mm", "0 mm", "1 m",
                "distance at which the pull has faded to nothing, as of a magnet; 0: it never ends"};
    GuideParameters guide;

    void prepare(const Setup& setup) {
        path_ = {};
        pull_.reset();
        const auto [text, factor] = without_unit(setup);
        std::vector<Vec3> all;
        for (const std::vector<double>& row : rows_of_numbers(text, points.where)) {
            if (row.size() != 3) setup.fail("a point of a path has three coordinates, as in \"0 0 0, 10 0 5 mm\"");
            all.push_back(factor * Vec3(row[0], row[1], row[2]));
        }
        try {
            path_ = guide::Path(all, shape.is("smooth"), closed);
        } catch (const Error& error) {
            setup.fail(error.message());
        }
    }

    void process(const Tick& tick) noexcept {
        const GuidedHand hand(pose, twist, frame);
        wrench = Wrench{};
        if (!hand.is_known) return pull_.reset();
        const guide::Path::Place place = path_.nearest(hand.position);
        distance = glm::distance(place.point, hand.position);
        along = place.along;
        const Vec3 force = pull_.on(guide.law(reach), hand.position, hand.velocity, place.point, place.tangent,
                                    tick.elapsed_seconds());
        wrench = {frame->orientation * force, {}};
    }

private:
    /// The text without the unit at its end, and the unit's factor.
    std::pair<std::string, double> without_unit(const Setup& setup) const {
        const std::string& text = points.value;
        const std::size_t last = text.find_last_of("0123456789.");
        if (last == std::string::npos) setup.fail("a path needs points, as in \"0 0 0, 10 0 5 mm\"");
        try {
            const Unit unit = parse_unit(text.substr(last + 1));
            if (!(unit.dimension == parse_unit("m").dimension))
                setup.fail("the points of a path need a length as unit, as in \"0 0 0, 10 0 5 mm\"");
            return {text.substr(0, last + 1), unit.factor};
        } catch (const Error& error) {
            setup.fail(error.message());
        }
    }

    guide::Path path_;
    guide::TurningPull pull_;
};

TACTUS_NODE(PathGuide, pose, twist, frame, wrench, distance, along, points, shape, closed, reach, guide)

}  // namespace tactus::nodes
