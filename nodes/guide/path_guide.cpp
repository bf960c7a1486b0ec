// SPDX-License-Identifier: Apache-2.0
#include "dsp/guide/path.hpp"
#include "dsp/guide/turning_pull.hpp"

#include "dsp/core/number_list.hpp"
#include "dsp/core/units.hpp"
#include "graph/node/visual.hpp"
#include "nodes/guide/guide_parameters.hpp"

namespace tactus::nodes {

struct PathGuide {
    static constexpr auto about =
        "Pulls the hand to the nearest place of a path through points, along which it is free. Where another part of "
        "the "
        "path becomes nearer, the pull turns there within 50 ms." TACTUS_GUIDE_ABOUT;

    In<Pose> pose{"of the hand", "m"};
    In<Twist> twist{optional, "of the hand; open: no damping", "m/s, rad/s"};
    In<Pose> frame{optional, of_world, "the guide's frame; open: the world. A frame that moves does work on the hand",
                   "m"};
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

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::path,
                 .hand = "pose",
                 .force = "wrench",
                 .frame = "frame",
                 .points = path_of().corners()}};
    }

    void prepare(const Setup& setup) {
        pull_.reset();
        try {
            path_ = path_of();
        } catch (const Error& error) {
            if (error.where().line > 0) throw;
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
    /// The path that the text describes. Throws Error.
    guide::Path path_of() const {
        const auto [text, factor] = without_unit();
        std::vector<Vec3> all;
        for (const std::vector<double>& row : rows_of_numbers(text, points.where)) {
            if (row.size() != 3) throw Error("a point of a path has three coordinates, as in \"0 0 0, 10 0 5 mm\"");
            all.push_back(factor * Vec3(row[0], row[1], row[2]));
        }
        return guide::Path(all, shape.is("smooth"), closed);
    }
    /// The text without the unit at its end, and the unit's factor. Throws Error.
    std::pair<std::string, double> without_unit() const {
        const std::string& text = points.value;
        const std::size_t last = text.find_last_of("0123456789.");
        if (last == std::string::npos) throw Error("a path needs points, as in \"0 0 0, 10 0 5 mm\"");
        const Unit unit = parse_unit(text.substr(last + 1));
        if (!(unit.dimension == parse_unit("m").dimension))
            throw Error("the points of a path need a length as unit, as in \"0 0 0, 10 0 5 mm\"");
        return {text.substr(0, last + 1), unit.factor};
    }

    guide::Path path_;
    guide::TurningPull pull_;
};

TACTUS_NODE(PathGuide, pose, twist, frame, wrench, distance, along, points, shape, closed, reach, guide)
TACTUS_VISUALS(PathGuide)

}  // namespace tactus::nodes
