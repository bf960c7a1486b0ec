// SPDX-License-Identifier: Apache-2.0
#include "tools/report/bone/fracture_surface_result.hpp"

#include "tools/analysis/bone/intact_side.hpp"
#include "tools/report/bone/pose_fields.hpp"

#include <fmt/format.h>

#include <optional>

namespace tactus::report {

namespace {

using fit::Registration;
using plan::PaintedFace;

std::optional<std::string> doubt_of(const ProposedSurface& s) {
    if (!s.is_doubtful()) return std::nullopt;
    const bool has_main = !s.settings->main.empty();
    return fmt::format(
        "the unbroken bone lies more than {:.0f} mm away from half of the {}fragment: what is proposed is not its "
        "fracture; {}check that it is the same bone{}",
        analysis::max_intact_median * 1e3, has_main ? "main " : "",
        has_main ? "" : "name the largest fragment of the same scan with --main, and ",
        s.settings->mirror ? "" : ", and --mirror if it is from the other side of the body");
}

std::vector<std::string> warnings_of(const ProposedSurface& s) {
    std::vector<std::string> all;
    if (const auto doubt = doubt_of(s)) all.push_back(*doubt);
    if (s.found->as_scanned > 0.0) all.push_back(left_out_words(s.settings->bone.string(), s.found->as_scanned));
    if (s.faces.empty()) all.emplace_back("no fracture surface found; paint it by hand, or lower --roughness");
    return all;
}

const Fields<Registration>& residual_fields() {
    using R = Registration;
    static const Fields<R> all = Fields<R>("distance of a surface from the unbroken bone")
                                     .number("median_mm", "median", from_si(2, "mm"), &R::median)
                                     .number("p90_mm", "90 % within", from_si(2, "mm"), &R::p90);
    return all;
}

const Fields<ProposedSurface>& intact_fields() {
    using S = ProposedSurface;
    static const Fields<S> all = Fields<S>("registration of the unbroken bone")
                                     .text("file", "", [](const S& s) { return s.settings->intact.string(); })
                                     .child("on_main", "unbroken bone on the main fragment", residual_fields(),
                                            [](const S& s) -> const Registration& { return s.found->intact->on_main; })
                                     .child("on_bone", "unbroken bone on this fragment", residual_fields(),
                                            [](const S& s) { return s.found->intact->on_bone; })
                                     .omitted()
                                     .text("doubt", "", doubt_of);
    return all;
}

const Fields<PaintedFace>& face_fields() {
    using F = PaintedFace;
    static const Fields<F> all = Fields<F>("proposed fracture surface")
                                     .number("area_mm2", "area", from_si(0, "mm²"), &F::area)
                                     .integer("points", "points", &F::points)
                                     .vector("middle_mm", "middle", from_si(1, "mm"), &F::middle)
                                     .vector("normal", "looks along", fixed(2), &F::normal);
    return all;
}

}  // namespace

bool ProposedSurface::is_doubtful() const {
    return found->intact && found->intact->on_main.median > analysis::max_intact_median;
}

const Fields<ProposedSurface>& proposed_surface_fields() {
    using S = ProposedSurface;
    static const Fields<S> all =
        Fields<S>("proposed fracture surface of a fragment")
            .warnings("", warnings_of)
            .text("file", "paint",
                  [](const S& s) { return s.file.empty() ? std::nullopt : std::optional(s.file.string()); })
            .number("as_scanned_mm2", "", from_si(0, "mm²"), [](const S& s) { return s.found->as_scanned; })
            .child("intact", "", intact_fields(), [](const S& s) { return s.found->intact ? &s : nullptr; })
            .omitted()
            .rows("faces", "proposed", face_fields(), &S::faces);
    return all;
}

}  // namespace tactus::report
