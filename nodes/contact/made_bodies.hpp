// SPDX-License-Identifier: Apache-2.0
// Bodies that were made from parameters, kept for the next run in the same process.
#pragma once

#include "nodes/contact/body_parts.hpp"

#include <array>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <utility>

namespace tactus::nodes {

/// Parameters that determine a body, SI.
using BodyKey = std::array<double, 13>;

/// The bodies used last, up to 64 MB. A process that runs a patch many times (a sweep, a host, the window after an edit)
/// samples a distance field once: for two spheres that is nine tenths of the time of a short run. They are immutable and
/// shared, so a run has the same bits with or without.
class MadeBodies {
public:
    static constexpr std::size_t max_bytes = 64 << 20;

    static MadeBodies& of_process() {
        static MadeBodies all;
        return all;
    }

    /// Returns the body of `key`, or makes it. Any thread; may allocate. Exceptions of `make` pass.
    std::shared_ptr<const BodyParts> get(const BodyKey& key,
                                         const std::function<std::shared_ptr<const BodyParts>()>& make) {
        {
            const std::lock_guard hold(lock_);
            for (auto one = kept_.begin(); one != kept_.end(); ++one)
                if (one->first == key) {
                    kept_.splice(kept_.begin(), kept_, one);
                    return one->second;
                }
        }
        std::shared_ptr<const BodyParts> made = make();
        const std::lock_guard hold(lock_);
        kept_.emplace_front(key, made);
        std::size_t bytes = 0;
        for (auto one = kept_.begin(); one != kept_.end();) {
            bytes += bytes_of(*one->second);
            one = bytes > max_bytes ? kept_.erase(one) : std::next(one);
        }
        return made;
    }

private:
    static std::size_t bytes_of(const BodyParts& body) {
        constexpr std::size_t bytes_per_point = 128;  // position, normal, area, nodes of the tree
        // Of triangles, about two per point of the surface.
        return body.map.grid.values.size() * sizeof(float) +
               body.shell.position.size() * bytes_per_point * (body.triangles ? 3 : 1);
    }

    std::mutex lock_;
    std::list<std::pair<BodyKey, std::shared_ptr<const BodyParts>>> kept_;
};

}  // namespace tactus::nodes
