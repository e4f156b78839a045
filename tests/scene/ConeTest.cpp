// Limits of a spherical joint, which are a cone in USD and a box here.
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneParts.h"
#include "bake/scene/WriteLayer.h"
#include "tests/scene/RandomJoints.h"
#include "tests/scene/Samples.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace tss;

TEST_CASE("the box of a cone of limits holds it in whatever order the turns are taken") {
    const double degree = std::acos(-1) / 180;
    std::mt19937_64 random(9);
    std::vector<int> order = {0, 1, 2};
    do {
        for (int axis = 0; axis < 3; ++axis) {
            SceneModel scene = samples::jaw();
            scene.pairs.clear();
            Layer layer = toLayer(scene);
            Prim& prim = *findPrim(layer, "/Scene/Jaw");
            prim.typeName = "PhysicsSphericalJoint";
            prim.properties.clear();
            PrimWriter writer(prim);
            writer.setTargets(schema::body0, {"/Scene/A"});
            writer.setTargets(schema::body1, {"/Scene/B"});
            writer.set(schema::axis, std::string(1, "XYZ"[axis]));
            writer.set(schema::coneAngle0, 20.0);
            writer.set(schema::coneAngle1, 30.0);
            std::vector<std::string> tokens;
            for (int k : order) tokens.push_back(std::string("rot") + "XYZ"[k]);
            writer.set(Attribute{"tss:dofOrder", "token[]", true}, tokens);
            const std::vector<Dof> dofs = readScene(layer, "test.tss").joints.at(0).dofs;
            const int i = order[0], j = order[1], k = order[2];
            const double sign = (j - i + 3) % 3 == 1 ? 1 : -1; // cyclic or not
            CAPTURE(axis, i, j, k);
            for (int round = 0; round < 300; ++round) {
                const Vec3 across = Vec3::Unit((axis + 1) % 3);
                const auto about = [&](double most, const Vec3& by) {
                    return Eigen::AngleAxisd(samples::uniform(random, -most, most) * degree, by)
                        .toRotationMatrix();
                };
                const Eigen::Matrix3d turn =
                    about(180, Vec3::Unit(axis)) * about(30, across) * about(180, Vec3::Unit(axis));
                double q[] = {std::atan2(-sign * turn(j, k), turn(k, k)), std::asin(sign * turn(i, k)),
                              std::atan2(-sign * turn(i, j), turn(i, i))};
                const auto within = [&] {
                    for (int d = 0; d < 3; ++d) {
                        const double value = std::remainder(q[d], 360 * degree);
                        if (value < dofs[d].lower - 1e-6 || value > dofs[d].upper + 1e-6) return false;
                    }
                    return true;
                };
                bool held = within();
                q[0] += 180 * degree, q[1] = 180 * degree - q[1], q[2] += 180 * degree;
                held = held || within();
                CHECK(held);
            }
        }
    } while (std::next_permutation(order.begin(), order.end()));
}
