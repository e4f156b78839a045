#include "RandomGraph.h"

#include "bake/model/Kinematics.h"

using namespace osgTSS;
using namespace nodes;

namespace {

/// The largest difference between where the model's joints and OSG put points of the bodies, over so many
/// settings, as a share of the graph's size.
double worstOf(unsigned seed, int settings, int& joints) {
    RandomGraph graph(seed);
    ConstraintVisitor visitor;
    visitor.setQuiet(true);
    graph.root->accept(visitor);
    const tss::SceneModel& model = visitor.getModel();
    joints += static_cast<int>(model.joints.size());
    double worst = 0;
    for (int setting = 0; setting < settings; ++setting) {
        const std::vector<double> values = graph.set(visitor, model);
        const std::vector<tss::Pose> poses = tss::posedBodies(model, values);
        for (std::size_t b = 0; b < poses.size(); ++b) {
            const auto& [node, scale] = visitor.getBodyNodes()[b];
            if (!node) continue;
            for (const osg::Vec3d& point : {osg::Vec3d(), osg::Vec3d(1, 2, 3)}) {
                const osg::Vec3d theirs = toWorld(*node, point);
                const osg::Vec3d ours = toOsg(tss::Vec3(poses[b] * (scale * toCore(point))));
                worst = std::max(worst, (ours - theirs).length() / (1 + theirs.length()));
            }
        }
    }
    return worst;
}

void check(int graphs, int settings) {
    int joints = 0;
    for (int seed = 1; seed <= graphs; ++seed) {
        const double worst = worstOf(static_cast<unsigned>(seed), settings, joints);
        CAPTURE(seed, worst);
        REQUIRE(worst < 1e-9);
    }
    CHECK(joints > 2 * graphs);
}

} // namespace

TEST_CASE("joints of any graph of DOFTransforms stand as OSG puts them") {
    check(100, 20);
}

TEST_CASE("joints of any graph of DOFTransforms stand as OSG puts them, in a million settings", "[.long]") {
    check(2000, 500);
}
