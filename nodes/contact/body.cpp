// SPDX-License-Identifier: Apache-2.0
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"
#include "nodes/contact/body_parts.hpp"

#include <memory>

namespace tactus::nodes {

struct Body {
    static constexpr auto about =
        "Makes a body for a scene from a bone: surface points and a distance field. Its frame has the axes of the file "
        "and the centroid of the points as its origin.";

    Out<tactus::coupling::Body> body{"for a scene"};
    Out<double> count{"number of surface points"};
    Asset<bone::Bone> bone{"the bone"};
    Param spacing{structural, "0 mm", "0 mm", "20 mm",
                  "of the points; 0: the points in the file, or 0.5 mm if it has none"};
    Flag triangles{false, "also make the surface triangles, for point_proxy and sphere_proxy"};

    std::vector<Visual> visuals() const { return {{.kind = VisualKind::asset_bone, .value = "body", .asset = "bone"}}; }

    void prepare(const Setup& setup) {
        try {
            parts_ = parts_of(*bone, spacing, triangles);
        } catch (const Error& error) {
            setup.fail(error.message());
        }
        name_ = setup.name;
        publish();
    }
    void process(const Tick&) noexcept { publish(); }

    void report(Report& report) const { report.set(name_, "points", static_cast<double>(parts_->shell.size())); }

private:
    void publish() noexcept {
        body = parts_->body();
        count = static_cast<double>(parts_->shell.size());
    }

    std::shared_ptr<const BodyParts> parts_;
    std::string name_;
};

TACTUS_NODE(Body, body, count, bone, spacing, triangles)
TACTUS_VISUALS(Body)

}  // namespace tactus::nodes
