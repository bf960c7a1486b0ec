// SPDX-License-Identifier: Apache-2.0
// FCL and Bullet beside `tactus bench contact`, which runs this program: NAME POINTS RADIUS APART FRAMES, with radius in
// voxels and the distance of the centres in radii. Prints one JSON row per library.
//
// The nearest they have: the shell's points as corners of a closed triangle mesh, in a tree of boxes, against a solid
// ball that is given by formula; every contact is wanted. Lengths in mm.
#include "tools/bench/contact_cases.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <btBulletCollisionCommon.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

namespace tactus {

namespace {

using namespace tactus::bench;

struct Mesh {
    std::vector<Vec3> corners;
    std::vector<std::array<int, 3>> triangles;
};

/// A cube of squares blown up to a ball with about `count` corners.
Mesh ball_mesh(int count, double radius) {
    const int n = std::max(1, static_cast<int>(std::lround(std::sqrt(count / 6.0))));
    Mesh mesh;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3,
                  first = static_cast<int>(mesh.corners.size());
        const double side = face % 2 ? 1.0 : -1.0;
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) {
                Vec3 p(side);
                p[u] = std::tan(0.7853981633974483 * (2.0 * i / n - 1.0));
                p[v] = std::tan(0.7853981633974483 * (2.0 * j / n - 1.0));
                mesh.corners.push_back(radius * glm::normalize(p));
            }
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const int a = first + j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({a, d, c});
            }
    }
    return mesh;
}

struct Timing {
    std::vector<double> seconds;
    std::size_t contacts = 0;
};

template <class Query>
Timing measure(const Case& c, int frames, const Query& query) {
    Timing timing;
    for (int frame = -1; frame < frames; ++frame) {  // the first is not counted
        const Pose pose = pose_of(c, static_cast<std::uint64_t>(frame + 1));
        const double begin = thread_seconds();
        timing.contacts = query(pose);
        if (frame >= 0) timing.seconds.push_back(thread_seconds() - begin);
    }
    return timing;
}

Timing in_fcl(const Mesh& mesh, const Case& c, int frames) {
    auto shell = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    std::vector<fcl::Vector3d> corners;
    for (const Vec3& p : mesh.corners) corners.emplace_back(p.x, p.y, p.z);
    std::vector<fcl::Triangle> triangles;
    for (const auto& t : mesh.triangles)
        triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                               static_cast<std::size_t>(t[2]));
    shell->beginModel();
    shell->addSubModel(corners, triangles);
    shell->endModel();
    fcl::CollisionObjectd moving(shell), ball(std::make_shared<fcl::Sphered>(1e3 * c.ball()));
    const fcl::CollisionRequestd request(4 * triangles.size(), true);
    return measure(c, frames, [&](const Pose& pose) {
        const Quat& q = pose.orientation;
        const Vec3 p = 1e3 * pose.position;
        moving.setTransform(fcl::Quaterniond(q.w, q.x, q.y, q.z), fcl::Vector3d(p.x, p.y, p.z));
        fcl::CollisionResultd result;
        fcl::collide(&moving, &ball, request, result);
        return result.numContacts();
    });
}

struct Count final : btCollisionWorld::ContactResultCallback {
    std::size_t contacts = 0;
    btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
        ++contacts;
        return 0;
    }
};

Timing in_bullet(const Mesh& mesh, const Case& c, int frames) {
    btTriangleMesh triangles;
    const auto at = [&](int n) {
        const Vec3& p = mesh.corners[static_cast<std::size_t>(n)];
        return btVector3(static_cast<btScalar>(p.x), static_cast<btScalar>(p.y), static_cast<btScalar>(p.z));
    };
    for (const auto& t : mesh.triangles) triangles.addTriangle(at(t[0]), at(t[1]), at(t[2]));
    btBvhTriangleMeshShape shell(&triangles, true);
    shell.setMargin(0);
    btSphereShape sphere(static_cast<btScalar>(1e3 * c.ball()));
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btCollisionWorld world(&dispatcher, &broadphase, &configuration);
    btCollisionObject moving, ball;
    moving.setCollisionShape(&shell);
    ball.setCollisionShape(&sphere);
    return measure(c, frames, [&](const Pose& pose) {
        const Quat& q = pose.orientation;
        const Vec3 p = 1e3 * pose.position;
        const auto s = [](double v) { return static_cast<btScalar>(v); };
        moving.setWorldTransform(
            btTransform(btQuaternion(s(q.x), s(q.y), s(q.z), s(q.w)), btVector3(s(p.x), s(p.y), s(p.z))));
        Count count;
        world.contactPairTest(&moving, &ball, count);
        return count.contacts;
    });
}

void tell(const char* peer, const Mesh& mesh, const Timing& timing) {
    const double p50 = percentile(timing.seconds, 0.5), p99 = percentile(timing.seconds, 0.99);
    std::printf(
        "{\"peer\": \"%s\", \"corners\": %zu, \"triangles\": %zu, \"contacts\": %zu, \"ns_per_point\": %.6g, "
        "\"us_per_frame_p50\": %.6g, \"us_per_frame_p99\": %.6g}\n",
        peer, mesh.corners.size(), mesh.triangles.size(), timing.contacts,
        1e9 * p50 / static_cast<double>(mesh.corners.size()), 1e6 * p50, 1e6 * p99);
}

}  // namespace

}  // namespace tactus

int main(int argc, char** argv) {
    using namespace tactus;
    if (argc != 6) {
        std::fputs("usage: bench_contact_libraries NAME POINTS RADIUS APART FRAMES\n", stderr);
        return 2;
    }
    const Case c{argv[1], std::atoi(argv[2]), std::atof(argv[3]), std::atof(argv[4])};
    const int frames = std::max(1, std::atoi(argv[5]));
    const Mesh mesh = ball_mesh(c.points, 1e3 * c.radius * voxel);
    tell("FCL", mesh, in_fcl(mesh, c, frames));
    tell("Bullet", mesh, in_bullet(mesh, c, frames));
    return 0;
}
