// SPDX-License-Identifier: Apache-2.0
#include "tools/report/bone/scan_result.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/vessel/runoff.hpp"
#include "dsp/vessel/track_warnings.hpp"
#include "tools/analysis/bone/saw_spacing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::report {

namespace {

using analysis::InspectedPart;
using bone::ImportSummary;

/// Of lists that JSON has whole.
constexpr std::size_t max_printed = 3;

/// In the unit in which the number is neither long nor zero.
std::string volume_text(double mm3) {
    if (mm3 >= 1e5) return fmt::format("{:.1f} cm³", mm3 * 1e-3);
    if (mm3 >= 100.0) return fmt::format("{:.0f} mm³", mm3);
    if (mm3 >= 1e-3) return fmt::format("{:.3g} mm³", mm3);
    return fmt::format("{:.0f} µm³", mm3 * 1e9);
}

const Fields<InspectedPart>& part_fields() {
    using P = InspectedPart;
    const auto along = [](int axis) {
        return [axis](const P& p) { return p.bounds_mm[static_cast<std::size_t>(axis)]; };
    };
    static const Fields<P> all =
        Fields<P>("component")
            .text("name", "component", &P::name)
            .number("volume_mm3", "", fixed(0, "mm³"), &P::volume_mm3)
            .text("", "volume", [](const P& p) { return volume_text(p.volume_mm3); })
            .vector("", "x", fixed(1, "mm"), along(0))
            .vector("", "y", fixed(1, "mm"), along(1))
            .vector("", "z", fixed(1, "mm"), along(2))
            .points("bounds_mm", [](const P& p) {
                return ResultEntry::Series{6, [b = p.bounds_mm](std::size_t n) { return b[n / 2][n % 2]; }, 2};
            });
    return all;
}

/// A value of a scan and how often it occurs; of CTs most are air, so that bars are logarithmic.
struct HistogramRow {
    double value, share;
    std::uint64_t count;
};

const Fields<HistogramRow>& histogram_fields() {
    using H = HistogramRow;
    static const Fields<H> all =
        Fields<H>("bin of a histogram")
            .number("", "value", fixed(0), &H::value)
            .text("", "log of the count",
                  [](const H& h) { return std::string(static_cast<std::size_t>(h.share * 40.0), '#'); })
            .integer("", "samples", &H::count);
    return all;
}

std::vector<HistogramRow> histogram_of(const InspectedFile& f) {
    std::vector<HistogramRow> rows;
    if (f.found->kind == "mesh") return rows;
    const volume::Histogram& histogram = f.found->histogram;
    std::uint64_t most = 1;
    for (const std::uint64_t count : histogram.counts) most = std::max(most, count);
    for (std::size_t n = 0; n < histogram.counts.size(); ++n)
        rows.push_back({histogram.middle(n), std::log1p(double(histogram.counts[n])) / std::log1p(double(most)),
                        histogram.counts[n]});
    return rows;
}

std::optional<std::string> if_any(const std::string& text) { return text.empty() ? std::nullopt : std::optional(text); }

struct Density {
    double min, max, mean;
};

const Fields<Density>& density_fields() {
    static const Fields<Density> all = Fields<Density>("density of the samples inside")
                                           .number("min", "", fixed(0, "kg/m^3"), &Density::min)
                                           .number("max", "", fixed(0, "kg/m^3"), &Density::max)
                                           .number("mean", "", fixed(0, "kg/m^3"), &Density::mean);
    return all;
}

/// Of a CT.
const Fields<ImportSummary>& threshold_fields() {
    using S = ImportSummary;
    static const Fields<S> all =
        Fields<S>("threshold of bone")
            .number("hu", "", significant(6, "HU"), [](const S& s) { return s.threshold.hu; })
            .text("from", "", [](const S& s) { return s.threshold.from; })
            .number("above_mm3", "", fixed(0, "mm³"), [](const S& s) { return s.threshold.above_mm3; })
            .number("kept_mm3", "", fixed(0, "mm³"), [](const S& s) { return s.threshold.kept_mm3; })
            .number("mask_mm3", "", fixed(0, "mm³"), [](const S& s) { return s.threshold.mask_mm3; })
            .omitted();
    return all;
}

std::string threshold_text(const ImportedFile& f) {
    const ImportSummary& s = *f.summary;
    if (!s.threshold.hu) return {};
    return fmt::format("{:g} HU ({}): voxels of {:.1f} cm³ reach it, {:.1f} cm³ were kept ({})", *s.threshold.hu,
                       s.threshold.from, s.threshold.above_mm3 * 1e-3, s.threshold.kept_mm3 * 1e-3,
                       f.component == "largest" || f.component == "all" ? "component " + f.component
                                                                        : f.component + " largest components");
}

std::string density_source(const ImportedFile& f) {
    if (f.summary->hu == "none") return f.is_density_given ? "given" : "assumed";
    return f.summary->hu == "masked" ? "from HU of a masked scan, without a density phantom"
                                     : "from calibrated HU, without a density phantom";
}

const Fields<ImportedFile>& imported_fields() {
    using F = ImportedFile;
    const auto of = [](auto member) { return [member](const F& f) { return f.summary->*member; }; };
    static const Fields<F> all =
        Fields<F>("bone that was imported")
            .titled([](const F& f) { return f.name; })
            .text("frame", "", of(&ImportSummary::frame))
            .text("hu", "", of(&ImportSummary::hu))
            .integers("size", "voxels", of(&ImportSummary::size))
            .vector("voxel_mm", "voxel", significant(3, "mm"), of(&ImportSummary::voxel_mm))
            .number("bone_volume_mm3", "volume of bone", fixed(0, "mm³"), of(&ImportSummary::bone_volume_mm3))
            .number("surface_area_mm2", "surface", fixed(0, "mm²"), of(&ImportSummary::surface_area_mm2))
            .integer("components", "components found", of(&ImportSummary::components))
            .integer("components_kept", "", of(&ImportSummary::components_kept))
            .text("", "threshold", threshold_text)
            .child("threshold", "", threshold_fields(),
                   [](const F& f) { return f.summary->threshold.hu ? f.summary : nullptr; })
            .text("", "filled, with the density of the scan",
                  [](const F& f) {
                      const ImportSummary& s = *f.summary;
                      return s.hollow_mm3 + s.marrow_mm3 > 0.0
                                 ? fmt::format(
                                       "{:.2f} cm³ of closed hollows, {:.2f} cm³ of marrow behind a shell that "
                                       "leaks (--fill none leaves both out)",
                                       s.hollow_mm3 * 1e-3, s.marrow_mm3 * 1e-3)
                                 : std::string();
                  })
            .text("", "mask",
                  [](const F& f) {
                      return f.summary->threshold.mask_mm3
                                 ? fmt::format(
                                       "the mask of the scan holds {:.1f} cm³; a lower --threshold takes more "
                                       "of it",
                                       *f.summary->threshold.mask_mm3 * 1e-3)
                                 : std::string();
                  })
            .child("density", "", density_fields(),
                   [](const F& f) {
                       const auto& d = f.summary->density;
                       return Density{d.min, d.max, d.mean};
                   })
            .text("", "density",
                  [](const F& f) {
                      const auto& d = f.summary->density;
                      return fmt::format("{:.0f} to {:.0f}, mean {:.0f} kg/m³ ({})", d.min, d.max, d.mean,
                                         density_source(f));
                  })
            .number("metal_mm3", "", fixed(0, "mm³"), of(&ImportSummary::metal_mm3))
            .number("hollow_mm3", "", fixed(0, "mm³"), of(&ImportSummary::hollow_mm3))
            .number("marrow_mm3", "", fixed(0, "mm³"), of(&ImportSummary::marrow_mm3))
            .number("narrowest_kerf_mm", "", fixed(2, "mm"),
                    [](const F& f) { return analysis::narrowest_kerf_mm(f.summary->voxel_mm); })
            .text("", "saw", [](const F& f) { return analysis::saw_line(f.summary->voxel_mm); })
            .integer("points", "", of(&ImportSummary::points))
            .text("", "points on the surface",
                  [](const F& f) { return f.summary->points > 0 ? std::to_string(f.summary->points) : std::string(); })
            .notes("notes", "note", of(&ImportSummary::notes));
    return all;
}

const Fields<ImportedFile>& labelled_fields() {
    using F = ImportedFile;
    static const Fields<F> all = Fields<F>("bone of a label map")
                                     .part(imported_fields(), [](const F& f) -> const F& { return f; })
                                     .text("name", "", &F::name)
                                     .integer("label", "label", &F::label)
                                     .text("", "surface", &F::surface);
    return all;
}

const Fields<analysis::SegmentedLabel>& label_fields() {
    using L = analysis::SegmentedLabel;
    static const Fields<L> all = Fields<L>("fragment")
                                     .text("name", "fragment", &L::name)
                                     .integer("voxels", "voxels", &L::voxels)
                                     .number("volume_mm3", "volume", from_si(1, "mm³"), &L::volume);
    return all;
}

const Fields<analysis::UnseededIsland>& island_fields() {
    using I = analysis::UnseededIsland;
    static const Fields<I> all = Fields<I>("island of bone without a seed")
                                     .integer("voxels", "voxels", &I::voxels)
                                     .vector("centre_mm", "about", from_si(1, "mm"), &I::centre);
    return all;
}

const Fields<analysis::UncertainPlace>& uncertain_fields() {
    using U = analysis::UncertainPlace;
    static const Fields<U> all = Fields<U>("place whose fragment is uncertain")
                                     .integer("voxels", "voxels below 0.4", &U::voxels)
                                     .vector("deepest_mm", "least certain at", from_si(1, "mm"), &U::deepest);
    return all;
}

const Fields<analysis::TouchingFace>& touching_fields() {
    using T = analysis::TouchingFace;
    static const Fields<T> all = Fields<T>("fragments that touch in the scan")
                                     .texts("labels", "fragments", [](const T& t) { return std::vector{t.a, t.b}; })
                                     .number("area_mm2", "area", from_si(0, "mm²"), &T::area)
                                     .flag("as_scanned", "", [](const T&) { return true; });
    return all;
}

/// The first rows of a list in print; JSON has all.
template <class U>
ResultEntry::Rows first_rows(const Fields<U>& of_row, const std::vector<U>& all) {
    ResultEntry::Rows rows{{}, of_row.columns()};
    for (std::size_t n = 0; n < std::min(max_printed, all.size()); ++n) rows.rows.push_back(of_row.of(all[n]));
    return rows;
}

/// Of a list that is printed in part.
template <class U>
std::string rest_text(const std::vector<U>& all, const char* what) {
    return all.size() > max_printed ? fmt::format("{} more {}", all.size() - max_printed, what) : std::string();
}

const Fields<analysis::ScanGraph>& scan_threshold_fields() {
    using S = analysis::ScanGraph;
    static const Fields<S> all = Fields<S>("threshold of bone")
                                     .number("value", "", significant(6), &S::threshold)
                                     .text("from", "", &S::threshold_from);
    return all;
}

const Fields<segmentation::GapLaw>& law_fields() {
    using L = segmentation::GapLaw;
    static const Fields<L> all = Fields<L>("law of the gaps between fragments")
                                     .number("bright", "", significant(4), &L::bright)
                                     .number("width", "", significant(4), &L::width);
    return all;
}

const vessel::Node* narrowest(const vessel::Branch& branch) {
    const vessel::Node* found = nullptr;
    for (const vessel::Node& node : branch.nodes)
        if (!node.is_lost && (!found || node.radius < found->radius)) found = &node;
    return found;
}

/// Mean over the nodes of a branch.
auto mean_of(double vessel::Node::* member) {
    return [member](const vessel::Branch& b) {
        double sum = 0.0;
        for (const vessel::Node& node : b.nodes) sum += node.*member / double(b.nodes.size());
        return sum;
    };
}

const Fields<vessel::Node>& minimum_fields() {
    using N = vessel::Node;
    static const Fields<N> all = Fields<N>("narrowest place of a branch")
                                     .number("radius_mm", "radius", from_si(2, "mm"), &N::radius)
                                     .vector("at_mm", "at", from_si(1, "mm"), &N::position)
                                     .flag("uncertain", "uncertain", &N::is_radius_uncertain);
    return all;
}

const Fields<vessel::Branch>& stenosis_fields() {
    using B = vessel::Branch;
    static const Fields<B> all =
        Fields<B>("narrowing of a branch")
            .number("percent", "", fixed(0, "%"),
                    [](const B& b) {
                        Number percent = b.stenosis->percent;
                        percent.uncertainty = b.stenosis->error_percent;
                        return percent;
                    })
            .number("error_percent", "", fixed(0, "%"), [](const B& b) { return b.stenosis->error_percent; })
            .number("radius_mm", "", from_si(2, "mm"), [](const B& b) { return b.stenosis->radius; })
            .number("reference_radius_mm", "", from_si(2, "mm"),
                    [](const B& b) { return b.stenosis->reference_radius; })
            .vector("at_mm", "", from_si(1, "mm"), [](const B& b) { return b.nodes[b.stenosis->node].position; })
            .flag("uncertain", "", [](const B& b) { return b.stenosis->is_uncertain; });
    return all;
}

const Fields<vessel::LostStretch>& lost_fields() {
    using L = vessel::LostStretch;
    static const Fields<L> all = Fields<L>("stretch without contrast, bridged")
                                     .number("from_mm", "from", from_si(1, "mm"), &L::from)
                                     .number("to_mm", "to", from_si(1, "mm"), &L::to);
    return all;
}

const Fields<vessel::Branch>& branch_fields() {
    using B = vessel::Branch;
    static const Fields<B> all =
        Fields<B>("branch of a vessel")
            .integer("parent", "", &B::parent)
            .text("", "leaves branch",
                  [](const B& b) { return b.parent < 0 ? std::string() : std::to_string(b.parent); })
            .integer("nodes", "", [](const B& b) { return b.nodes.size(); })
            .number("length_mm", "length", from_si(1, "mm"), &B::length)
            .number("mean_radius_mm", "", from_si(2, "mm"), mean_of(&vessel::Node::radius))
            .number("mean_contrast", "", significant(4), mean_of(&vessel::Node::contrast))
            .number("mean_confidence", "", fixed(2), mean_of(&vessel::Node::confidence))
            .vector("from_mm", "", from_si(1, "mm"), [](const B& b) { return b.nodes.front().position; })
            .vector("to_mm", "", from_si(1, "mm"), [](const B& b) { return b.nodes.back().position; })
            .text("starts", "starts where",
                  [](const B& b) { return b.parent < 0 ? std::string(vessel::reason_of(b.start)) : "at its parent"; })
            .text("ends", "ends where", [](const B& b) { return std::string(vessel::reason_of(b.end)); })
            .integer(
                "meets", "meets branch",
                [](const B& b) { return b.end == vessel::End::meets_track ? std::optional(b.meets) : std::nullopt; })
            .omitted()
            .child("minimum", "narrowest", minimum_fields(), narrowest)
            .omitted()
            .text("", "narrowing",
                  [](const B& b) {
                      return b.stenosis && b.stenosis->percent >= 20.0 ? vessel::text_of(b, *b.stenosis)
                                                                       : std::string();
                  })
            .child("stenosis", "", stenosis_fields(), [](const B& b) { return b.stenosis ? &b : nullptr; })
            .rows("lost", "without contrast along it, bridged", lost_fields(), &B::lost);
    return all;
}

const Fields<vessel::SeenArtery>& artery_fields() {
    using A = vessel::SeenArtery;
    static const Fields<A> all = Fields<A>("artery of a lower leg")
                                     .flag("seen", "seen", &A::is_seen)
                                     .number("from_level", "from level", fixed(2), &A::from)
                                     .number("to_level", "to level", fixed(2), &A::to)
                                     .flag("reaches_foot", "reaches the foot", &A::reaches_foot)
                                     .flag("lost", "has stretches without contrast", &A::has_lost_stretch);
    return all;
}

/// An object with a member for each artery.
const Fields<vessel::RunOff>& arteries_fields() {
    using R = vessel::RunOff;
    static const Fields<R> all = [] {
        Fields<R> made("arteries of a lower leg");
        for (std::size_t n = 0; n < R().arteries.size(); ++n) {
            const std::string name(vessel::name_of(static_cast<vessel::LegArtery>(n)));
            made.child(name, name + " artery", artery_fields(),
                       [n](const R& r) -> const vessel::SeenArtery& { return r.arteries[n]; });
        }
        return made;
    }();
    return all;
}

const Fields<vessel::RunOff>& run_off_fields() {
    using R = vessel::RunOff;
    static const Fields<R> all =
        Fields<R>("run-off of a lower leg")
            .flag("judged", "judged", &R::is_judged)
            .child("arteries", "arteries", arteries_fields(), [](const R& r) -> const R& { return r; })
            .texts("warnings", "", &R::warnings);
    return all;
}

}  // namespace

const Fields<InspectedFile>& inspection_fields() {
    using F = InspectedFile;
    using I = analysis::Inspection;
    const auto of = [](auto member) { return [member](const F& f) { return f.found->*member; }; };
    static const Fields<F> all =
        Fields<F>("scan, label map, mesh or bone file")
            .titled([](const F& f) { return f.file; })
            .warnings(
                "",
                [](const F& f) {
                          // Lengths are right only if mm was meant.
                    return f.found->unit_question.empty()
                               ? std::vector<std::string>()
                               : std::vector{f.found->unit_question + "; until then, lengths are printed as if in mm"};
                })
            .text("kind", "kind", of(&I::kind))
            .text("frame", "frame", of(&I::frame))
            .integers("size", "", of(&I::size))
            .text("", "voxels",
                  [](const F& f) {
                      const auto& [x, y, z] = f.found->size;
                      return x > 0 ? fmt::format("{} x {} x {}{}", x, y, z,
                                                 f.found->uniform ? "" : ", slices unevenly spaced")
                                   : std::string();
                  })
            .vector("spacing_mm", "", significant(4, "mm"), of(&I::spacing_mm))
            .vector("", "voxel", significant(4, "mm"),
                    [](const F& f) { return f.found->size[0] > 0 ? std::optional(f.found->spacing_mm) : std::nullopt; })
            .flag("uniform", "", of(&I::uniform))
            .number("tilt_deg", "", fixed(1, "°"), of(&I::tilt_deg))
            .number(
                "", "tilt", fixed(1, "°"),
                [](const F& f) { return f.found->tilt_deg > 0.05 ? std::optional(f.found->tilt_deg) : std::nullopt; })
            .text("hu", "hu", of(&I::hu))
            .vector("range", "", significant(6), of(&I::range))
            .vector("", "values, least and greatest", significant(6),
                    [](const F& f) { return f.found->kind == "mesh" ? std::nullopt : std::optional(f.found->range); })
            .number("suggested_threshold", "", significant(6), of(&I::threshold))
            .text("", "suggested threshold",
                  [](const F& f) {
                      return f.found->threshold
                                 ? fmt::format("{:g}{} ({}); import uses it unless --threshold is given",
                                               *f.found->threshold, f.found->is_in_hu ? " HU" : ", not in HU",
                                               f.found->threshold_from)
                                 : std::string();
                  })
            .text("unit", "", [](const F& f) { return if_any(f.found->unit); })
            .text("unit_question", "", [](const F& f) { return if_any(f.found->unit_question); })
            .text("", "saw",
                  [](const F& f) {
                      return f.found->kind == "ct" || f.found->kind == "bone" ? analysis::saw_line(f.found->spacing_mm)
                                                                              : std::string();
                  })
            .notes("notes", "note", of(&I::notes))
            .rows("", "histogram", histogram_fields(), histogram_of)
            .rows("components", "components", part_fields(), [](const F& f) -> const auto& { return f.found->parts; })
            .text("", "smaller components",
                  [](const F& f) {
                      const std::size_t smaller = f.found->parts_in_all - f.found->parts.size();
                      return smaller > 0 ? std::to_string(smaller) : std::string();
                  })
            .text("", "picture", [](const F& f) { return f.picture.empty() ? "-o PICTURE.png makes one" : f.picture; });
    return all;
}

const Fields<ImportedBones>& imported_bone_fields() {
    using B = ImportedBones;
    static const Fields<B> all = Fields<B>("bone that was imported")
                                     .titled([](const B& b) { return b.file; })
                                     .part(imported_fields(), [](const B& b) -> const auto& { return b.bones.front(); })
                                     .text("file", "", &B::file);
    return all;
}

const Fields<ImportedBones>& imported_labels_fields() {
    using B = ImportedBones;
    static const Fields<B> all = Fields<B>("bones of a label map")
                                     .titled([](const B& b) { return b.file; })
                                     .children("bones", "bone", labelled_fields(), &B::bones)
                                     .text("file", "", &B::file);
    return all;
}

const Fields<SegmentedFile>& segmentation_fields() {
    using S = SegmentedFile;
    using Found = analysis::SegmentedScan;
    const auto of = [](auto member) { return [member](const S& s) -> const auto& { return s.found->*member; }; };
    static const Fields<S> all =
        Fields<S>("fragments of a scan")
            .warnings("",
                      [](const S& s) {
                          std::vector<std::string> texts;
                          if (!s.found->islands.empty())
                              texts.push_back(fmt::format("no seed in {} island{} of bone", s.found->islands.size(),
                                                          s.found->islands.size() == 1 ? "" : "s"));
                          if (!s.found->touching.empty())
                              texts.emplace_back(
                                  "where fragments touch in the scan their faces are as scanned, and do not show where "
                                  "they fit");
                          return texts;
                      })
            .texts("files", "files", &S::files)
            .child("threshold", "", scan_threshold_fields(), [](const S& s) { return s.scan; })
            .text("", "bone from",
                  [](const S& s) {
                      return fmt::format("{:g}{} ({}), {} voxels", s.scan->threshold, s.scan->is_in_hu ? " HU" : "",
                                         s.scan->threshold_from, s.scan->graph.nodes());
                  })
            .rows("labels", "fragments", label_fields(), of(&Found::labels))
            .rows("touching", "", touching_fields(), of(&Found::touching))
            .table("touching", [](const S& s) { return first_rows(touching_fields(), s.found->touching); })
            .text("", "touching", [](const S& s) { return rest_text(s.found->touching, "pairs touch"); })
            .rows("unseeded_islands", "", island_fields(), of(&Found::islands))
            .table("islands without a seed", [](const S& s) { return first_rows(island_fields(), s.found->islands); })
            .text("", "islands without a seed",
                  [](const S& s) {
                      const std::vector<analysis::UnseededIsland>& islands = s.found->islands;
                      std::size_t rest = 0;
                      for (std::size_t n = max_printed; n < islands.size(); ++n) rest += islands[n].voxels;
                      return rest > 0 ? fmt::format("{}, {} voxels in all", rest_text(islands, "islands"), rest)
                                      : std::string();
                  })
            .rows("uncertain", "", uncertain_fields(), of(&Found::uncertain))
            .table("paint first", [](const S& s) { return first_rows(uncertain_fields(), s.found->uncertain); })
            .integer("marrow_voxels", "", [](const S& s) { return s.found->marrow_voxels; })
            .integer("metal_voxels", "", [](const S& s) { return s.scan->metal_voxels; })
            .child("gap_law", "", law_fields(), of(&Found::law))
            .number("residual", "residual", significant(2), of(&Found::residual))
            .integer("iterations", "iterations", [](const S& s) { return s.found->iterations; })
            .number("seconds", "processor time", fixed(2, "s"), of(&Found::seconds))
            .number("certainty_p05", "95 % of the voxels are more certain than", fixed(2), of(&Found::certainty_p05))
            .notes("notes", "note", [](const S& s) { return s.scan->notes; });
    return all;
}

const Fields<FollowedVessel>& vessel_track_fields() {
    using F = FollowedVessel;
    const auto of = [](auto member) { return [member](const F& f) { return f.found->found.track.*member; }; };
    using Track = vessel::Track;
    static const Fields<F> all =
        Fields<F>("vessel that was followed")
            .warnings(
                "",
                [](const F& f) {
                    std::vector<std::string> texts;
                    for (const std::string& doubt : f.found->found.track.doubts)
                        texts.push_back(doubt + ": this may be no vessel");
                    return texts;
                },
                "problem")
            .warnings("warnings", [](const F& f) { return f.found->warnings; })
            .flag("found", "found", [](const F& f) { return !f.found->found.track.branches.empty(); })
            .vector("seed_mm", "", from_si(1, "mm"), &F::seed)
            .text("why", "reason",
                  [](const F& f) {
                      return f.found->found.track.branches.empty() ? std::optional(f.found->found.why) : std::nullopt;
                  })
            .omitted()
            .number("length_mm", "length in all", from_si(1, "mm"),
                    [](const F& f) { return f.found->found.track.length(); })
            .number("noise", "", significant(4), [](const F& f) { return f.found->found.track.noise.sigma; })
            .number("contrast", "", significant(4), of(&Track::contrast))
            .number("excluded_above", "", significant(4), of(&Track::excluded_above))
            .number("seconds", "processor time", fixed(2, "s"), [](const F& f) { return f.found->seconds; })
            .children("branches", "branch", branch_fields(),
                      [](const F& f) -> const auto& { return f.found->found.track.branches; })
            .child("run_off", "run-off", run_off_fields(), [](const F& f) -> const auto& { return f.found->run_off; })
            .omitted()
            .notes("notes", "note", [](const F& f) { return f.found->notes; })
            .texts("doubts", "", of(&Track::doubts));
    return all;
}

}  // namespace tactus::report
