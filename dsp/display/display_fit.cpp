// SPDX-License-Identifier: Apache-2.0
#include "dsp/display/display_fit.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::display {

namespace {

using Numbers = std::vector<std::size_t>;

/// Fits a part by `fit`, which takes indices of touches and returns a function from a touch to its residual.
/// Finds the faulty touch when a residual exceeds the tolerance.
template <class Fit>
TouchedPart fitted(const std::string& what, const Numbers& touches, std::span<const Touch> all, std::size_t least,
                   double tolerance, const Fit& fit) {
    if (touches.size() < least)
        throw Error(
            fmt::format("{}: {} touches are too few; touch {} places at least, one more than decides it, so that "
                        "a bad one shows",
                        what, touches.size(), least));
    TouchedPart part{what, touches, {}, {}};
    std::string refusal;
    try {
        const auto off = fit(touches);
        double sum = 0.0;
        for (std::size_t i = 0; i < touches.size(); ++i) {
            part.off.push_back(off(all[touches[i]]));
            sum += part.off[i] * part.off[i];
            if (part.off[i] > part.residual.worst) part.residual = {0.0, part.off[i], i};
        }
        part.residual.rms = std::sqrt(sum / static_cast<double>(touches.size()));
        if (part.residual.worst <= tolerance) return part;
        refusal = fmt::format("the touches disagree by {:.2f} mm", part.residual.worst * 1e3);
    } catch (const Error& error) {
        refusal = error.message();
    }
    // Leave-one-out: without which touch do the others agree best?
    double best = tolerance, apart = 0.0;
    std::optional<std::size_t> blamed;
    for (const std::size_t left_out : touches) {
        if (touches.size() <= least) break;
        Numbers others = touches;
        std::erase(others, left_out);
        try {
            const auto off = fit(others);
            double worst = 0.0;
            for (const std::size_t i : others) worst = std::max(worst, off(all[i]));
            if (!(worst < best)) continue;
            best = worst;
            blamed = left_out;
            apart = off(all[left_out]);
        } catch (const Error&) {
            // These touches do not determine the part.
        }
    }
    if (blamed)
        throw BadTouch(*blamed,
                       fmt::format("{}: touch {}, {}, is {:.1f} mm off, while the others agree within {:.2f} mm; "
                                   "touch it again",
                                   what, *blamed + 1, all[*blamed].name(), apart * 1e3, best * 1e3));
    throw Error(
        fmt::format("{}: {}, and no single one is to blame; touch them all again with the tip held still, or "
                    "with a tolerance above {:.1f} mm",
                    what, refusal, tolerance * 1e3));
}

/// The touches of one kind, of one screen.
Numbers numbers_of(std::span<const Touch> touches, const auto& is_one) {
    Numbers numbers;
    for (std::size_t i = 0; i < touches.size(); ++i)
        if (is_one(touches[i])) numbers.push_back(i);
    return numbers;
}

class DisplayFitter {
public:
    DisplayFitter(std::span<const Touch> touches, const DisplayFitOptions& options)
        : touches_(touches), options_(options) {
        for (std::size_t i = 0; i < touches.size(); ++i)
            if (!is_finite(touches[i].reading) || !is_finite(touches[i].place))
                throw BadTouch(i,
                               fmt::format("touch {}, {}, is not a number; touch it again", i + 1, touches[i].name()));
    }

    DisplayFit fit() {
        fit_device();
        fit_mirror();
        for (const Touch& touch : touches_)
            if (is_of_screen(touch) && std::ranges::find(fit_.screens, touch.screen,
                                                         [](const auto& s) { return s.first; }) == fit_.screens.end())
                fit_one_screen(touch.screen);
        return std::move(fit_);
    }

private:
    static bool is_of_screen(const Touch& touch) {
        return touch.of == Touch::Of::screen || touch.of == Touch::Of::image;
    }
    Vec3 placed(const Touch& touch) const { return fit_.device.apply(fit_.stretch * touch.reading); }

    void fit_device() {
        fit_.device = options_.device;
        fit_.stretch = options_.stretch;
        const Numbers numbers = numbers_of(touches_, [](const Touch& t) { return t.of == Touch::Of::workspace; });
        if (numbers.empty()) return;
        const auto pairs_of = [this](const Numbers& of) {
            std::vector<TouchPair> pairs;
            for (const std::size_t i : of) pairs.push_back({touches_[i].reading, touches_[i].place});
            return pairs;
        };
        AffineFit found;
        fit_.parts.push_back(
            fitted("device", numbers, touches_, options_.is_affine ? 6 : 4, options_.tolerance, [&](const Numbers& of) {
                const AffineFit affine = options_.is_affine ? fit_affine(pairs_of(of)) : rigid(pairs_of(of));
                if (of.size() == numbers.size()) found = affine;
                return [affine](const Touch& t) { return glm::length(affine.apply(t.reading) - t.place); };
            }));
        if (options_.is_affine) {
            fit_.device = {found.shift, {1.0, 0.0, 0.0, 0.0}};
            fit_.stretch = found.linear;
        } else {
            fit_.device = {found.shift, glm::normalize(glm::quat_cast(found.linear))};
            fit_.stretch = Mat3(1.0);
        }
    }

    static AffineFit rigid(const std::vector<TouchPair>& pairs) {
        const RigidFit fit = fit_rigid(pairs);
        return {glm::mat3_cast(fit.pose.orientation), fit.pose.position, fit.residual};
    }

    void fit_mirror() {
        fit_.mirror = options_.mirror;
        const Numbers numbers = numbers_of(touches_, [](const Touch& t) { return t.of == Touch::Of::mirror; });
        if (numbers.empty()) return;
        fit_.parts.push_back(fitted("mirror", numbers, touches_, 4, options_.tolerance, [&](const Numbers& of) {
            std::vector<Vec3> points;
            for (const std::size_t i : of) points.push_back(placed(touches_[i]));
            const Plane plane = fit_plane(points, points.front() + Vec3(0.0, 0.0, 1.0)).plane;
            if (of.size() == numbers.size()) fit_.mirror = plane;
            return [this, plane](const Touch& t) { return std::abs(plane.height(placed(t))); };
        }));
    }

    void fit_one_screen(const std::string& name) {
        const std::string what = fmt::format("screen '{}'", name);
        const Numbers numbers =
            numbers_of(touches_, [&](const Touch& t) { return is_of_screen(t) && t.screen == name; });
        const bool is_image = touches_[numbers.front()].of == Touch::Of::image;
        if (is_image && !fit_.mirror)
            throw Error(fmt::format(
                "{}: its image was touched, but where the mirror is was not; touch the mirror as well", what));
        for (const std::size_t i : numbers)
            if ((touches_[i].of == Touch::Of::image) != is_image)
                throw Error(fmt::format("{}: touch either its own marks or those seen in the mirror, not both", what));
        Screen found;
        fit_.parts.push_back(fitted(what, numbers, touches_, 4, options_.tolerance, [&](const Numbers& of) {
            std::vector<ScreenTouch> marks;
            for (const std::size_t i : of) marks.push_back({touches_[i].shown, placed(touches_[i])});
            const Screen screen = fit_screen(marks).screen;
            if (of.size() == numbers.size()) found = screen;
            return [this, screen](const Touch& t) {
                return glm::length(screen.low_left + screen.right() * t.shown.x + screen.up() * t.shown.y - placed(t));
            };
        }));
        check(found, what);
        if (is_image)
            found = {fit_.mirror->reflected(found.low_left), fit_.mirror->reflected(found.low_right),
                     fit_.mirror->reflected(found.high_left)};
        if (fit_.mirror) found.in_mirror = looks_at(*fit_.mirror, found);
        if (is_image && !found.in_mirror)
            throw Error(
                fmt::format("{}: it would look away from the mirror; touch every mark where the mirror shows that "
                            "one, left and right are swapped there",
                            what));
        fit_.screens.emplace_back(name, found);
    }

    /// A mirror shows only a screen that faces it.
    static bool looks_at(const Plane& mirror, const Screen& screen) {
        const Vec3 middle = screen.low_left + 0.5 * (screen.right() + screen.up());
        return mirror.height(middle) * glm::dot(screen.normal(), mirror.normal) < 0.0;
    }

    static void check(const Screen& screen, const std::string& what) {
        const double width = glm::length(screen.right()), height = glm::length(screen.up());
        if (std::min(width, height) < 0.02 || std::max(width, height) > 20.0)
            throw Error(
                fmt::format("{}: {:.0f} x {:.0f} mm is no size of a screen; were other marks touched than those "
                            "that were asked for?",
                            what, width * 1e3, height * 1e3));
    }

    std::span<const Touch> touches_;
    const DisplayFitOptions& options_;
    DisplayFit fit_;
};

}  // namespace

std::string Touch::name() const {
    switch (of) {
        case Of::workspace:
            return fmt::format("place {:.0f}, {:.0f}, {:.0f} mm of the workspace", place.x * 1e3, place.y * 1e3,
                               place.z * 1e3);
        case Of::mirror: return "the mirror";
        case Of::image: return fmt::format("the image of mark ({:g}, {:g}) of screen '{}'", shown.x, shown.y, screen);
        case Of::screen: break;
    }
    return fmt::format("mark ({:g}, {:g}) of screen '{}'", shown.x, shown.y, screen);
}

DisplayFit fit_display(std::span<const Touch> touches, const DisplayFitOptions& options) {
    return DisplayFitter(touches, options).fit();
}

}  // namespace tactus::display
