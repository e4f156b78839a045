#include "../Shapes.h"

#include "bake/motion/MayMeet.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;

namespace {

/// A random joint of up to three turns and slides.
Motion randomMotion(std::mt19937& random) {
    std::uniform_real_distribution<double> any(-1, 1);
    Motion motion;
    for (std::size_t k = 1 + random() % 3; k-- > 0;) {
        Dof dof;
        dof.kind = random() % 2 ? DofKind::Rotation : DofKind::Translation;
        dof.origin = {any(random), any(random), any(random)};
        dof.axis = Vec3{any(random), any(random), 1.5}.normalized();
        dof.lower = 0.8 * any(random);
        dof.upper = dof.lower + 1 + 0.5 * any(random);
        motion.dofs.push_back(dof);
    }
    motion.base.translation() = Vec3{any(random), any(random), any(random)};
    return motion;
}

} // namespace

TEST_CASE("two bodies that may not meet do so at none of many poses, and those that may come close") {
    std::mt19937 random(1);
    const TriangleMesh box = boxMesh({-0.3, -0.2, -0.1}, {0.3, 0.2, 0.1});
    const MeshQuery query(box);
    const BallAbout ball(box);
    int apart = 0, meet = 0, open = 0;
    for (int round = 0; round < 300; ++round) {
        const Motion motion = randomMotion(random);
        TriangleMesh moved = box;
        std::uniform_real_distribution<double> any(-1.3, 1.3);
        const Vec3 offset{any(random), any(random), any(random)};
        for (Vec3& vertex : moved.vertices) vertex += offset;
        const MeshQuery a(moved);
        const bool may = mayMeet(a, query, ball, motion);
        double nearest = 1e9;
        for (int sample = 0; sample < 2000; ++sample) {
            std::vector<double> q;
            for (const Dof& dof : motion.dofs)
                q.push_back(std::uniform_real_distribution<double>(dof.lower, dof.upper)(random));
            nearest = std::min(nearest, a.distanceTo(query, pose(motion, q), nearest));
        }
        CAPTURE(round, nearest);
        if (!may) CHECK(nearest > 0);
        (may ? meet : apart) += 1;
        open += may && nearest > 0.1;
    }
    CHECK(apart > 30);
    CHECK(meet > 30);
    CHECK(open == 0);
}

TEST_CASE("limit planes count where two bodies may meet") {
    Motion motion;
    Dof slide;
    slide.kind = DofKind::Translation;
    slide.upper = 4;
    motion.dofs.push_back(slide);
    const TriangleMesh box = boxMesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    TriangleMesh far = box;
    for (Vec3& vertex : far.vertices) vertex.x() += 4;
    const MeshQuery a(far), b(box);
    CHECK(mayMeet(a, b, BallAbout(box), motion));
    motion.planes.push_back({{1}, 2.9});
    CHECK_FALSE(mayMeet(a, b, BallAbout(box), motion));
}
